"""Opening the page in tests: skips them where playwright or Chromium is missing."""

from __future__ import annotations

from typing import Any

import pytest

from tests.tools.viewer import chromium

PROGRAM = chromium.installed()

needs_browser = pytest.mark.skipif(
    PROGRAM is None, reason="playwright or Chromium is not installed"
)

show = chromium.show


def state(page: Any, name: str) -> Any:
    return page.evaluate(f"window.rmfs.store.state.{name}")


def put(page: Any, change: str) -> None:
    """Change what is shown, and draw it at once."""
    page.evaluate(f"window.rmfs.store.set({{ {change} }}); window.rmfs.picture(); null")
