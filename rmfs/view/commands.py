"""Implementation of `rmfs view` and `rmfs run --live`: serving recorded runs or a live one."""

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
"""Longest wall time, in s, that a run waits at its start for a page that watches it."""

FAREWELL_S = 3.0
"""Longest wall time, in s, for which pages can load the end of a run after it has ended."""


def serve_runs(paths: list[Path], *, port: int = 0, open_browser: bool = True) -> None:
    """Serve up to two recorded runs and a form that starts new ones, until the user interrupts.

    The server is on the loopback interface only.

    Raises
    ------
    InputError
        If there are more than two runs, a run cannot be shown, or the port is in use; these
        conditions are checked before serving.
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
    """Serve a live run; yield its `LiveRun`, which provides the run's observer and driver.

    The server is on the loopback interface only.

    Parameters
    ----------
    inputs
        Layout, scenario and controllers, as the user named them.
    title
        Title of the run on the page.
    speed
        Initial speed in simulated seconds per wall second. Default: as fast as possible.
    await_page
        Whether to wait up to `PAGE_PATIENCE_S` for a page before the run begins. If a browser is
        opened, the run waits in any case.

    Raises
    ------
    InputError
        If the port is in use, or the speed is out of range (see `Pace`).
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
            live.close("the run was aborted")
            live.await_farewell(FAREWELL_S)
            server.shutdown()


def export_runs(paths: list[Path], target: Path) -> None:
    """Export one or two runs to an HTML file.

    Raises
    ------
    InputError
        If there are more than two runs, a run cannot be shown, or the file cannot be written.
    """
    export(_loaded(paths), target)


def _loaded(paths: list[Path]) -> list[RunFolder]:
    if len(paths) > MOST_RUNS:
        raise InputError(f"{len(paths)} runs: at most {MOST_RUNS} can be shown side by side")
    return [load_run(path) for path in paths]
