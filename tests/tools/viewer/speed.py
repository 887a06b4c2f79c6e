"""How many frames a second the viewer draws: in software, with the load of the machine beside."""

from __future__ import annotations

import contextlib
import os
from dataclasses import asdict, dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import pandas as pd
import psutil  # type: ignore[import-untyped]

import rmfs
from rmfs.measure import load_run, write_run
from rmfs.view import scene
from rmfs.view.container import unpack
from rmfs.view.server import Answer, Server
from tests.tools.viewer.chromium import chromium, open_page, served, show
from tests.tools.viewer.copies import copies

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

WIDTH, HEIGHT = 1280, 720
SECONDS = 5.0

VIEWS = {
    "plan": "mode: '2d'",
    "plan, states, fill and paths": "mode: '2d', robots: 'state', pods: 'fill', paths: true",
    "plan, heat map": "mode: '2d', heat: 'visits'",
    "space": "mode: '3d'",
}
"""What is shown, as changes of the page's state."""

FRAMES = """seconds => new Promise(done => {
  const { rmfs } = window;
  const frames = rmfs.frames, from = performance.now();
  const look = now => {
    const passed = (now - from) / 1000;
    if (passed < seconds) requestAnimationFrame(look);
    else done((rmfs.frames - frames) / passed);
  };
  requestAnimationFrame(look);
})"""


CARD = """const context = WebGL2RenderingContext.prototype, told = context.getParameter;
const RENDERER = 0x9246;
context.getParameter = function (name) {
  return name === RENDERER ? "a card" : told.call(this, name);
};
for (const kind of ["Arrays", "Elements"])
  for (const many of ["", "Instanced"]) context[`draw${kind}${many}`] = () => {};
"""
"""Makes the page work for a graphics card, and lets nothing be drawn."""


@dataclass(frozen=True, slots=True)
class Speed:
    """What one view needs.

    Attributes
    ----------
    frames_per_s
        Drawn while the run plays.
    page_ms
        Processor time of the page's own thread per frame: its code, its layout and its commands to
        the graphics, which a graphics card does not take over.
    processor_ms
        Processor time of the whole browser per frame, drawing included.
    draw_calls
        Of one frame.
    load
        Mean number of busy processes of the machine within the last minute.
    """

    view: str
    robots: int
    pods: int
    frames_per_s: float
    page_ms: float
    processor_ms: float
    draw_calls: int
    load: float


@dataclass(frozen=True, slots=True)
class Size:
    """A fleet in a warehouse, and how many such stand side by side, squared."""

    robots: int
    pod_share: float
    side: int = 1


SIZES = {"usual": Size(128, 0.866), "large": Size(125, 0.5407, 4)}
"""128 robots and 2,002 pods; 2,000 robots and 20,000 pods."""


def recorded(size: Size) -> bytes:
    """Return the scene of a run of a size."""
    overrides: list[tuple[list[str], Any]] = [
        (["layout", "robots"], size.robots),
        (["layout", "pod_share"], size.pod_share),
        (["scenario", "duration_s"], 600.0),
    ]
    run = rmfs.simulate(
        "study-128", "pp-minimal", "random", seed=1, overrides=overrides, trace=True
    )
    with TemporaryDirectory() as parent:
        folder = Path(parent) / "run"
        write_run(run, folder, trace=True)
        packed = scene.of_run(load_run(folder))
    return packed if size.side == 1 else copies(packed, size.side)


def table(packed: bytes, seconds: float = SECONDS, *, card: bool = False) -> pd.DataFrame:
    """Measure all views of a run, one row each.

    Parameters
    ----------
    packed
        Scene of the run.
    seconds
        Wall time per view.
    card
        Whether to leave out the drawing, as if a graphics card did it at no cost.
    """
    _, arrays = unpack(packed)
    robots, pods = len(arrays["robot_waypoint"]), len(arrays["pod_waypoint"])
    session = {"runs": 1, "live": False, "form": False}
    server = Server(
        {"/session": lambda _: Answer.json(session), "/runs/0": lambda _: Answer.scene(packed)}
    )
    measured: list[Speed] = []
    with served(server) as url, chromium() as browser:
        for view, change in VIEWS.items():
            figures = _measure(browser, url, change, seconds, card)
            measured.append(Speed(view, robots, pods, *figures, os.getloadavg()[0]))
    return pd.DataFrame([asdict(one) for one in measured])


def _measure(
    browser: Browser, url: str, change: str, seconds: float, card: bool
) -> tuple[float, float, float, int]:
    # waiting for a function of the page is what its policy forbids
    page = open_page(browser, viewport={"width": WIDTH, "height": HEIGHT}, bypass_csp=True)
    if card:
        page.add_init_script(CARD)
    show(page, url)
    page.evaluate(f"rmfs.store.set({{ time_s: 120, speed: 10, playing: true, {change} }})")
    page.evaluate(FRAMES, 1.0)
    before = *_processor_s(), _frames(page)
    rate = float(page.evaluate(FRAMES, seconds))
    after = *_processor_s(), _frames(page)
    page_s, processor_s, frames = (b - a for a, b in zip(before, after, strict=True))
    calls = int(page.evaluate("rmfs.panes[0].stage.renderer.info.render.calls"))
    page.close()
    return rate, 1000 * page_s / max(frames, 1), 1000 * processor_s / max(frames, 1), calls


def _frames(page: Page) -> int:
    return int(page.evaluate("rmfs.frames"))


def _processor_s() -> tuple[float, float]:
    """Processor time so far: of the page's own thread, and of the whole browser."""
    page_s = total_s = 0.0
    for process in psutil.Process().children(recursive=True):
        with contextlib.suppress(psutil.NoSuchProcess):
            times = process.cpu_times()
            total_s += times.user + times.system
            if "--type=renderer" in process.cmdline():
                # the first thread of a process has its number; of several pages the busiest counts
                own = [thread for thread in process.threads() if thread.id == process.pid]
                page_s = max([page_s, *(thread.user_time + thread.system_time for thread in own)])
    return page_s, total_s
