"""Servers for the pages that show recorded runs or a live run."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.view import forms, scene
from rmfs.view.asking import Known
from rmfs.view.live import FIXED
from rmfs.view.preview import preview
from rmfs.view.server import Answer, Server

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from rmfs.config import Table
    from rmfs.measure import RunFolder
    from rmfs.view.live import LiveRun
    from rmfs.view.starting import Starter


def replay_server(
    runs: Sequence[RunFolder], port: int = 0, starter: Starter | None = None
) -> Server:
    """Return a server that shows recorded runs, side by side if there are several.

    If `starter` is given, the page has a form that starts runs; if there are no recorded runs, the
    page has only that form. A run folder is read again for each request, so that a reloaded page
    shows the current content of the folder. If a run cannot be read, the response states why.

    Raises
    ------
    InputError
        If the port cannot be used.
    """
    session = {"runs": len(runs), "live": False, "form": starter is not None}
    gets = {f"/runs/{number}": _scene(run) for number, run in enumerate(runs)}
    gets["/session"] = lambda _: Answer.json(session)
    posts: dict[str, Callable[[Table], Answer]] = {}
    if starter is not None:
        gets["/form"] = lambda query: Answer.json(forms.form(dict(query)))
        posts["/preview"] = lambda wish: Answer.scene(preview(wish))
        posts["/start"] = lambda wish: Answer.json({"url": starter.start(wish)})
    return Server(gets, posts, port=port)


def live_server(run: LiveRun, port: int = 0) -> Server:
    """Return a server that shows a live run; raise InputError if the port cannot be used."""
    session = {"runs": 1, "live": True, "form": False}
    problems = {name: one for name, one in forms.problems().items() if name not in FIXED}

    def news(query: Mapping[str, str]) -> Answer:
        known = Known(int(query.get("motion", 0)), int(query.get("events", 0)))
        return Answer.scene(run.news(known, query.get("page", "")))

    def told(act: Callable[[], None]) -> Answer:
        act()
        return Answer.json({})

    return Server(
        {
            "/session": lambda _: Answer.json(session),
            "/runs/0": lambda _: Answer.scene(run.scene()),
            "/live": news,
            "/problems": lambda _: Answer.json(problems),
        },
        {
            "/control": lambda wish: told(lambda: run.control(wish)),
            "/exchange": lambda wish: told(lambda: run.exchange(wish["problem"], wish["rule"])),
            "/leave": lambda wish: told(lambda: run.leave(wish["page"])),
        },
        port=port,
    )


def _scene(run: RunFolder) -> Callable[[Mapping[str, str]], Answer]:
    return lambda _: Answer.scene(scene.of_run(run))
