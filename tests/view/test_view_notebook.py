"""`run.view()` in a notebook: the page in a frame, whole and working."""

import html
import re
import sys
import types
from pathlib import Path
from typing import Any

import pytest
from in_browser import needs_browser

from rmfs.measure import RunFolder
from tests.tools.viewer.chromium import open_page


def frame_of(run: RunFolder, path: Path, **given: Any) -> str:
    return run.view(path, open_browser=False, **given)._repr_html_()


def test_the_frame_holds_the_exported_page(runs: list[RunFolder], tmp_path: Path) -> None:
    text = frame_of(runs[0], tmp_path / "one.html", height=500)
    found = re.fullmatch(r'<iframe [^>]*height: 500px[^>]* srcdoc="([^"]*)"></iframe>', text)
    assert found is not None
    assert html.unescape(found[1]) == (tmp_path / "one.html").read_text("utf-8")


def test_the_page_can_be_opened_like_a_file(runs: list[RunFolder], tmp_path: Path) -> None:
    replay = runs[0].view(tmp_path / "one.html", open_browser=False)
    assert Path(replay) == replay.path == tmp_path / "one.html"
    assert replay.size_mb == pytest.approx(len(Path(replay).read_bytes()) / 1e6)


@pytest.mark.parametrize(("shell", "opened"), [("ZMQInteractiveShell", 0), ("NoneType", 1)])
def test_a_browser_opens_unless_a_notebook_shows_it(
    runs: list[RunFolder],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    shell: str,
    opened: int,
) -> None:
    made = types.ModuleType("IPython")
    made.get_ipython = lambda: type(shell, (), {})()  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "IPython", made)
    addresses: list[str] = []
    monkeypatch.setattr("webbrowser.open", addresses.append)
    runs[0].view(tmp_path / "one.html")
    assert len(addresses) == opened


@pytest.mark.slow
@needs_browser
def test_it_plays_in_a_notebook(browser: Any, runs: list[RunFolder], tmp_path: Path) -> None:
    text = frame_of(runs[0], tmp_path / "one.html")
    (tmp_path / "notebook.html").write_text(f"<!doctype html><body>{text}</body>", "utf-8")
    page = open_page(browser, viewport={"width": 1000, "height": 760})
    complaints: list[str] = []
    page.on("console", lambda m: complaints.append(m.text) if m.type == "error" else None)
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.goto((tmp_path / "notebook.html").as_uri())
    inside = page.frame_locator("iframe")
    inside.locator("#tab-orders").click()
    inside.locator(".board .order").first.wait_for()
    before = inside.locator("#time").input_value()
    page.wait_for_timeout(1500)
    assert inside.locator("#time").input_value() != before
    inside.locator("button:text-is('link')").click()
    inside.locator(".notice.shown").wait_for()
    page.close()
    assert complaints == []
