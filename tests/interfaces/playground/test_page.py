"""The page in a real browser: type and fix specs, and click through traces."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.interfaces.playground.browser_page import (  # noqa: F401
    BROKEN,
    FIXED,
    SIGNALS,
    _address,
    _browser,
    _page,
    current,
    needs_browser,
    open_page,
    summary,
    wait_for_address,
    write,
)
from tests.interfaces.playground.test_server import SLOW
from tests.runtime.regression.page import chromium
from tltlc.interfaces.playground.page_config import examples
from tltlc.interfaces.playground.site import PYODIDE, site_files
from tltlc.io.writing import write_files

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

if not chromium.MISSING:
    from playwright.sync_api import expect

pytestmark = needs_browser


PYODIDE_FOLDER = Path(os.environ.get("PYODIDE", "node_modules/pyodide"))
"""The npm package `pyodide`, if it is installed."""


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
    page.locator("#steps .go").last.click()
    failure = re.compile(r"Violated at step \d+: .+, clause \d: .+\.")
    expect(page.locator("#moment")).to_have_text(failure)
    expect(page.locator("#steps .verdict.violated").last).to_have_attribute("title", failure)
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


TIMED = "signal a: bool\nsignal b: bool\nclock varies\nspec timed { keep a implies eventually within 2 s b }\n"


def test_the_time_between_steps_is_set_if_the_clock_varies(page: Page) -> None:
    write(page, TIMED)
    expect(page.locator("#english h2")).to_have_text("timed")
    time, verdicts = page.get_by_label(re.compile("^time since the last step at")), page.locator("#steps .verdict")
    for _ in range(3):
        page.get_by_role("button", name="Add step").click()
    page.get_by_label("a at step 1").check()
    expect(verdicts).to_have_text(["pending", "pending", "violated"])
    expect(time.nth(1)).to_have_value("2")
    time.nth(1).fill("0.5")
    time.nth(2).fill("1.5")
    expect(verdicts).to_have_text(["pending", "pending", "pending"])
    before = wait_for_address(page)
    time.nth(2).fill("1.75")
    expect(verdicts.last).to_have_text("violated")
    wait_for_address(page, before)
    page.reload()
    expect(verdicts.last).to_have_text("violated")
    expect(time.nth(2)).to_have_value("1.75")
    before = wait_for_address(page)
    page.get_by_role("radio", name="signals").check()
    # The page may draw the table anew until then.
    wait_for_address(page, before)
    page.get_by_label("b at step 2").check()
    expect(verdicts.last).to_have_text("holding")
    time.nth(1).fill("-1")
    expect(page.locator("#steps .refused")).to_have_count(1)
    expect(page.locator("#moment")).to_contain_text("its time since the sample before is -1, not a number of seconds")
    # With a fixed clock there is no such time.
    write(page, TIMED.replace("varies", "1 Hz"))
    expect(time).to_have_count(0)
    expect(page.locator("#steps .refused")).to_have_count(0)
    write(page, TIMED)
    expect(time.nth(1)).to_have_value("-1")


def test_a_trace_gets_times_if_its_text_is_changed_to_a_clock_that_varies(page: Page) -> None:
    write(page, TIMED.replace("varies", "1 Hz"))
    expect(page.locator("#english h2")).to_have_text("timed")
    page.get_by_role("button", name="Show a failure").click()
    expect(page.locator("#steps .verdict").last).to_have_text("violated")
    times = page.get_by_label(re.compile("^time since the last step"))
    expect(times).to_have_count(0)
    write(page, TIMED)
    expect(times.first).to_have_value("2")
    expect(page.locator("#steps .verdict").last).to_have_text("violated")


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
