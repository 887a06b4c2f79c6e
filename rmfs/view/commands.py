"""What `rmfs view` and `rmfs run --live` do: serve recorded runs, or one that happens now."""

from __future__ import annotations

import threading
import webbrowser
from contextlib import contextmanager
from typing import TYPE_CHECKING

from rmfs.errors import InputError
from rmfs.measure import load_run
from rmfs.view import scene
from rmfs.view.answers import live_server, replay_server
from rmfs.view.export import export
from rmfs.view.live import LiveRun
from rmfs.view.starting import Starter

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from rmfs.measure import RunFolder

MOST_RUNS = 2

PAGE_PATIENCE_S = 10.0
"""Wall time a run waits for the page that was opened to watch it."""

FAREWELL_S = 3.0
"""Wall time the pages have to see how a run ended."""


def serve_runs(paths: list[Path], *, port: int = 0, open_browser: bool = True) -> None:
    """Serve runs on loopback until interrupted; without any, the form that starts one.

    Raises
    ------
    InputError
        If a run cannot be shown, or the port is taken: noticed before anything is served.
    """
    runs = _loaded(paths)
    for run in runs:
        scene.of_run(run)
    starter = Starter()
    try:
        with replay_server(runs, port, starter) as server:
            print(server.url, flush=True)
            if open_browser:
                webbrowser.open(server.url)
            server.serve_forever()
    finally:
        starter.close()


@contextmanager
def watched(
    inputs: Mapping[str, str],
    title: str,
    *,
    port: int = 0,
    speed: float | None = None,
    open_browser: bool = True,
    await_page: bool = False,
) -> Iterator[LiveRun]:
    """Serve a run on loopback while it happens; yields what is to observe it.

    Parameters
    ----------
    inputs
        Layout, scenario and controllers as the user named them.
    title
        What the page calls the run.
    speed
        Simulated seconds per wall second to begin with; default: as fast as it goes.
    await_page
        Whether to wait a moment for a page before the run begins, even if none was opened here.

    Raises
    ------
    InputError
        If the port is taken, or the speed is not positive.
    """
    live = LiveRun(inputs, title=title, speed=speed)
    with live_server(live, port) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        print(server.url, flush=True)
        opened = open_browser and webbrowser.open(server.url)
        if opened or await_page:
            live.await_page(PAGE_PATIENCE_S)
        try:
            yield live
        finally:
            live.close("the run was given up")
            live.await_farewell(FAREWELL_S)
            server.shutdown()


def export_runs(paths: list[Path], target: Path) -> None:
    """Write runs into one file; raises as `serve_runs` does."""
    export(_loaded(paths), target)


def _loaded(paths: list[Path]) -> list[RunFolder]:
    if len(paths) > MOST_RUNS:
        raise InputError(f"{len(paths)} runs: at most {MOST_RUNS} stand side by side")
    return [load_run(path) for path in paths]
