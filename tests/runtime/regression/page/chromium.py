"""A real browser for tests: Debian's headless Chromium, driven by Playwright."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tests.waiting import HANG_S

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

PROGRAM = shutil.which("chromium-headless-shell") or shutil.which("chromium")
"""The browser. The shell, which has no window, takes two thirds of the CPU time of the whole browser."""

MISSING = [] if PROGRAM else ["chromium-headless-shell"]
MISSING += [name for name in ("playwright",) if find_spec(name) is None]


HANG_MS = 1000 * HANG_S
"""The timeout in milliseconds, the unit of Playwright."""


@contextmanager
def browser() -> Iterator[Browser]:
    """Start the browser, and stop it when the block ends."""
    from playwright.sync_api import expect, sync_playwright

    expect.set_options(timeout=HANG_MS)
    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=PROGRAM, args=["--no-sandbox"], timeout=HANG_MS)
        try:
            yield started
        finally:
            started.close()


@contextmanager
def opened(browser: Browser, path: Path, address: str = "", **context: Any) -> Iterator[Page]:
    """Open a file in a new page until the block ends.

    ``address`` is the end of the address, such as ``#part``. ``context`` is what Playwright's
    ``new_context`` takes, such as ``viewport`` and ``color_scheme``. At the end of the block,
    assert that the page requested no other file and that no error occurred.
    """
    page_context = browser.new_context(**context)
    page_context.set_default_timeout(HANG_MS)
    try:
        page = page_context.new_page()
        errors: list[str] = []
        requests: list[str] = []
        page.on("console", lambda message: errors.append(f"{message.type}: {message.text}"))
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.on("dialog", lambda dialog: (errors.append(f"dialog: {dialog.message}"), dialog.dismiss()))
        page.on("request", lambda request: requests.append(request.url))
        page.goto(f"{path.as_uri()}{address}")
        yield page
        assert errors == []
        assert [url.partition("#")[0] for url in requests if not url.startswith("data:")] == [path.as_uri()]
    finally:
        page_context.close()
