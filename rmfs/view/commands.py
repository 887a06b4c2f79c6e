"""What `rmfs view` does: serve recorded runs until it is interrupted, or write one file."""

from __future__ import annotations

import webbrowser
from typing import TYPE_CHECKING

from rmfs.errors import InputError
from rmfs.measure import load_run
from rmfs.view import scene
from rmfs.view.export import export
from rmfs.view.replay import replay_server

if TYPE_CHECKING:
    from pathlib import Path

    from rmfs.measure import RunFolder

MOST_RUNS = 2


def serve_runs(paths: list[Path], *, port: int = 0, open_browser: bool = True) -> None:
    """Serve runs on loopback until interrupted.

    Raises
    ------
    InputError
        If a run cannot be shown, or the port is taken: noticed before anything is served.
    """
    runs = _loaded(paths)
    for run in runs:
        scene.of_run(run)
    with replay_server(runs, port) as server:
        print(server.url, flush=True)
        if open_browser:
            webbrowser.open(server.url)
        server.serve_forever()


def export_runs(paths: list[Path], target: Path) -> None:
    """Write runs into one file; raises as `serve_runs` does."""
    export(_loaded(paths), target)


def _loaded(paths: list[Path]) -> list[RunFolder]:
    if len(paths) > MOST_RUNS:
        raise InputError(f"{len(paths)} runs: at most {MOST_RUNS} stand side by side")
    return [load_run(path) for path in paths]
