"""The pictures of the viewer in the documentation: taken in Chromium, of runs made for them."""

from __future__ import annotations

import io
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PIL import Image

import rmfs
from experiments.viewer.chromium import chromium, served, show
from rmfs.files import replacing
from rmfs.measure import load_run, write_run
from rmfs.view.answers import replay_server

if TYPE_CHECKING:
    from collections.abc import Callable

    from rmfs.measure import RunFolder

WIDTH, HEIGHT = 1100, 620
COLOURS = 256
"""Of a picture: enough for flat surfaces, and half the bytes."""

RULES = ("nearest", "random")
"""Where pods go after a visit, in the two runs."""

PICTURES: dict[str, tuple[int, str]] = {
    "viewer-plan": (
        1,
        "mode: '2d', theme: 'light', paths: true, selection: { run: 0, what: 'robot', index: 3 }",
    ),
    "viewer-space": (1, "mode: '3d', theme: 'dark', robots: 'state', pods: 'fill'"),
    "viewer-heat": (1, "mode: '2d', theme: 'light', heat: 'visits', from_s: 600, to_s: 3600"),
    "viewer-compare": (2, "mode: '2d', theme: 'light', pods: 'age'"),
}
"""Runs side by side, and what is shown, as changes of the page's state."""

TIME_S = 2400.0


def take(folder: Path, tell: Callable[[str], None]) -> list[Path]:
    """Write all pictures into a folder; returns their files."""
    with tempfile.TemporaryDirectory() as parent:
        runs = [_recorded(Path(parent) / f"psa-{rule}", rule) for rule in RULES]
        paths = []
        with chromium() as browser:
            for name, (number, change) in PICTURES.items():
                page = browser.new_page(
                    viewport={"width": WIDTH, "height": HEIGHT}, bypass_csp=True
                )
                with served(replay_server(runs[:number])) as url:
                    show(page, url)
                    page.evaluate(f"rmfs.store.set({{ time_s: {TIME_S}, {change} }})")
                    # one frame for the picture, some time for the charts
                    page.wait_for_timeout(1000)
                    paths.append(_saved(page.screenshot(), folder / f"{name}.png"))
                page.close()
                tell(str(paths[-1]))
    return paths


def _recorded(path: Path, rule: str) -> RunFolder:
    overrides: list[tuple[list[str], Any]] = [
        (["scenario", "warmup_s"], 600.0),
        (["scenario", "duration_s"], 3000.0),
        (["controllers", "psa", "name"], rule),
    ]
    run = rmfs.simulate("default", "default", "default", seed=1, overrides=overrides, trace=True)
    write_run(run, path, trace=True)
    return load_run(path)


def _saved(picture: bytes, path: Path) -> Path:
    """Write a picture with few colours, in the place of an older one."""
    small = Image.open(io.BytesIO(picture)).convert("RGB").quantize(COLOURS)
    with replacing(path) as temporary:
        small.save(temporary, format="PNG", optimize=True)
    return path
