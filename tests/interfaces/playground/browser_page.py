"""The playground's page in a real browser."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import pytest

from tests.interfaces.playground.test_server import running_server
from tests.runtime.regression.page import chromium

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

if not chromium.MISSING:
    from playwright.sync_api import expect


needs_browser = pytest.mark.skipif(bool(chromium.MISSING), reason=f"not installed: {', '.join(chromium.MISSING)}")

SIGNALS = "signal a: bool\nsignal b: bool\nsignal broken: bool\n"
BROKEN = f"{SIGNALS}spec plan {{ limit 9 steps  reach a then c  keep not broken }}\n"
FIXED = BROKEN.replace("then c", "then b")


@pytest.fixture(name="browser", scope="module")
def _browser() -> Iterator[Browser]:
    with chromium.browser() as started:
        yield started


@pytest.fixture(name="address", scope="module")
def _address() -> Iterator[str]:
    with running_server() as server:
        yield server.address


@pytest.fixture(name="page")
def _page(browser: Browser, address: str) -> Iterator[Page]:
    yield from open_page(browser, address)


def open_page(
    browser: Browser, address: str, wrong: list[str] | None = None, link: str = "", **context: Any
) -> Iterator[Page]:
    """A page that logs no error and sends requests only to its own server; errors are appended to
    ``wrong``.

    ``link`` is a fragment that replaces the address's own; the browser then has the token already.
    """
    context_ = browser.new_context(**context)
    context_.set_default_timeout(chromium.HANG_MS)
    try:
        page = context_.new_page()
        base, _, token = address.partition("#token=")
        if link:
            page.add_init_script(f"localStorage.setItem('token', '{token}')")
            address = base + link
        wrong = [] if wrong is None else wrong
        requested: list[str] = []
        page.on("console", lambda message: wrong.append(message.text))
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.on("request", lambda request: requested.append(request.url))
        page.goto(address)
        expect(page.locator("#picture svg")).to_be_visible()
        yield page
        assert wrong == []
        assert [url for url in requested if not url.startswith((address.partition("#")[0], "data:"))] == []
    finally:
        context_.close()


def write(page: Page, text: str) -> None:
    page.get_by_label("Specification").fill(text)


def wait_for_address(page: Page, before: str = "") -> str:
    """Wait until the page has written a new text into its address, and return the address."""
    page.wait_for_url(lambda url: "#1." in url and url != before)
    return page.url


def summary(page: Page, text: str) -> None:
    expect(page.locator("#summary")).to_have_text(re.compile(text))


def current(page: Page) -> str | None:
    lit = page.locator("#picture .state.current")
    expect(lit).to_have_count(1)
    return lit.get_attribute("data-states")
