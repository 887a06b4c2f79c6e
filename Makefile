# Set-up, runs and checks of rmfs; `make help` lists the targets.
#
# Everything installed stays in the checkout: .venv (Python packages, pinned by requirements.txt)
# and, where the machine's Rust is missing or too old, .rust.

PYTHON ?= python3
JOBS ?= 2
VENV := .venv
BIN := $(VENV)/bin
CRATE := rmfs/traffic
CRATE_FILES := $(CRATE)/Cargo.toml $(CRATE)/Cargo.lock $(shell find $(CRATE)/src -name '*.rs')
UV := uv==0.13.8
WHEEL_TOOLS := ziglang==0.17.1 auditwheel==6.8.2

# What is below .rust goes first; PyO3 is built for the Python of .venv.
IN_VENV := PATH="$(CURDIR)/.rust/bin:$(CURDIR)/$(BIN):$$PATH" VIRTUAL_ENV="$(CURDIR)/$(VENV)" \
  PYO3_PYTHON="$(CURDIR)/$(BIN)/python"
CARGO := $(IN_VENV) cargo
PIP := $(BIN)/python -m pip --quiet --disable-pip-version-check
MANIFEST := --manifest-path $(CRATE)/Cargo.toml --locked

.PHONY: help
help: ## List the targets
	@sed -n 's/^\([a-z]*\):.*## \(.*\)/  make \1 @\2/p' $(MAKEFILE_LIST) | \
	  while IFS=@ read -r name text; do printf '%-14s %s\n' "$$name" "$$text"; done

.PHONY: demo
demo: setup ## Simulate the default warehouse with three seeds: a table and a picture
	@$(BIN)/python -m rmfs.experiments.demo

.PHONY: setup
setup: $(VENV)/.built ## Install the pinned packages and build the Rust crate

.PHONY: test
test: setup ## Run the tests of the Rust crate and of the Python packages
	$(CARGO) test $(MANIFEST) --no-default-features
	$(BIN)/python -m pytest -n $(JOBS) --dist worksteal --benchmark-disable

.PHONY: lint
lint: lint-python lint-rust ## Check style, types, import rules and the Rust crate

.PHONY: lint-python
lint-python: setup
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/lint-imports

.PHONY: lint-rust
lint-rust: setup
	$(CARGO) fmt --manifest-path $(CRATE)/Cargo.toml --check
	$(CARGO) clippy $(MANIFEST) --all-targets -- -D warnings

.PHONY: format
format: setup ## Format the Python and Rust sources
	$(BIN)/ruff check --fix
	$(BIN)/ruff format
	$(CARGO) fmt --manifest-path $(CRATE)/Cargo.toml

.PHONY: browse
browse: setup ## Test the viewer in Chromium and build its page again, where Chromium and npm are
	$(BIN)/python -m pytest -m slow -n $(JOBS) --dist worksteal -rs tests/view

.PHONY: wheel
wheel: setup ## Build the wheel and try it in a project with folders of the same names
	$(BIN)/python -m pytest -m slow tests/project/test_hostile_folder.py

.PHONY: manylinux
manylinux: setup ## Build the wheel for Linux machines of all kinds and try it without Rust
	$(PIP) install $(WHEEL_TOOLS)
	$(IN_VENV) $(BIN)/python -m pytest -m slow tests/project/test_manylinux.py

.PHONY: bench
bench: setup ## Measure speed
	$(BIN)/rmfs bench
	$(BIN)/python -m pytest -m benchmark

.PHONY: spoil
spoil: setup ## Call the program with spoilt inputs for a minute
	$(BIN)/python -m tests.tools.spoil --seconds 60 --processes $(JOBS)

# Spoilt inputs are new ones every day; a case that fails tells its number.
.PHONY: soak
soak: setup ## Run the long tests: whole days, other systems, an hour of spoilt inputs
	$(BIN)/python -m pytest -m slow -n $(JOBS)
	$(BIN)/python -m tests.tools.spoil --seconds 3600 --processes $(JOBS) --first $$(( $$(date +%s) / 86400 * 100000 ))

.PHONY: docs
docs: $(VENV)/.docs ## Build the documentation: docs/_build/html/index.html
	$(BIN)/sphinx-build -W --keep-going -q -E -b html docs docs/_build/html

.PHONY: pictures
pictures: setup ## Draw the pictures of the documentation (needs LaTeX and Poppler)
	$(BIN)/rmfs layout show default --out docs/images/default-layout.png
	$(BIN)/python -m tests.tools.viewer pictures
	$(BIN)/python -m tests.tools.typeset results/published/figure-5a.tex docs/images/figure-5a-table.png

.PHONY: viewer
viewer: ## Build the page of `rmfs view` from its sources (needs Node; its users do not)
	cd rmfs/view/web && npm ci && npm run lint && npm run build

.PHONY: lock
lock: $(VENV)/.installed ## Pin the newest packages that pyproject.toml allows: requirements.txt
	$(PIP) install $(UV)
	$(BIN)/uv pip compile pyproject.toml --quiet --extra dev --universal --python-version 3.11 \
	  --generate-hashes --upgrade --custom-compile-command "make lock" --output-file requirements.txt
	$(BIN)/uv pip compile pyproject.toml --quiet --extra docs --constraint requirements.txt --universal \
	  --python-version 3.11 --generate-hashes --custom-compile-command "make lock" \
	  --output-file docs/requirements.txt
	$(PIP) install --require-hashes -r requirements.txt
	$(BIN)/python -m tests.tools.supply

.PHONY: clean
clean: ## Remove what was installed and built; results/ stays
	rm -rf $(VENV) .rust $(CRATE)/target $(CRATE)/_core*.so $(CRATE)/_core*.pyd dist
	rm -rf docs/_build .pytest_cache .mypy_cache .ruff_cache .hypothesis .benchmarks .import_linter_cache
	find rmfs solvers experiments tests .ci -name __pycache__ -prune -exec rm -rf {} +

.PHONY: rust
rust:
	@.ci/rust

$(VENV)/.installed: requirements.txt
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "Python 3.11 or newer is \
	needed, $(PYTHON) is %d.%d: try for example make PYTHON=python3.12" % sys.version_info[:2])'
	@echo "installing the packages of requirements.txt into $(VENV)"
	@$(PYTHON) -m venv $(VENV)
	@$(PIP) install --require-hashes -r requirements.txt
	@touch $@

$(VENV)/.docs: $(VENV)/.built docs/requirements.txt
	@echo "installing the packages of docs/requirements.txt into $(VENV)"
	@$(PIP) install --require-hashes -r docs/requirements.txt
	@touch $@

# No Python package is fetched here: those installed above are all that is needed.
$(VENV)/.built: $(VENV)/.installed pyproject.toml $(CRATE_FILES) | rust
	@echo "building the Rust crate"
	@$(IN_VENV) $(PIP) install --no-index --no-build-isolation --no-deps --editable .
	@$(PIP) check
	@touch $@
