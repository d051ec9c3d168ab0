"""The page in a real browser: type and fix specs, click through traces, and restore everything from
links."""

from __future__ import annotations

import os
import random
import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.interfaces.playground.test_server import SLOW, running_server
from tests.runtime.regression.page import chromium
from tltlc.interfaces.playground.browser import redirect_file
from tltlc.interfaces.playground.page_config import examples
from tltlc.interfaces.playground.site import PYODIDE, site_files
from tltlc.io.writing import write_files

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

pytestmark = pytest.mark.skipif(bool(chromium.MISSING), reason=f"not installed: {', '.join(chromium.MISSING)}")

if not chromium.MISSING:
    from playwright.sync_api import expect

SIGNALS = "signal a: bool\nsignal b: bool\nsignal broken: bool\n"
BROKEN = f"{SIGNALS}spec plan {{ limit 9 steps  reach a then c  keep not broken }}\n"
FIXED = BROKEN.replace("then c", "then b")

PYODIDE_FOLDER = Path(os.environ.get("PYODIDE", "node_modules/pyodide"))
"""The npm package `pyodide`, if it is installed."""


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with chromium.browser() as started:
        yield started


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    with running_server() as server:
        yield server.address


@pytest.fixture
def page(browser: Browser, address: str) -> Iterator[Page]:
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


def test_an_error_is_underlined_and_can_be_fixed(page: Page) -> None:
    write(page, BROKEN)
    summary(page, "^1 error; the rest of the page shows an earlier text$")
    marked = page.locator("#backdrop .mark.error")
    expect(marked).to_have_text("c")
    messages = page.locator("#messages li")
    expect(messages).to_contain_text("no predicate c here")
    # The underlined text is exactly below the typed text.
    area = page.get_by_label("Specification")
    expect(area).to_have_attribute("aria-invalid", "true")
    assert area.bounding_box() == page.locator("#backdrop").bounding_box()
    messages.get_by_role("button", name="line 4").click()
    chosen = "area => area.value.slice(area.selectionStart, area.selectionEnd)"
    assert area.evaluate(chosen) == "c"
    page.keyboard.type("b")
    summary(page, "^It compiles$")
    expect(messages).to_have_count(0)
    expect(area).to_have_attribute("aria-invalid", "false")
    expect(page.locator("#english h2")).to_have_text("plan")
    expect(page.locator("#english ol li")).to_have_text(["a", "b"])
    expect(page.locator("#picture .state")).to_have_count(4)


def test_a_suggested_fix_is_applied_by_a_button_and_undone(page: Page) -> None:
    write(page, "spec plan { limit 9 steps  reach alive }\n")
    summary(page, "^1 error")
    page.get_by_role("button", name="Add import stealth").click()
    summary(page, "^It compiles")
    area = page.get_by_label("Specification")
    expect(area).to_have_value("import stealth\nspec plan { limit 9 steps  reach alive }\n")
    expect(area).to_be_focused()
    page.keyboard.press("ControlOrMeta+z")
    summary(page, "^1 error")
    assert area.input_value() == "spec plan { limit 9 steps  reach alive }\n"


def test_a_fix_of_the_linter_is_applied_by_a_button(page: Page) -> None:
    write(page, f"// 🎮\nentity nobody\n{FIXED}")
    summary(page, "^It compiles; 1 warning$")
    page.get_by_role("button", name="Remove it").click()
    summary(page, "^It compiles$")
    assert page.get_by_label("Specification").input_value() == f"// 🎮\n{FIXED}"


def test_messages_of_an_earlier_text_cannot_be_clicked(page: Page) -> None:
    write(page, BROKEN)
    summary(page, "^1 error")
    line = page.locator("#messages li button").first
    assert line.is_visible()
    still = "area => { area.focus(); document.execCommand('insertText', false, ' '); return messages.inert; }"
    assert page.get_by_label("Specification").evaluate(still)
    summary(page, "^1 error")
    expect(page.locator("#messages")).not_to_have_attribute("inert", "")


