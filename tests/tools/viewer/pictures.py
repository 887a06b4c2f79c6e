"""The pictures of the viewer in the documentation: taken in Chromium, of runs made for them."""

from __future__ import annotations

import io
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PIL import Image

import rmfs
from rmfs.files import replacing
from rmfs.measure import load_run, write_run
from rmfs.view.answers import replay_server
from rmfs.view.starting import Starter
from tests.tools.viewer.chromium import chromium, open_page, served, show

if TYPE_CHECKING:
    from collections.abc import Callable

    from playwright.sync_api import Browser

    from rmfs.measure import RunFolder

WIDTH, HEIGHT = 1280, 720
RUNS = {
    "psa-nearest": ("default", "default", "nearest"),
    "psa-random": ("default", "default", "random"),
    "three-tiers": ("study-tiers", "pp-minimal", "nearest"),
    "letters": ("default", "letters", "nearest"),
}
"""Layout, scenario, and where pods go after a visit."""

PICTURES: dict[str, tuple[tuple[str, ...], str]] = {
    "viewer-plan": (
        ("psa-nearest",),
        "mode: '2d', theme: 'light', paths: true, selection: { run: 0, what: 'robot', index: 3 }",
    ),
    "viewer-space": (
        ("three-tiers",),
        "mode: '3d', theme: 'dark', robots: 'state', pods: 'fill'",
    ),
    "viewer-heat": (
        ("psa-nearest",),
        "mode: '2d', theme: 'light', heat: 'visits', from_s: 600, to_s: 2400",
    ),
    "viewer-compare": (
        ("psa-nearest", "psa-random"),
        "mode: '2d', theme: 'light', pods: 'age'",
    ),
    "viewer-overlay": (
        ("psa-nearest", "psa-random"),
        "mode: '2d', theme: 'light', heat: 'visits', overlay: true, from_s: 600, to_s: 2400",
    ),
    "viewer-orders": (
        ("psa-nearest",),
        "mode: '2d', theme: 'light', selection: { run: 0, what: 'station', index: 1 }",
    ),
    "viewer-pods": (
        ("psa-nearest",),
        "mode: '2d', theme: 'dark', board: 'orders', grouping: 'pod'",
    ),
    "viewer-pod": (
        ("psa-nearest",),
        "mode: '2d', theme: 'dark', selection: { run: 0, what: 'pod', index: 150 }",
    ),
    "viewer-letters": (
        ("letters",),
        "mode: '2d', theme: 'light', board: 'orders', grouping: 'order'",
    ),
}
"""Runs side by side, and what is shown, as changes of the page's state."""

TIME_S = 1500.0


def take(folder: Path, tell: Callable[[str], None]) -> list[Path]:
    """Write all pictures into a folder; returns their files."""
    with tempfile.TemporaryDirectory() as parent:
        runs = {name: _recorded(Path(parent) / name, *inputs) for name, inputs in RUNS.items()}
        paths = []
        with chromium() as browser:
            for name, (shown, change) in PICTURES.items():
                page = open_page(
                    browser, viewport={"width": WIDTH, "height": HEIGHT}, bypass_csp=True
                )
                with served(replay_server([runs[one] for one in shown])) as url:
                    show(page, url)
                    page.evaluate(f"rmfs.store.set({{ time_s: {TIME_S}, {change} }})")
                    # one frame for the picture, some time for the charts
                    page.wait_for_timeout(1000)
                    paths.append(_saved(page.screenshot(), folder / f"{name}.png"))
                page.close()
                tell(str(paths[-1]))
            paths.append(_form(browser, folder / "viewer-form.png"))
            tell(str(paths[-1]))
    return paths


def _form(browser: Browser, path: Path) -> Path:
    """Take a picture of the form that starts a run."""
    page = open_page(browser, viewport={"width": WIDTH, "height": HEIGHT})
    with served(replay_server([], starter=Starter())) as url:
        page.goto(url)
        page.click("summary:has-text('Layout')")
        page.wait_for_selector("#preview .counts:not(:empty)")
        picture = page.screenshot()
    page.close()
    return _saved(picture, path)


def _recorded(path: Path, layout: str, scenario: str, rule: str) -> RunFolder:
    overrides: list[tuple[list[str], Any]] = [
        (["scenario", "warmup_s"], 600.0),
        (["scenario", "duration_s"], 1800.0),
        (["controllers", "psa", "name"], rule),
    ]
    run = rmfs.simulate(layout, scenario, "default", seed=1, overrides=overrides, trace=True)
    write_run(run, path, trace=True)
    return load_run(path)


def _saved(picture: bytes, path: Path) -> Path:
    """Write a picture as small as it can be with all its colours, in the place of an older one."""
    with replacing(path) as temporary:
        Image.open(io.BytesIO(picture)).convert("RGB").save(temporary, format="PNG", optimize=True)
    return path
