"""Opening the viewer in Chromium without a window, drawn in software: the same on every machine."""

from __future__ import annotations

import shutil
import threading
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rmfs.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Browser, Page

    from rmfs.view.server import Server

PROGRAMS = ("chromium", "chromium-browser", "google-chrome")
SOFTWARE = ["--no-sandbox", "--enable-unsafe-swiftshader", "--disable-dev-shm-usage"]
"""Draws without a graphics card, and without rights and memory that a container may not have."""

PATIENCE_MS = 120_000
"""How long to wait for what a busy machine draws in software."""


def open_page(browser: Browser, **options: Any) -> Page:
    """Open a page that waits patiently for all that is asked of it."""
    page = browser.new_page(**options)
    page.set_default_timeout(PATIENCE_MS)
    return page


def installed() -> str | None:
    """Return the Chromium to use: the system's, or that of playwright; nothing without either."""
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        return None
    for name in PROGRAMS:
        found = shutil.which(name)
        if found is not None:
            return found
    with sync_playwright() as playwright:
        own = playwright.chromium.executable_path
    return own if Path(own).is_file() else None


@contextmanager
def chromium() -> Iterator[Browser]:
    """Yield a browser without a window.

    Raises
    ------
    InputError
        If playwright or Chromium is not installed.
    """
    program = installed()
    if program is None:
        raise InputError(
            "needs Chromium and playwright: pip install playwright, then the package chromium of "
            "the system or `playwright install chromium`"
        )
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=program, args=SOFTWARE, timeout=PATIENCE_MS
        )
        yield browser
        browser.close()


@contextmanager
def served(server: Server) -> Iterator[str]:
    """Serve beside this thread; yields the address."""
    with server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield server.url
        server.shutdown()


def show(page: Page, url: str) -> None:
    """Go to an address of the viewer, wait for its first frame, and let the time stand still."""
    page.goto(url)
    page.wait_for_function("window.rmfs?.frames > 0")
    page.evaluate("window.rmfs.store.set({ playing: false })")
