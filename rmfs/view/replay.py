"""Serving recorded runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.view import scene
from rmfs.view.server import Answer, Server

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from rmfs.measure import RunFolder


def replay_server(runs: Sequence[RunFolder], port: int = 0) -> Server:
    """Return a server of recorded runs, side by side if there are several.

    A run is read each time it is asked for, so that a page loaded anew shows what is there now;
    one that cannot be read is answered with the reason.
    """
    session = {"runs": len(runs)}
    paths = {f"/runs/{number}": _scene(run) for number, run in enumerate(runs)}
    return Server({"/session": lambda _: Answer.json(session), **paths}, port=port)


def _scene(run: RunFolder) -> Callable[[Mapping[str, str]], Answer]:
    return lambda _: Answer.scene(scene.of_run(run))
