"""A stranger's way: from the README to the orders that wait for a pod at 10:35, step by step."""

import re
import shlex
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest
from in_browser import needs_browser
from test_view_browser_orders import brought

from rmfs.measure import load_run

pytestmark = [pytest.mark.slow, needs_browser]

ROOT = Path(__file__).resolve().parents[2]
ASKED_S = 10 * 60 + 35


def commands() -> list[list[str]]:
    """Return the command of the README that records a run, and the one that shows it."""
    text = (ROOT / "README.md").read_text("utf-8")
    run = re.search(r"^rmfs (run .*--trace.*)$", text, re.MULTILINE)
    view = re.search(r"`rmfs (view results/\w+)`", text)
    assert run is not None and view is not None
    return [shlex.split(run[1]), shlex.split(view[1])]


def test_which_orders_wait_for_which_pod(page: Any, tmp_path: Path, record_property: Any) -> None:
    begun = time.monotonic()

    def passed(step: str) -> None:
        record_property(step, round(time.monotonic() - begun, 1))
        print(f"{step}: {time.monotonic() - begun:.1f} s")

    run, view = commands()
    subprocess.run([sys.executable, "-m", "rmfs", *run], cwd=tmp_path, check=True)
    passed("the run is recorded")
    server = subprocess.Popen(
        [sys.executable, "-m", "rmfs", *view, "--no-open"],
        cwd=tmp_path,
        text=True,
        stdout=subprocess.PIPE,
    )
    try:
        assert server.stdout is not None
        page.goto(server.stdout.readline().strip())
        page.wait_for_selector("#tab-orders")
        passed("the page is there")
        page.fill("#time", "10:35")
        page.keyboard.press("Enter")
        page.click("#tab-orders")
        page.select_option("#choose-grouping", "pod")
        page.wait_for_selector(".board .order[data-pod] .wanted")
        passed("the answer is there")
        rows = page.locator(".board .order[data-pod]").evaluate_all(
            """rows => rows.map(row => [
              Number(row.dataset.pod),
              [...row.querySelectorAll('.wanted button')].map(one =>
                Number(one.textContent.slice(1))),
            ])"""
        )
    finally:
        server.send_signal(signal.SIGINT)
        server.communicate(timeout=60)
    events = load_run(tmp_path / view[1]).events
    expected: dict[int, list[int]] = {}
    for _, pod, order, _, _ in brought(events, ASKED_S):
        expected.setdefault(pod, []).append(order)
    assert {pod: sorted(orders) for pod, orders in rows} == {
        pod: sorted(orders) for pod, orders in expected.items()
    }
    assert len(expected) > 3
