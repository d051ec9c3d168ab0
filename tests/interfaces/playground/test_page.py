"""The page in a real browser: specs are typed and mended, traces clicked through, links restore everything."""

from __future__ import annotations

import os
import random
import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.interfaces.playground.test_server import SLOW, serving
from tests.runtime.regression.page import chromium
from tltlc.interfaces.playground.browser import leading_to
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
MENDED = BROKEN.replace("then c", "then b")

PYODIDE_FOLDER = Path(os.environ.get("PYODIDE", "node_modules/pyodide"))
"""The npm package `pyodide`, where there is one."""


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with chromium.browser() as started:
        yield started


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    with serving() as server:
        yield server.address


@pytest.fixture
def page(browser: Browser, address: str) -> Iterator[Page]:
    yield from opened(browser, address)


def opened(
    browser: Browser, address: str, wrong: list[str] | None = None, link: str = "", **context: Any
) -> Iterator[Page]:
    """A page on which nothing goes wrong, and that asks nobody else; ``wrong`` is the list that it writes to.

    ``link`` is a fragment to open in place of that of the address, by a browser that knows the token already.
    """
    made = browser.new_context(**context)
    made.set_default_timeout(chromium.HANG_MS)
    try:
        page = made.new_page()
        base, _, token = address.partition("#token=")
        if link:
            page.add_init_script(f"localStorage.setItem('token', '{token}')")
            address = base + link
        wrong = [] if wrong is None else wrong
        asked: list[str] = []
        page.on("console", lambda message: wrong.append(message.text))
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.on("request", lambda request: asked.append(request.url))
        page.goto(address)
        expect(page.locator("#picture svg")).to_be_visible()
        yield page
        assert wrong == []
        assert [url for url in asked if not url.startswith((address.partition("#")[0], "data:"))] == []
    finally:
        made.close()


def write(page: Page, text: str) -> None:
    page.get_by_label("Specification").fill(text)


def kept_address(page: Page, before: str = "") -> str:
    """The address once it holds a text that was not in it before: the page writes it there in a while."""
    page.wait_for_url(lambda url: "#1." in url and url != before)
    return page.url


def summary(page: Page, text: str) -> None:
    expect(page.locator("#summary")).to_have_text(re.compile(text))


def current(page: Page) -> str | None:
    lit = page.locator("#picture .state.current")
    expect(lit).to_have_count(1)
    return lit.get_attribute("data-states")


def test_a_mistake_is_underlined_at_its_place_and_mended(page: Page) -> None:
    write(page, BROKEN)
    summary(page, "^1 error; what is shown is of an earlier text$")
    marked = page.locator("#backdrop .mark.error")
    expect(marked).to_have_text("c")
    said = page.locator("#messages li")
    expect(said).to_contain_text("no predicate c here")
    # What is underlined stands exactly below what is typed.
    area = page.get_by_label("Specification")
    expect(area).to_have_attribute("aria-invalid", "true")
    assert area.bounding_box() == page.locator("#backdrop").bounding_box()
    said.get_by_role("button", name="line 4").click()
    chosen = "area => area.value.slice(area.selectionStart, area.selectionEnd)"
    assert area.evaluate(chosen) == "c"
    page.keyboard.type("b")
    summary(page, "^It compiles$")
    expect(said).to_have_count(0)
    expect(area).to_have_attribute("aria-invalid", "false")
    expect(page.locator("#english h2")).to_have_text("plan")
    expect(page.locator("#english ol li")).to_have_text(["a", "b"])
    expect(page.locator("#picture .state")).to_have_count(4)


def test_a_way_out_of_an_error_is_taken_by_a_button_and_undone(page: Page) -> None:
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


def test_a_fix_of_the_linter_is_made_by_a_button(page: Page) -> None:
    write(page, f"// 🎮\nentity nobody\n{MENDED}")
    summary(page, "^It compiles; 1 warning$")
    page.get_by_role("button", name="Remove it").click()
    summary(page, "^It compiles$")
    assert page.get_by_label("Specification").input_value() == f"// 🎮\n{MENDED}"