def test_names_and_comments_are_not_interpreted_as_markup(page: Page) -> None:
    write(
        page,
        'signal a: bool\n/// <img src=x onerror="alert(1)"> `<b>` </title>\nspec x { limit 9 steps  reach a }\n'
        'test "<script>alert(1)</script>" for x { step a  expect pending }\n',
    )
    summary(page, "^It compiles; 1 error")
    expect(page.locator("#english .doc")).to_have_text('<img src=x onerror="alert(1)"> `<b>` </title>')
    assert page.locator("main img, main script, main b").count() == 0


COVERED = """() => {
    const areas = [...document.querySelectorAll("#picture .frame, #picture .guard")].map((shape) => shape.getBBox());
    const isOver = (a, b) => a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
    return areas.flatMap((a, i) => areas.slice(i + 1).filter((b) => isOver(a, b))).length;
}"""


def test_nothing_overlaps_in_a_dense_picture(page: Page) -> None:
    write(page, f"{SIGNALS}signal c: bool\nspec dense = G((a -> X b) | (c U broken)) & F(b & X c)\n")
    summary(page, "^It compiles")
    expect(page.locator("#english h2")).to_have_text("dense")
    assert page.locator("#picture .edge").count() > 25
    assert page.evaluate(COVERED) == 0


def test_a_long_text_is_underlined_but_not_coloured(page: Page) -> None:
    # Otherwise the whole text would be coloured again at each keystroke.
    long = f"// {'x' * 50_000}\n{BROKEN}"
    page.get_by_label("Specification").evaluate(
        "(area, text) => { area.value = text; area.dispatchEvent(new Event('input')); }", long
    )
    summary(page, "^1 error")
    expect(page.locator("#backdrop span")).to_have_text(["c"])
    assert page.locator("#backdrop").inner_text().strip() == long.strip()
    write(page, BROKEN)
    expect(page.locator("#backdrop .word").first).to_have_text("signal")


def test_a_trace_is_built_by_clicks_until_it_is_accepted(page: Page) -> None:
    write(page, FIXED)
    summary(page, "^It compiles$")
    expect(page.locator("#english h2")).to_have_text("plan")
    for atom, verdict in (("a", "pending"), ("b", "holding")):
        page.get_by_role("button", name="Add step").click()
        row = page.locator("#steps tbody tr").last
        expect(row.locator(".verdict")).to_have_text("pending")
        row.get_by_label(re.compile(f"^{atom} at step")).check()
        expect(row.locator(".verdict")).to_have_text(verdict)
    state = page.locator("#steps tbody tr").last.locator(".at")
    assert current(page) == state.inner_text()
    expect(page.locator("#picture .edge.taken")).to_have_count(1)
    expect(page.locator("#steps .progress span")).to_have_text(["0.5", "1"])
    expect(page.locator("#moment")).to_contain_text("An episode ends here, in success.")
    page.get_by_role("button", name="Previous step").click()
    assert current(page) == page.locator("#steps tbody tr").first.locator(".at").inner_text()
    page.get_by_role("button", name="Remove step 1").click()
    expect(page.locator("#steps .verdict")).to_have_text(["pending"])


def test_a_success_and_a_failure_are_shown(page: Page) -> None:
    for name, verdict in (("Show a success", "holding"), ("Show a failure", "violated")):
        page.get_by_role("button", name=name).click()
        expect(page.locator("#steps .verdict").last).to_have_text(verdict)
    page.get_by_role("button", name="Clear").click()
    expect(page.locator("#steps tbody tr")).to_have_count(0)
    assert current(page) == "0"


def test_signals_are_set_by_sliders_and_numbers(page: Page) -> None:
    page.get_by_role("radio", name="signals").check()
    page.get_by_role("button", name="Add step").click()
    expect(page.locator("#steps .verdict")).to_have_text("pending")
    page.get_by_label("distance(button) at step 1, as a number").fill("0.5")
    expect(page.locator("#steps .at")).to_have_text("1")
    health = page.get_by_label("health at step 1", exact=True)
    health.evaluate("bar => { bar.value = 0; bar.dispatchEvent(new Event('input', { bubbles: true })); }")
    expect(page.locator("#steps .verdict")).to_have_text("violated")
    # The atoms follow from the signals.
    page.get_by_role("radio", name="atoms").check()
    expect(page.get_by_label("near(button) at step 1")).to_be_checked()
    expect(page.get_by_label("alive at step 1")).not_to_be_checked()


