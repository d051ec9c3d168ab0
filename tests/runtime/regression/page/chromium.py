"""A real browser for tests: Debian's Chromium without a window, driven by Playwright."""

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

MISSING = [name for name in ("chromium",) if shutil.which(name) is None]
MISSING += [name for name in ("playwright",) if find_spec(name) is None]


HANG_MS = 1000 * HANG_S
"""As Playwright takes it, in milliseconds."""


@contextmanager
def browser() -> Iterator[Browser]:
    """The browser, until the block ends."""
    from playwright.sync_api import expect, sync_playwright

    expect.set_options(timeout=HANG_MS)
    with sync_playwright() as playwright:
        started = playwright.chromium.launch(
            executable_path=shutil.which("chromium"), args=["--no-sandbox"], timeout=HANG_MS
        )
        try:
            yield started
        finally:
            started.close()


@contextmanager
def opened(browser: Browser, path: Path, address: str = "", **context: Any) -> Iterator[Page]:
    """A page of its own that shows a file; at the end of the block nothing else was asked for, and nothing went wrong.

    ``context`` is what Playwright's ``new_context`` takes, such as ``viewport`` and ``color_scheme``.
    """
    made = browser.new_context(**context)
    made.set_default_timeout(HANG_MS)
    try:
        page = made.new_page()
        wrong: list[str] = []
        asked: list[str] = []
        page.on("console", lambda message: wrong.append(f"{message.type}: {message.text}"))
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.on("dialog", lambda dialog: (wrong.append(f"dialog: {dialog.message}"), dialog.dismiss()))
        page.on("request", lambda request: asked.append(request.url))
        page.goto(f"{path.as_uri()}{address}")
        yield page
        assert wrong == []
        assert [url.partition("#")[0] for url in asked if not url.startswith("data:")] == [path.as_uri()]
    finally:
        made.close()