def test_a_message_of_an_earlier_text_cannot_be_clicked(page: Page) -> None:
    write(page, BROKEN)
    summary(page, "^1 error")
    line = page.locator("#messages li button").first
    assert line.is_visible()
    still = "area => { area.focus(); document.execCommand('insertText', false, ' '); return messages.inert; }"
    assert page.get_by_label("Specification").evaluate(still)
    summary(page, "^1 error")
    expect(page.locator("#messages")).not_to_have_attribute("inert", "")


def test_names_and_words_are_no_markup(page: Page) -> None:
    write(
        page,
        'signal a: bool\n/// <img src=x onerror="alert(1)"> `<b>` </title>\nspec x { limit 9 steps  reach a }\n'
        'test "<script>alert(1)</script>" for x { step a  expect pending }\n',
    )
    summary(page, "^It compiles; 1 error")
    expect(page.locator("#english .doc")).to_have_text('<img src=x onerror="alert(1)"> `<b>` </title>')
    assert page.locator("main img, main script, main b").count() == 0


COVERED = """() => {
    const areas = [...document.querySelectorAll("#picture .frame, #picture .guard")].map((each) => each.getBBox());
    const isOver = (a, b) => a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
    return areas.flatMap((a, i) => areas.slice(i + 1).filter((b) => isOver(a, b))).length;
}"""


def test_nothing_is_covered_in_a_dense_picture(page: Page) -> None:
    write(page, f"{SIGNALS}signal c: bool\nspec dense = G((a -> X b) | (c U broken)) & F(b & X c)\n")
    summary(page, "^It compiles")
    expect(page.locator("#english h2")).to_have_text("dense")
    assert page.locator("#picture .edge").count() > 25
    assert page.evaluate(COVERED) == 0


def test_a_long_text_is_underlined_but_not_coloured(page: Page) -> None:
    # At each keystroke all of it would be coloured anew.
    long = f"// {'x' * 50_000}\n{BROKEN}"
    page.get_by_label("Specification").evaluate(
        "(area, text) => { area.value = text; area.dispatchEvent(new Event('input')); }", long
    )
    summary(page, "^1 error")
    expect(page.locator("#backdrop span")).to_have_text(["c"])
    assert page.locator("#backdrop").inner_text().strip() == long.strip()
    write(page, BROKEN)
    expect(page.locator("#backdrop .word").first).to_have_text("signal")


def test_a_trace_is_clicked_through_to_acceptance(page: Page) -> None:
    write(page, MENDED)
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
    page.get_by_role("button", name="Step back").click()
    assert current(page) == page.locator("#steps tbody tr").first.locator(".at").inner_text()
    page.get_by_role("button", name="Remove step 1").click()
    expect(page.locator("#steps .verdict")).to_have_text(["pending"])


def test_ways_to_succeed_and_to_fail_are_shown(page: Page) -> None:
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
    # The atoms are those of the signals.
    page.get_by_role("radio", name="atoms").check()
    expect(page.get_by_label("near(button) at step 1")).to_be_checked()
    expect(page.get_by_label("alive at step 1")).not_to_be_checked()


def test_a_state_says_what_remains_there_by_mouse_and_by_keyboard(page: Page) -> None:
    page.locator("#picture .state").nth(1).click()
    expect(page.locator("#state h3")).to_have_text("State 1 pending 2 steps to the goal")
    expect(page.locator("#state")).to_contain_text("Reach near(lever), then near(exit)")
    page.locator("#picture .state").nth(2).focus()
    page.keyboard.press("Enter")
    expect(page.locator("#state h3")).to_have_text("State 2 violated no way to the goal")
    page.keyboard.press("Enter")
    expect(page.locator("#state h3")).to_contain_text("State 0 ")


def test_everything_that_one_can_act_on_has_a_name(page: Page) -> None:
    page.get_by_role("button", name="Show a success").click()
    expect(page.locator("#steps .verdict")).to_have_count(3)
    write(page, BROKEN)
    summary(page, "^1 error")
    write(page, MENDED)
    summary(page, "^It compiles$")
    tree = page.locator("body").aria_snapshot()
    assert 'table "Steps of the trace"' in tree
    assert 'group "The automaton of plan"' in tree
    # A role with neither a name nor content is one that nobody can know.
    assert re.findall(r"- (?:button|textbox|checkbox|slider|img|combobox|radio|meter)\s*$", tree, re.MULTILINE) == []


