import importlib.util
import json
import zipfile
from pathlib import Path
from types import ModuleType

import pytest
from project_files import ROOT, toml, tracked

from rmfs import instances

PROJECT = toml("pyproject.toml")
MATURIN = PROJECT["tool"]["maturin"]


@pytest.fixture
def backend() -> ModuleType:
    pytest.importorskip("maturin")
    spec = importlib.util.spec_from_file_location("backend", ROOT / ".ci" / "build_backend.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_a_wheel_takes_one_name_and_carries_the_folders_below_it(
    backend: ModuleType, tmp_path: Path
) -> None:
    wheel = tmp_path / "rmfs-0-py3-none-any.whl"
    with zipfile.ZipFile(wheel, "w") as bare:
        bare.writestr("rmfs/__init__.py", "")
        bare.writestr("rmfs-0.dist-info/RECORD", "rmfs/__init__.py,,\n")
    backend.add_folders(wheel)
    with zipfile.ZipFile(wheel) as whole:
        names = whole.namelist()
        record = whole.read("rmfs-0.dist-info/RECORD").decode().splitlines()
    assert {name.split("/")[0] for name in names} == {"rmfs", "rmfs-0.dist-info"}
    assert {line.split(",")[0] for line in record} == {*names} - {"rmfs-0.dist-info/RECORD"}
    for name in ("solvers/models/solution.py", "experiments/designs/smoke.toml"):
        assert f"rmfs/{name}" in names
    assert "rmfs/shipped/layouts/default.toml" in names


def test_the_bill_of_materials_of_a_wheel_repeats(backend: ModuleType, tmp_path: Path) -> None:
    """Maturin writes a random number, the time and the folder of the build into it."""
    wheels = []
    for number in range(2):
        bill = {
            "serialNumber": f"urn:uuid:{number}",
            "metadata": {"timestamp": f"2026-01-0{number + 1}T00:00:00Z", "tools": ["a"]},
            "components": [{"bom-ref": f"path+file://{backend.ROOT}/rmfs/traffic#x@1"}],
        }
        wheel = tmp_path / f"rmfs-{number}-py3-none-any.whl"
        name = "rmfs-0.dist-info/sboms/x.json"
        with zipfile.ZipFile(wheel, "w") as bare:
            text = json.dumps(bill)
            bare.writestr(zipfile.ZipInfo(name), text)
            bare.writestr(zipfile.ZipInfo("rmfs-0.dist-info/RECORD"), f"{name},sha256=x,1\n")
        backend.add_folders(wheel)
        wheels.append(wheel.read_bytes())
        with zipfile.ZipFile(wheel) as whole:
            told = whole.read(name)
            record = whole.read("rmfs-0.dist-info/RECORD")
        assert str(backend.ROOT).encode() not in told
        assert json.loads(told)["components"] and json.loads(told)["metadata"]["tools"]
        assert record.count(name.encode()) == 1
        assert backend.recorded(name, told) in record
    assert wheels[0] == wheels[1]


def test_the_source_distribution_carries_the_folders_of_the_wheel(backend: ModuleType) -> None:
    for folder, target in backend.FOLDERS.items():
        assert {"path": f"{folder}/**/*", "format": "sdist"} in MATURIN["include"]
        assert (ROOT / target).resolve() == ROOT / folder


def test_instances_are_found_and_of_known_kinds() -> None:
    assert ROOT / "instances" == instances.ROOT
    for kind, suffixes in {
        "layouts": {".toml", ".json"},
        "scenarios": {".toml", ".txt"},
        "controllers": {".toml"},
    }.items():
        found = {path.suffix for path in (instances.ROOT / kind).iterdir()}
        assert found
        assert found <= suffixes


def test_the_wheel_carries_all_packages() -> None:
    packages = {path.parent for path in tracked("*/__init__.py")}
    top = {path.relative_to(ROOT).parts[0] for path in packages} - {"tests"}
    assert top - {"solvers", "experiments"} == set(MATURIN["python-packages"])


def test_the_wheel_leaves_the_crate_out() -> None:
    excluded = [entry["path"] for entry in MATURIN["exclude"]]
    for path in tracked("rmfs/traffic/*"):
        name = path.relative_to(ROOT).as_posix()
        if path.suffix in (".rs", ".toml", ".lock"):
            assert any(
                name.startswith(pattern.split("*")[0]) and name.endswith(pattern.split("*")[-1])
                for pattern in excluded
            ), name


def test_the_source_distribution_carries_its_build_back_end() -> None:
    assert PROJECT["build-system"]["backend-path"] == [".ci"]
    assert {"path": ".ci/build_backend.py", "format": "sdist"} in MATURIN["include"]


@pytest.mark.parametrize(
    ("present", "state"), [(None, "none is on PATH"), ("1.9.0", "the one on PATH is 1.9.0")]
)
def test_a_build_without_rust_ends_in_one_line(
    backend: ModuleType, monkeypatch: pytest.MonkeyPatch, present: str | None, state: str
) -> None:
    monkeypatch.setattr(backend, "found", lambda: present)
    with pytest.raises(SystemExit) as ended:
        backend.get_requires_for_build_wheel()
    message = str(ended.value)
    assert f"Rust {backend.required()} or newer" in message
    assert state in message
    assert "\n" not in message


@pytest.mark.parametrize("later", ["", ".0", ".17"])
def test_a_build_with_rust_asks_for_no_package(
    backend: ModuleType, monkeypatch: pytest.MonkeyPatch, later: str
) -> None:
    monkeypatch.setattr(backend, "found", lambda: backend.required() + later)
    assert backend.get_requires_for_build_wheel() == []
    assert backend.get_requires_for_build_editable() == []


def test_the_rust_on_path_is_recognised(backend: ModuleType) -> None:
    found = backend.found()
    assert found is None or backend.numbers(found) > [1]