def test_a_state_shows_what_remains_by_mouse_and_by_keyboard(page: Page) -> None:
    page.locator("#picture .state").nth(1).click()
    expect(page.locator("#state h3")).to_have_text("State 1 pending 2 steps to the goal")
    expect(page.locator("#state")).to_contain_text("Reach near(lever), then near(exit)")
    page.locator("#picture .state").nth(2).focus()
    page.keyboard.press("Enter")
    expect(page.locator("#state h3")).to_have_text("State 2 violated no way to the goal")
    page.keyboard.press("Enter")
    expect(page.locator("#state h3")).to_contain_text("State 0 ")


def test_every_control_has_an_accessible_name(page: Page) -> None:
    page.get_by_role("button", name="Show a success").click()
    expect(page.locator("#steps .verdict")).to_have_count(3)
    write(page, BROKEN)
    summary(page, "^1 error")
    write(page, FIXED)
    summary(page, "^It compiles$")
    tree = page.locator("body").aria_snapshot()
    assert 'table "Steps of the trace"' in tree
    assert 'group "The automaton of plan"' in tree
    # A role with neither a name nor content cannot be identified by assistive technology.
    assert re.findall(r"- (?:button|textbox|checkbox|slider|img|combobox|radio|meter)\s*$", tree, re.MULTILINE) == []


def test_the_table_can_be_used_by_keyboard(page: Page) -> None:
    page.get_by_role("button", name="Show a success").click()
    expect(page.locator("#steps .verdict")).to_have_count(3)
    page.locator("#steps .go").first.focus()
    page.keyboard.press("ArrowDown")
    expect(page.locator("#steps tr.current .go")).to_have_text("2")
    page.keyboard.press("Tab")
    page.keyboard.press("Space")
    # Two exclusive atoms cannot hold at the same step.
    expect(page.locator("#steps .refused")).to_have_count(1)
    expect(page.locator("#moment")).to_contain_text("against exclusive")


def test_buttons_move_to_both_ends_of_a_trace_by_keyboard(page: Page) -> None:
    page.get_by_role("button", name="Show a success").click()
    expect(page.locator("#steps .verdict")).to_have_count(3)
    back, forth = (page.get_by_role("button", name=name) for name in ("Previous step", "Next step"))
    for button, other, last in ((forth, back, "3"), (back, forth, "1")):
        button.focus()
        for _ in range(4):
            page.keyboard.press("Enter")
        expect(page.locator("#steps tr.current .go")).to_have_text(last)
        expect(button).to_be_focused()
        expect(button).to_have_attribute("aria-disabled", "true")
        expect(other).to_have_attribute("aria-disabled", "false")


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


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_light_and_dark_schemes_can_be_switched(browser: Browser, address: str, scheme: Any) -> None:
    lightness = "() => getComputedStyle(document.body).backgroundColor.match(/\\d+/g).map(Number)[0]"
    for page in open_page(browser, address, color_scheme=scheme):
        assert (page.evaluate(lightness) > 128) == (scheme == "light")
        page.get_by_role("button", name="Switch between dark and light").click()
        assert (page.evaluate(lightness) > 128) == (scheme == "dark")
        page.reload()
        expect(page.locator("#picture svg")).to_be_visible()
        assert (page.evaluate(lightness) > 128) == (scheme == "dark")


@pytest.mark.parametrize("width", [360, 1280])
def test_nothing_is_wider_than_the_screen(browser: Browser, address: str, width: int) -> None:
    for page in open_page(browser, address, viewport={"width": width, "height": 800}):
        page.get_by_role("radio", name="signals").check()
        page.get_by_role("button", name="Add step").click()
        expect(page.locator("#steps .verdict")).to_have_count(1)
        assert page.evaluate("() => document.documentElement.scrollWidth") <= width


