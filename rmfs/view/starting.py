"""Starting runs from a form, each as a separate process with its own page."""

from __future__ import annotations

import subprocess
import sys
import threading
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rmfs import control, layout, scenario
from rmfs.control.files import names_a_file
from rmfs.errors import InputError
from rmfs.references import installed_only
from rmfs.scenario.toml import toml_value
from rmfs.view.forms import PARTS, shipped

if TYPE_CHECKING:
    from rmfs.config import Table

MOST_RUNS = 4
"""Maximum number of simultaneous runs started from the form."""

PATIENCE_S = 60.0


class Starter:
    """Starts runs as `rmfs run --live` does, and stops unfinished runs when it is closed.

    Parameters
    ----------
    results
        Folder in which the run folders are created.
    """

    def __init__(self, results: Path = Path("results")) -> None:
        self._results = results
        self._running: list[subprocess.Popen[str]] = []
        self._lock = threading.Lock()

    def start(self, wish: Table) -> str:
        """Start a run and return the address of its page.

        Parameters
        ----------
        wish
            Optional settings: `layout`, `scenario` and `controllers` (names of shipped files),
            `seed`, `out` (name of the run folder), `speed` (None: as fast as possible), `trace`
            (whether to keep the trace in the run folder), and `set` (values of parameters by key,
            such as `{"layout.robots": 16}`).

        Raises
        ------
        InputError
            If a value is invalid, too many runs are in progress, or the run ends before it has a
            page; in the last case, the error has the message of the run.
        """
        arguments = _arguments(wish, self._results)
        with self._lock:
            self._running = [run for run in self._running if run.poll() is None]
            if len(self._running) >= MOST_RUNS:
                raise InputError(
                    f"{MOST_RUNS} runs are already in progress: wait until one has ended"
                )
            run = subprocess.Popen(
                [sys.executable, "-m", "rmfs", "run", *arguments],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
            )
            self._running.append(run)
        return _address(run)

    def close(self) -> None:
        """Stop unfinished runs and wait until they have ended; no half-written folders remain."""
        for run in self._running:
            if run.poll() is None:
                run.terminate()  # as Ctrl-C: what is half-written goes
        for run in self._running:
            run.wait()


def _arguments(wish: Table, results: Path) -> list[str]:
    """Return the arguments of `rmfs run`, after the same checks as in the command itself."""
    given = {part: shipped(part, str(wish.get(part, "default"))) for part in PARTS}
    changes = wish.get("set", {})
    overrides = [(key.split("."), changed) for key, changed in changes.items()]
    own: dict[str, list[tuple[list[str], Any]]] = {part: [] for part in PARTS}
    for path, new in overrides:
        if path[0] not in PARTS or len(path) < 2:
            raise InputError(f"{'.'.join(path)}: must be a key below one of {', '.join(PARTS)}")
        own[path[0]].append((path[1:], new))
    with installed_only():  # a page may name no code
        layout.load(given["layout"], own["layout"])
        control.load(given["controllers"], own["controllers"])
    work = scenario.load(given["scenario"], own["scenario"])
    usual = scenario.named_files(scenario.load(given["scenario"]))
    if set(scenario.named_files(work).values()) - set(usual.values()):
        raise InputError("scenario: files can be chosen on the command line only")
    if any(names_a_file(path[-1], new) for path, new in own["controllers"]):
        raise InputError("controllers: files can be chosen on the command line only")
    name = str(wish.get("out") or f"{'-'.join(given.values())}-live")
    if not name.replace("-", "").replace("_", "").replace(".", "").isalnum() or name[0] == ".":
        raise InputError(f"out: must be a name of letters, digits, - and _ (given: {name!r})")
    speed = wish.get("speed")
    return [
        *(word for part in PARTS for word in (f"--{part}", given[part])),
        *("--seed", str(int(wish.get("seed", 0))), "--out", str(results / name)),
        *(word for key, new in changes.items() for word in ("--set", f"{key}={toml_value(new)}")),
        *([] if speed is None else ["--speed", str(float(speed))]),
        *(["--trace"] if wish.get("trace") else []),
        # the name that stands for none is there to be used again
        *([] if wish.get("out") else ["--force"]),
        *("--live", "--no-open", "--await-page"),
    ]


def _address(run: subprocess.Popen[str]) -> str:
    """Return the first line that a run prints: the address of its page.

    Raises
    ------
    InputError
        If the run prints no address; the message is the last line of its error output.
    """
    assert run.stdout is not None
    assert run.stderr is not None
    line = run.stdout.readline().strip()
    if not line.startswith("http://"):
        run.wait()
        told: list[Any] = run.stderr.read().strip().splitlines() or ["the run ended immediately"]
        raise InputError(str(told[-1]).removeprefix("rmfs: "))
    for stream in (run.stdout, run.stderr):
        # read on, or a full pipe would hold the run back
        threading.Thread(target=stream.read, daemon=True).start()
    return line