def test_the_table_is_walked_through_by_keyboard(page: Page) -> None:
    page.get_by_role("button", name="Show a success").click()
    expect(page.locator("#steps .verdict")).to_have_count(3)
    page.locator("#steps .go").first.focus()
    page.keyboard.press("ArrowDown")
    expect(page.locator("#steps tr.current .go")).to_have_text("2")
    page.keyboard.press("Tab")
    page.keyboard.press("Space")
    # Two that are exclusive cannot hold at once.
    expect(page.locator("#steps .refused")).to_have_count(1)
    expect(page.locator("#moment")).to_contain_text("against exclusive")


def test_steps_are_walked_to_both_ends_by_keyboard(page: Page) -> None:
    page.get_by_role("button", name="Show a success").click()
    expect(page.locator("#steps .verdict")).to_have_count(3)
    back, forth = (page.get_by_role("button", name=name) for name in ("Step back", "Step on"))
    for button, other, last in ((forth, back, "3"), (back, forth, "1")):
        button.focus()
        for _ in range(4):
            page.keyboard.press("Enter")
        expect(page.locator("#steps tr.current .go")).to_have_text(last)
        expect(button).to_be_focused()
        expect(button).to_have_attribute("aria-disabled", "true")
        expect(other).to_have_attribute("aria-disabled", "false")


def test_a_link_restores_everything(page: Page, browser: Browser, address: str) -> None:
    write(page, MENDED + "spec other = F a & G !b // ≤ 🎮\n")
    summary(page, "^It compiles")
    page.get_by_role("button", name="other").click()
    expect(page.locator("#english h2")).to_have_text("other")
    page.get_by_role("button", name="Show a failure").click()
    expect(page.locator("#steps .verdict")).to_have_text(["violated"])
    page.get_by_role("button", name="Copy link").click()
    summary(page, "text is in it")
    link = page.url.removeprefix(address.partition("#")[0])
    assert "token" not in link
    for other in opened(browser, address, link=link):
        expect(other.locator("#steps .verdict")).to_have_text(["violated"])
        expect(other.locator("#english h2")).to_have_text("other")
        expect(other.get_by_label("Specification")).to_have_value(MENDED + "spec other = F a & G !b // ≤ 🎮\n")


def test_a_broken_link_shows_an_example(browser: Browser, address: str) -> None:
    for page in opened(browser, address, link="#1.nonsense"):
        expect(page.locator("#english h2")).to_have_text("escape")


PACKED = """async (value) => (await import("./share.js")).packed(value)"""


def test_a_link_may_hold_anything(page: Page, browser: Browser, address: str) -> None:
    letters = [["a", 3, {"b": 1}], None, {"0": "a"}, "a", [["a"]], *([["b"]] * 1200)]
    link = page.evaluate(PACKED, {"text": MENDED, "spec": {"x": 1}, "mode": [], "letters": letters, "current": -7.5})
    for other in opened(browser, address, link=link):
        expect(other.locator("#steps tbody tr")).to_have_count(1000)
        expect(other.locator("#steps tr.current .verdict")).to_have_text("pending")
        expect(other.get_by_role("button", name="Add step")).to_be_disabled()


def test_a_link_that_never_ends_is_none(page: Page, browser: Browser, address: str) -> None:
    link = page.evaluate(PACKED, {"text": " " * 20_000_000})
    assert len(link) < 50_000
    for other in opened(browser, address, link=link):
        expect(other.locator("#english h2")).to_have_text("escape")


def test_a_long_link_is_said_to_be_one(page: Page) -> None:
    words = random.Random(0)
    write(page, f"{MENDED}// {' '.join(str(words.random()) for _ in range(500))}\n")
    summary(page, "^It compiles$")
    page.get_by_role("button", name="Copy link").click()
    summary(page, r"It has \d{4,} characters, and some programs cut long links\.$")