def test_every_example_is_shown(page: Page) -> None:
    options = page.locator("#examples option")
    expect(options).to_have_count(1 + len(examples()))
    for index, example in enumerate(examples()):
        assert options.nth(index + 1).inner_text() == example["title"]
        page.get_by_label("Example").select_option(str(index))
        expect(page.get_by_label("Specification")).to_have_value(example["text"])
        summary(page, "^It compiles")


def test_the_menu_names_the_open_example(page: Page) -> None:
    menu, area = page.get_by_label("Example"), page.get_by_label("Specification")
    expect(menu).to_have_value("0")
    menu.select_option("1")
    summary(page, "^It compiles")
    expect(menu).to_have_value("1")
    area.press("End")
    page.keyboard.type("!")
    expect(menu).to_have_value("")
    # Choosing the same example again discards the edit.
    menu.select_option("1")
    expect(area).to_have_value(examples()[1]["text"])


def test_the_picture_uses_words_or_symbols(page: Page) -> None:
    before = wait_for_address(page)
    write(page, FIXED)
    summary(page, "^It compiles$")
    wait_for_address(page, before)
    trap = page.locator("#picture .state.violated .label")
    expect(trap).to_have_text("The spec is violated.")
    expect(page.locator("#state .formula")).to_have_count(0)
    page.get_by_role("radio", name="symbols").check()
    expect(trap).to_have_text("⊥")
    expect(page.locator("#state .formula")).to_have_text("◇(a ∧ ○◇b) ∧ □¬broken")
    page.reload()
    expect(trap).to_have_text("⊥")
    page.get_by_role("radio", name="words").check()
    expect(trap).to_have_text("The spec is violated.")


@pytest.mark.parametrize("mode", ["atoms", "signals"])
def test_a_trace_of_an_earlier_text_has_a_warning(page: Page, mode: str) -> None:
    write(page, FIXED)
    summary(page, "^It compiles$")
    page.get_by_role("button", name="Show a success").click()
    expect(page.locator("#steps .verdict")).to_have_count(2)
    page.get_by_role("radio", name=mode).check()
    warning = page.locator("#strange")
    expect(warning).to_be_hidden()
    write(page, FIXED.replace("signal b: bool", "signal door: bool").replace("then b", "then door"))
    expect(warning).to_contain_text(f"They set b, which has no effect, because the spec has no such {mode}.")
    expect(page.locator("#steps .verdict")).to_have_text(["pending", "pending"])
    page.get_by_role("button", name="Clear").click()
    expect(warning).to_be_hidden()


@pytest.mark.slow
@pytest.mark.skipif(not all((PYODIDE_FOLDER / name).is_file() for name in PYODIDE), reason="no npm package `pyodide`")
def test_the_site_compiles_in_the_browser(browser: Browser, tmp_path: Path) -> None:
    from functools import partial
    from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
    from threading import Thread

    class Quiet(SimpleHTTPRequestHandler):
        def log_message(self, *_: object) -> None:
            pass

    write_files(tmp_path, site_files(PYODIDE_FOLDER))
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(tmp_path))) as server:
        Thread(target=server.serve_forever, daemon=True).start()
        wrong: list[str] = []
        for page in open_page(browser, f"http://127.0.0.1:{server.server_address[1]}/", wrong):
            # The test moves the clock of the page, so that no worker computes until the time is over.
            page.clock.install()
            write(page, BROKEN)
            summary(page, "^1 error")
            # A compilation that takes too long is abandoned for the next text.
            write(page, SLOW)
            summary(page, "^Compiling…$")
            write(page, FIXED)
            page.clock.run_for(4_000)
            summary(page, "^It compiles$")
            page.get_by_role("button", name="Show a success").click()
            expect(page.locator("#steps .verdict")).to_have_text(["pending", "holding"])
            assert wrong == []
            write(page, SLOW)
            summary(page, "^Compiling…$")
            page.clock.run_for(10_000)
            summary(page, "^1 error; the rest of the page shows an earlier text$")
            expect(page.locator("#messages li")).to_contain_text("was stopped")
            write(page, FIXED)
            summary(page, "^It compiles$")
            assert wrong == []
        server.shutdown()
