"""The page in a real browser: links that restore everything, and tokens in addresses."""

from __future__ import annotations

import random
from typing import TYPE_CHECKING

from tests.interfaces.playground.browser_page import (  # noqa: F401
    BROKEN,
    FIXED,
    _address,
    _browser,
    _page,
    needs_browser,
    open_page,
    summary,
    wait_for_address,
    write,
)
from tests.interfaces.playground.test_server import running_server
from tests.runtime.regression.page import chromium
from tltlc.interfaces.playground.browser import redirect_file

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

if not chromium.MISSING:
    from playwright.sync_api import expect

pytestmark = needs_browser


def test_a_link_restores_everything(page: Page, browser: Browser, address: str) -> None:
    write(page, FIXED + "spec other = F a & G !b // ≤ 🎮\n")
    summary(page, "^It compiles")
    page.get_by_role("button", name="other").click()
    expect(page.locator("#english h2")).to_have_text("other")
    page.get_by_role("button", name="Show a failure").click()
    expect(page.locator("#steps .verdict")).to_have_text(["violated"])
    page.get_by_role("button", name="Copy link").click()
    summary(page, "it contains the text")
    link = page.url.removeprefix(address.partition("#")[0])
    assert "token" not in link
    for other_page in open_page(browser, address, link=link):
        expect(other_page.locator("#steps .verdict")).to_have_text(["violated"])
        expect(other_page.locator("#english h2")).to_have_text("other")
        expect(other_page.get_by_label("Specification")).to_have_value(FIXED + "spec other = F a & G !b // ≤ 🎮\n")


def test_a_broken_link_shows_an_example(browser: Browser, address: str) -> None:
    for page in open_page(browser, address, link="#1.nonsense"):
        expect(page.locator("#english h2")).to_have_text("escape")


PACKED = """async (value) => (await import("./share.js")).packed(value)"""


def test_a_link_with_invalid_values_is_opened(page: Page, browser: Browser, address: str) -> None:
    letters = [["a", 3, {"b": 1}], None, {"0": "a"}, "a", [["a"]], *([["b"]] * 1200)]
    link = page.evaluate(PACKED, {"text": FIXED, "spec": {"x": 1}, "mode": [], "letters": letters, "current": -7.5})
    for other_page in open_page(browser, address, link=link):
        expect(other_page.locator("#steps tbody tr")).to_have_count(1000)
        expect(other_page.locator("#steps tr.current .verdict")).to_have_text("pending")
        expect(other_page.get_by_role("button", name="Add step")).to_be_disabled()


def test_a_link_that_unpacks_to_too_much_is_ignored(page: Page, browser: Browser, address: str) -> None:
    link = page.evaluate(PACKED, {"text": " " * 20_000_000})
    assert len(link) < 50_000
    for other_page in open_page(browser, address, link=link):
        expect(other_page.locator("#english h2")).to_have_text("escape")


def test_a_long_link_has_a_warning(page: Page) -> None:
    words = random.Random(0)
    write(page, f"{FIXED}// {' '.join(str(words.random()) for _ in range(500))}\n")
    summary(page, "^It compiles$")
    page.get_by_role("button", name="Copy link").click()
    summary(page, r"It has \d{4,} characters, and some programs cut long links\.$")


def test_a_text_too_long_for_a_link_is_reported(page: Page) -> None:
    words = random.Random(0)
    long = f"{FIXED}// {' '.join(str(words.random()) for _ in range(50_000))}\n"
    page.get_by_label("Specification").evaluate(
        "(area, text) => { area.value = text; area.dispatchEvent(new Event('input')); }", long
    )
    summary(page, "^It compiles$")
    page.get_by_role("button", name="Copy link").click()
    summary(page, "^The text is too long for a link: save it as a file.$")
    assert "#" not in page.url


def test_a_stopped_server_is_reported(browser: Browser) -> None:
    with running_server() as server:
        context = browser.new_context()
        context.set_default_timeout(chromium.HANG_MS)
        page = context.new_page()
        page.goto(server.address)
        summary(page, "^It compiles")
        server.shutdown()
        server.server_close()
        write(page, BROKEN)
        summary(page, "^No answer: the server is gone; start `tltlc serve` again$")
        context.close()


def test_the_token_leaves_the_address_and_is_kept_for_reloads_and_tabs(browser: Browser, address: str) -> None:
    for page in open_page(browser, address):
        before = wait_for_address(page)
        write(page, BROKEN)
        summary(page, "^1 error")
        assert "token" not in wait_for_address(page, before)
        page.reload()
        summary(page, "^1 error")
        page.get_by_role("button", name="Copy link").click()
        summary(page, "it contains the text")
        assert "token" not in page.url
        other = page.context.new_page()
        other.goto(page.url)
        summary(other, "^1 error")