def test_a_text_that_no_link_can_hold(page: Page) -> None:
    words = random.Random(0)
    long = f"{MENDED}// {' '.join(str(words.random()) for _ in range(50_000))}\n"
    page.get_by_label("Specification").evaluate(
        "(area, text) => { area.value = text; area.dispatchEvent(new Event('input')); }", long
    )
    summary(page, "^It compiles$")
    page.get_by_role("button", name="Copy link").click()
    summary(page, "^The text is too long for a link: keep it as a file.$")
    assert "#" not in page.url


def test_a_server_that_is_gone_is_said_to_be(browser: Browser) -> None:
    with serving() as server:
        made = browser.new_context()
        made.set_default_timeout(chromium.HANG_MS)
        page = made.new_page()
        page.goto(server.address)
        summary(page, "^It compiles")
        server.shutdown()
        server.server_close()
        write(page, BROKEN)
        summary(page, "^No answer: the server is gone; start `tltlc serve` again$")
        made.close()


def test_the_token_leaves_the_address_and_is_kept_for_reloads_and_other_tabs(browser: Browser, address: str) -> None:
    for page in opened(browser, address):
        before = kept_address(page)
        write(page, BROKEN)
        summary(page, "^1 error")
        assert "token" not in kept_address(page, before)
        page.reload()
        summary(page, "^1 error")
        page.get_by_role("button", name="Copy link").click()
        summary(page, "text is in it")
        assert "token" not in page.url
        other = page.context.new_page()
        other.goto(page.url)
        summary(other, "^1 error")


def test_without_the_token_the_page_says_which_address_to_open(browser: Browser, address: str) -> None:
    base, _, token = address.partition("#")
    made = browser.new_context()
    page = made.new_page()
    page.goto(base)
    summary(page, "^It could not begin: open the address that `tltlc serve` shows: the token in it is missing here")
    # Only the fragment changes, so that the browser loads nothing anew by itself.
    page.goto(f"{base}#{token}")
    summary(page, "^It compiles")
    made.close()


def test_the_file_that_serve_opens_leads_to_the_page(browser: Browser, address: str) -> None:
    made = browser.new_context()
    made.set_default_timeout(chromium.HANG_MS)
    page = made.new_page()
    with leading_to(address) as uri:
        page.goto(uri)
        summary(page, "^It compiles")
    assert "token" not in page.url
    made.close()


STORED = "() => localStorage.getItem('token')"


def test_a_link_with_a_wrong_token_takes_nothing_away(browser: Browser, address: str) -> None:
    base, _, token = address.partition("#token=")
    made = browser.new_context()
    made.set_default_timeout(chromium.HANG_MS)
    page = made.new_page()
    page.goto(address)
    summary(page, "^It compiles")
    assert page.evaluate(STORED) == token
    # In the same tab only the fragment changes; another tab begins with the link.
    other = made.new_page()
    for tab in (page, other):
        tab.goto(f"{base}#token=junk")
        tab.wait_for_function("() => !location.hash.includes('junk')")
        expect(tab.locator("#picture svg")).to_be_visible()
        assert tab.evaluate(STORED) == token
        write(tab, BROKEN)
        summary(tab, "^1 error")
    # Without a token that the server accepts, the wrong one is not kept either.
    stranger = browser.new_context().new_page()
    stranger.goto(f"{base}#token=junk")
    summary(stranger, "^It could not begin: open the address that `tltlc serve` shows")
    assert stranger.evaluate(STORED) is None
    stranger.context.close()
    made.close()


def test_a_tab_uses_the_token_that_another_tab_was_given(browser: Browser) -> None:
    with serving() as server:
        made = browser.new_context()
        made.set_default_timeout(chromium.HANG_MS)
        page, other = made.new_page(), made.new_page()
        page.goto(server.address)
        summary(page, "^It compiles")
        server.page._token = b"new"
        other.goto(f"{server.address.partition('#')[0]}#token=new")
        summary(other, "^It compiles")
        write(page, BROKEN)
        summary(page, "^1 error")
        made.close()


def test_a_server_that_was_started_again_is_asked_with_its_new_token(browser: Browser) -> None:
    with serving() as server:
        made = browser.new_context()
        page = made.new_page()
        page.goto(server.address)
        summary(page, "^It compiles")
        # A new server at the same port has another token.
        server.page._token = b"new"
        write(page, BROKEN)
        summary(page, "^No answer: open the address that `tltlc serve` shows")
        page.goto(f"{server.address.partition('#')[0]}#token=new")
        summary(page, "^1 error")
        expect(page.get_by_label("Specification")).to_have_value(BROKEN)
        made.close()


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


def test_a_page_from_elsewhere_gets_nothing(browser: Browser) -> None:
    """A page of another local server, which the browser takes for the same site."""
    with serving() as server, serving() as other:
        made = browser.new_context(bypass_csp=True)
        page = made.new_page()
        page.goto(other.address)
        summary(page, "^It compiles")
        # The browser gives no answer to the page; that of `no-cors` is opaque, and is the server's refusal.
        outcomes = page.evaluate(ATTACK, server.address.partition("#")[0])
        assert outcomes == ["refused", "refused", "refused", "refused"]
        made.close()


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_both_schemes_and_the_choice_between_them(browser: Browser, address: str, scheme: Any) -> None:
    lightness = "() => getComputedStyle(document.body).backgroundColor.match(/\\d+/g).map(Number)[0]"
    for page in opened(browser, address, color_scheme=scheme):
        assert (page.evaluate(lightness) > 128) == (scheme == "light")
        page.get_by_role("button", name="Dark or light").click()
        assert (page.evaluate(lightness) > 128) == (scheme == "dark")
        page.reload()
        expect(page.locator("#picture svg")).to_be_visible()
        assert (page.evaluate(lightness) > 128) == (scheme == "dark")


@pytest.mark.parametrize("width", [360, 1280])
def test_nothing_is_wider_than_the_screen(browser: Browser, address: str, width: int) -> None:
    for page in opened(browser, address, viewport={"width": width, "height": 800}):
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


def test_the_menu_names_the_example_that_is_open(page: Page) -> None:
    menu, area = page.get_by_label("Example"), page.get_by_label("Specification")
    expect(menu).to_have_value("0")
    menu.select_option("1")
    summary(page, "^It compiles")
    expect(menu).to_have_value("1")
    area.press("End")
    page.keyboard.type("!")
    expect(menu).to_have_value("")
    # The same one again takes the edit back.
    menu.select_option("1")
    expect(area).to_have_value(examples()[1]["text"])


def test_the_picture_is_in_words_or_in_symbols(page: Page) -> None:
    before = kept_address(page)
    write(page, MENDED)
    summary(page, "^It compiles$")
    kept_address(page, before)
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
def test_a_trace_of_an_earlier_text_is_said_to_be_one(page: Page, mode: str) -> None:
    write(page, MENDED)
    summary(page, "^It compiles$")
    page.get_by_role("button", name="Show a success").click()
    expect(page.locator("#steps .verdict")).to_have_count(2)
    page.get_by_role("radio", name=mode).check()
    said = page.locator("#strange")
    expect(said).to_be_hidden()
    write(page, MENDED.replace("signal b: bool", "signal door: bool").replace("then b", "then door"))
    expect(said).to_contain_text(f"what they say of b counts for nothing, since the spec has no such {mode}.")
    expect(page.locator("#steps .verdict")).to_have_text(["pending", "pending"])
    page.get_by_role("button", name="Clear").click()
    expect(said).to_be_hidden()


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
        for page in opened(browser, f"http://127.0.0.1:{server.server_address[1]}/", wrong):
            write(page, BROKEN)
            summary(page, "^1 error")
            # A text that takes too long is given up for the next one.
            write(page, SLOW)
            summary(page, "^Compiling…$")
            write(page, MENDED)
            summary(page, "^It compiles$")
            page.get_by_role("button", name="Show a success").click()
            expect(page.locator("#steps .verdict")).to_have_text(["pending", "holding"])
            assert wrong == []
            write(page, SLOW)
            summary(page, "^1 error; what is shown is of an earlier text$")
            expect(page.locator("#messages li")).to_contain_text("was given up")
            write(page, MENDED)
            summary(page, "^It compiles$")
            assert wrong == []
        server.shutdown()