def test_without_the_token_the_page_says_which_address_to_open(browser: Browser, address: str) -> None:
    base, _, token = address.partition("#")
    context = browser.new_context()
    page = context.new_page()
    page.goto(base)
    summary(page, "^The page could not start: open the address that `tltlc serve` shows, because this address has no")
    # Only the fragment changes, so the browser does not reload the page.
    page.goto(f"{base}#{token}")
    summary(page, "^It compiles")
    context.close()


def test_the_file_that_serve_opens_leads_to_the_page(browser: Browser, address: str) -> None:
    context = browser.new_context()
    context.set_default_timeout(chromium.HANG_MS)
    page = context.new_page()
    with redirect_file(address) as uri:
        page.goto(uri)
        summary(page, "^It compiles")
    assert "token" not in page.url
    context.close()


STORED = "() => localStorage.getItem('token')"


def test_a_link_with_a_wrong_token_does_not_replace_the_right_one(browser: Browser, address: str) -> None:
    base, _, token = address.partition("#token=")
    context = browser.new_context()
    context.set_default_timeout(chromium.HANG_MS)
    page = context.new_page()
    page.goto(address)
    summary(page, "^It compiles")
    assert page.evaluate(STORED) == token
    # In the same tab only the fragment changes; another tab starts with the link.
    other = context.new_page()
    for tab in (page, other):
        tab.goto(f"{base}#token=junk")
        tab.wait_for_function("() => !location.hash.includes('junk')")
        expect(tab.locator("#picture svg")).to_be_visible()
        assert tab.evaluate(STORED) == token
        write(tab, BROKEN)
        summary(tab, "^1 error")
    # A browser without a valid token does not store the wrong one either.
    stranger = browser.new_context().new_page()
    stranger.goto(f"{base}#token=junk")
    summary(stranger, "^The page could not start: open the address that `tltlc serve` shows")
    assert stranger.evaluate(STORED) is None
    stranger.context.close()
    context.close()


def test_a_tab_uses_the_token_given_to_another_tab(browser: Browser) -> None:
    with running_server() as server:
        context = browser.new_context()
        context.set_default_timeout(chromium.HANG_MS)
        page, other = context.new_page(), context.new_page()
        page.goto(server.address)
        summary(page, "^It compiles")
        server.page._token = b"new"
        other.goto(f"{server.address.partition('#')[0]}#token=new")
        summary(other, "^It compiles")
        write(page, BROKEN)
        summary(page, "^1 error")
        context.close()


def test_a_restarted_server_is_used_with_its_new_token(browser: Browser) -> None:
    with running_server() as server:
        context = browser.new_context()
        page = context.new_page()
        page.goto(server.address)
        summary(page, "^It compiles")
        # A new server at the same port has another token.
        server.page._token = b"new"
        write(page, BROKEN)
        summary(page, "^No answer: open the address that `tltlc serve` shows")
        page.goto(f"{server.address.partition('#')[0]}#token=new")
        summary(page, "^1 error")
        expect(page.get_by_label("Specification")).to_have_value(BROKEN)
        context.close()


ATTACK = """async (address) => {
    const asked = { method: "POST", body: "{}", headers: { "Content-Type": "application/json" } };
    const outcomes = [];
    const plain = { ...asked, headers: { "Content-Type": "text/plain" } };
    for (const request of [asked, plain, { ...plain, mode: "no-cors" }]) {
        outcomes.push(await fetch(`${address}api`, request).then((answer) => answer.type, () => "refused"));
    }
    const script = await new Promise((resolve) => {
        const made = Object.assign(document.createElement("script"), { src: `${address}main.js` });
        made.onload = () => resolve("loaded");
        made.onerror = () => resolve("refused");
        document.body.append(made);
    });
    return [...outcomes, script];
}"""


def test_a_page_of_another_server_gets_no_answer(browser: Browser) -> None:
    """The page belongs to another local server, which the browser treats as the same site."""
    with running_server() as server, running_server() as other:
        context = browser.new_context(bypass_csp=True)
        page = context.new_page()
        page.goto(other.address)
        summary(page, "^It compiles")
        # The browser hides the answers from the page. The answer to `no-cors` is opaque, and is the server's
        # rejection.
        outcomes = page.evaluate(ATTACK, server.address.partition("#")[0])
        assert outcomes == ["refused", "refused", "refused", "refused"]
        context.close()
