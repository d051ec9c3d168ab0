"""The report page in a real browser: it opens and plays episodes, and fits on small screens."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.runtime.regression.page import chromium, samples
from tltl_runtime.regression.explain.explain import Finding
from tltl_runtime.regression.report.page.page import html_report
from tltl_runtime.stealth.level import Box, Solid
from tltlc.core.record import replace

if TYPE_CHECKING:
    from playwright.sync_api import Browser
    from playwright.sync_api import Page as Tab

pytestmark = pytest.mark.skipif(bool(chromium.MISSING), reason=f"not installed: {', '.join(chromium.MISSING)}")

if not chromium.MISSING:
    from playwright.sync_api import expect

CASE = "cover_and_hide-v0"
WIDE = {"viewport": {"width": 1280, "height": 900}}
NARROW = {"viewport": {"width": 360, "height": 740}}


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with chromium.browser() as started:
        yield started


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("page") / "report.html"
    path.write_text(html_report(samples.suite()), encoding="utf-8")
    return path


@pytest.fixture
def tab(browser: Browser, file: Path) -> Iterator[Tab]:
    with chromium.opened(browser, file, **WIDE) as opened:
        yield opened


def current(tab: Tab) -> str | None:
    """The states of the highlighted group in the automaton of the case, in the picture that is shown."""
    groups = tab.locator(f"#{CASE} .in-words .automaton .current")
    assert groups.count() == 1
    return groups.get_attribute("data-states")


def scrub(tab: Tab, step: int) -> None:
    tab.locator(f"#{CASE} .scrub").evaluate(
        "(bar, step) => { bar.value = step; bar.dispatchEvent(new Event('input', { bubbles: true })); }", step
    )


def stop_the_clock(tab: Tab) -> None:
    """Stop the clock of the page; only ``tab.clock.run_for`` advances it."""
    tab.clock.install(time=0)
    tab.clock.pause_at(1000)


def test_the_table_has_a_row_for_each_case(tab: Tab) -> None:
    rows = tab.locator(".verdicts tbody tr")
    names = ["cover_and_hide:v0", "broken:v0", "navigation:v0"]
    assert [row.locator("th").inner_text() for row in rows.all()] == names, "failures come first"
    assert rows.locator(".verdict").all_inner_texts() == ["fail", "fail", "pass"]
    rows.nth(0).locator("th a").click()
    assert tab.url.endswith(f"#{CASE}")
    expect(tab.locator(f"#{CASE} h2")).to_be_in_viewport()


def test_the_filter_hides_cases_that_pass(tab: Tab) -> None:
    tab.get_by_label("only findings").check()
    assert [row.is_visible() for row in tab.locator(".verdicts tbody tr").all()] == [True, True, False]
    assert [section.is_visible() for section in tab.locator("section.case").all()] == [True, True, False]
    tab.get_by_label("only findings").uncheck()
    assert all(section.is_visible() for section in tab.locator("section.case").all())


def test_the_filter_keeps_a_pass_with_a_new_failure(browser: Browser, tmp_path: Path) -> None:
    suite = samples.suite()
    report = replace(suite.cases[0].report, new_failures=(Finding("dies in 1 of 43 episodes", (0,)),))
    path = tmp_path / "new.html"
    path.write_text(html_report(replace(suite, cases=(replace(suite.cases[0], report=report),))), encoding="utf-8")
    with chromium.opened(browser, path, **WIDE) as tab:
        tab.get_by_label("only findings").check()
        assert tab.locator("section.case").is_visible()
        assert tab.locator(".verdicts .verdict.new").is_visible()


def test_one_switch_writes_all_formulas_in_symbols(browser: Browser, file: Path) -> None:
    with chromium.opened(browser, file, f"#{CASE}/0/20", **WIDE) as tab:
        section = tab.locator(f"#{CASE}")
        step = section.locator(".moment").inner_text()
        assert "Reach near(" in (section.locator(".automaton:visible").text_content() or "")
        assert "Reach near(" in section.locator(".state").inner_text()
        section.get_by_label("symbols").check()
        assert "◇near(" in section.locator(".state").inner_text()
        assert "Reach" not in section.locator(".state").inner_text()
        # The switches of the other cases follow, and the episode stays open.
        assert tab.locator("#navigation-v0").get_by_label("symbols").is_checked()
        assert [picture.is_visible() for picture in tab.locator(".in-words .automaton").all()] == [False, False]
        assert [picture.is_visible() for picture in tab.locator(".in-symbols .automaton").all()] == [True, True]
        assert section.locator(".moment").inner_text() == step
        assert section.locator(".in-symbols .automaton .current").count() == 1
        section.get_by_label("words").check()
        assert "Reach near(" in section.locator(".state").inner_text()


@pytest.fixture(name="still")
def _still(browser: Browser, file: Path) -> Iterator[Tab]:
    """The page in a browser that prefers reduced motion."""
    with chromium.opened(browser, file, reduced_motion="reduce", **WIDE) as opened:
        yield opened


def test_a_link_in_an_explanation_opens_its_episode(still: Tab) -> None:
    tab = still
    link = tab.locator(f"#{CASE} .reasons a.episode").first
    _, index, step = (link.get_attribute("href") or "").split("/")
    assert int(step) > 0
    assert not tab.locator(f"#{CASE} .controls").is_visible()
    link.click()
    tab.locator(f"#{CASE} .controls").wait_for(state="visible")
    assert tab.locator(f"#{CASE} .which").input_value() == index
    assert tab.locator(f"#{CASE} .moment").inner_text().startswith(f"step {step} of ")
    episode = samples.suite().cases[1].episodes[int(index)]
    assert current(tab) == str(episode.states[int(step)])
    assert tab.locator(f"#{CASE} .stage").evaluate("stage => stage.getBoundingClientRect().top < innerHeight")


def test_a_link_in_an_explanation_plays_its_episode(tab: Tab) -> None:
    link = tab.locator(f"#{CASE} .reasons a.episode").first
    _, index, step = (link.get_attribute("href") or "").split("/")
    assert link.get_attribute("title") == f"play the end of episode {index}"
    stop_the_clock(tab)
    for _ in range(2):
        link.click()
        expect(tab.locator(f"#{CASE} .play")).to_have_attribute("aria-label", "pause")
        moment = tab.locator(f"#{CASE} .moment")
        tab.clock.run_for(300)
        expect(moment).not_to_contain_text(f"step {step} of ")
    tab.clock.run_for(20_000)
    expect(moment).to_have_text(re.compile(r"step (\d+) of \1,"))
    expect(tab.locator(f"#{CASE} .play")).to_have_attribute("aria-label", "play")


def test_after_a_link_keys_control_the_player_and_the_link_works_again(still: Tab) -> None:
    tab = still
    link = tab.locator(f"#{CASE} .reasons a.episode").first
    step = int((link.get_attribute("href") or "").split("/")[2])
    link.click()
    moment = tab.locator(f"#{CASE} .moment")
    expect(moment).to_contain_text(f"step {step} of ")
    tab.keyboard.press("ArrowRight")
    expect(moment).to_contain_text(f"step {step + 1} of ")
    tab.keyboard.press("ArrowLeft")
    # The address already is the address of the link, so a click does not change it.
    tab.wait_for_function(f"location.hash.endsWith('/{step}')")
    tab.evaluate("scrollTo(0, 0)")
    link.click()
    assert tab.locator(f"#{CASE} .stage").evaluate("stage => stage.getBoundingClientRect().top < innerHeight")
    expect(moment).to_contain_text(f"step {step} of ")


def test_the_slider_shows_the_state_the_values_and_the_map_of_a_step(browser: Browser, file: Path) -> None:
    episode = samples.suite().cases[1].episodes[0]
    states = episode.states.tolist()
    changes = [row for row in range(1, len(states)) if states[row] != states[row - 1]]
    assert changes
    with chromium.opened(browser, file, f"#{CASE}/0/0", **WIDE) as tab:
        assert current(tab) == "0"
        place = tab.locator(f"#{CASE} .map .player-body circle")
        start = place.get_attribute("cx")
        for row in (*changes, len(states) - 1):
            scrub(tab, row)
            assert current(tab) == str(states[row])
            assert tab.locator(f"#{CASE} .state").inner_text().startswith(f"State {states[row]}: ")
            shown = tab.locator(f"#{CASE} meter.progress").evaluate("meter => meter.value")
            assert shown == pytest.approx(float(episode.progress[row]), abs=0.001)
            atoms = tab.locator(f"#{CASE} .atoms td.number").all_inner_texts()
            assert [float(text) for text in atoms] == pytest.approx(episode.atoms[row - 1].tolist(), abs=0.0051)
            level, (x, y, _) = episode.level, episode.snapshots[row].player.position
            centre = [float(place.get_attribute(name) or "nan") for name in ("cx", "cy")]
            assert centre == pytest.approx(
                [100 * (x - level.bounds.low[0]), 100 * (level.bounds.high[1] - y)], abs=0.51
            )
        assert place.get_attribute("cx") != start
        assert tab.locator(f"#{CASE} .map .cone").count() == len(episode.level.enemies)
        expect(tab).to_have_url(re.compile(f"#{CASE}/0/{len(states) - 1}$"))


def test_keys_play_and_step_through_an_episode(browser: Browser, file: Path) -> None:
    with chromium.opened(browser, file, f"#{CASE}/1/5", **WIDE) as tab:
        moment = tab.locator(f"#{CASE} .moment")
        for key, step in (("ArrowRight", 6), ("ArrowRight", 7), ("ArrowLeft", 6), ("Home", 0)):
            tab.keyboard.press(key)
            assert moment.inner_text().startswith(f"step {step} of ")
        stop_the_clock(tab)
        tab.keyboard.press(" ")
        assert tab.locator(f"#{CASE} .play").get_attribute("aria-label") == "pause"
        tab.clock.run_for(800)
        expect(moment).to_have_text(re.compile(r"step ([3-9]|\d\d) of"))
        tab.keyboard.press(" ")
        text = moment.inner_text()
        tab.clock.run_for(400)
        assert moment.inner_text() == text
        tab.keyboard.press("End")
        last = len(samples.suite().cases[1].episodes[1].actions)
        assert moment.inner_text().startswith(f"step {last} of {last}")
        assert "The end: " in tab.locator(f"#{CASE} .state").inner_text()


@pytest.mark.parametrize("address", ["#%", "#%/0/1", f"#{CASE}/0/%"])
def test_an_invalid_address_shows_the_page(browser: Browser, file: Path, address: str) -> None:
    with chromium.opened(browser, file, address, **WIDE) as tab:
        assert not tab.locator(f"#{CASE} .controls").is_visible()
        tab.locator(f"#{CASE} .reasons a.episode").first.click()
        tab.locator(f"#{CASE} .controls").wait_for(state="visible")


@pytest.mark.parametrize(("step", "shown"), [("1.5", 2), ("-3", 0), ("x", 0)])
def test_an_invalid_step_opens_the_nearest_valid_step(browser: Browser, file: Path, step: str, shown: int) -> None:
    with chromium.opened(browser, file, f"#{CASE}/0/{step}", **WIDE) as tab:
        assert tab.locator(f"#{CASE} .moment").inner_text().startswith(f"step {shown} of ")
        assert "NaN" not in tab.locator(f"#{CASE} .player").inner_text()


def test_an_episode_is_selected_and_closed(tab: Tab) -> None:
    which = tab.locator(f"#{CASE} .which")
    which.scroll_into_view_if_needed()
    tab.locator(f"#{CASE} .map .trajectories polyline").first.wait_for(state="attached")
    which.select_option("1")
    tab.locator(f"#{CASE} .map .player-body").wait_for(state="attached")
    assert tab.locator(f"#{CASE} .map .ends path").count() == 0
    which.select_option("")
    tab.locator(f"#{CASE} .map .ends path").first.wait_for(state="attached")
    assert not tab.locator(f"#{CASE} .controls").is_visible()
    assert tab.locator(f"#{CASE} .automaton .current").count() == 0


def test_the_map_shows_now_or_the_baseline(tab: Tab) -> None:
    case = samples.suite().cases[1]
    section = tab.locator(f"#{CASE}")
    section.scroll_into_view_if_needed()
    section.locator(".map .ends path").first.wait_for(state="attached")

    def ends(kind: str) -> int:
        return section.locator(f".map .ends path.{kind}").count()

    failed = sum(not explained.summary.success for explained in case.report.episodes)
    assert (ends("violation") + ends("limit"), ends("success")) == (failed, len(case.report.episodes) - failed)
    assert section.locator(".map .ends a").count() == len(case.episodes)
    assert (
        section.locator(".counts.now").first.is_visible() and not section.locator(".counts.before").first.is_visible()
    )
    section.get_by_label("baseline").check()
    assert ends("success") == sum(explained.summary.success for explained in case.before) > 0
    assert (
        section.locator(".counts.before").first.is_visible() and not section.locator(".counts.now").first.is_visible()
    )
    section.get_by_label("time spent").check()
    assert section.locator(".map .cell.time").count() > 3 and section.locator(".map .trajectory").count() == 0
    section.get_by_label("failed ends").check()
    assert section.locator(".map .cell.failed").count() == 0  # no episode of the baseline failed
    section.get_by_label("now", exact=True).check()
    assert section.locator(".map .cell.failed").count() > 0
    legend = section.locator(".legend.shown")
    expect(legend).to_have_text(re.compile(r"^strongest, now or in the baseline: \d+ failed episodes?$"))


def test_the_legend_lists_the_states_whose_colours_are_drawn(tab: Tab) -> None:
    case = samples.suite().cases[1]
    section = tab.locator(f"#{CASE}")
    section.scroll_into_view_if_needed()
    section.locator(".map .trajectory").first.wait_for(state="attached")
    colours = section.locator(".map .trajectory").evaluate_all(
        "lines => lines.map((line) => line.getAttribute('stroke'))"
    )
    patches = section.locator(".legend.shown rect.trajectory")
    shown = patches.evaluate_all("patches => patches.map((patch) => patch.getAttribute('fill'))")
    assert set(shown) == set(colours) and len(shown) == len(set(shown))
    words = section.locator(".legend.shown").inner_text()
    left_out = {
        explained.arrivals[-1].state for explained in case.report.episodes if explained.summary.end == "violation"
    }
    assert left_out and not any(f"state {state}:" in words for state in left_out)


@pytest.fixture(scope="module")
def changed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of a case whose level has a wall that the level of the baseline lacks."""
    path = tmp_path_factory.mktemp("changed") / "report.html"
    case = samples.suite().cases[1]
    assert case.level is not None
    wall = Solid("new_wall", "wall", Box((9.0, 1.0, 0.0), (10.0, 2.0, 3.0)))
    level = replace(case.level, solids=(*case.level.solids, wall))
    path.write_text(html_report(replace(samples.suite(), cases=(replace(case, level=level),))), encoding="utf-8")
    return path


def test_the_paths_of_the_baseline_are_drawn_on_its_level(browser: Browser, changed: Path) -> None:
    with chromium.opened(browser, changed, f"#{CASE}", **WIDE) as tab:
        now, before = (tab.locator(f"#{CASE} .drawn.{when}") for when in ("now", "before"))
        new_wall = "rect:has(title:text-is('new_wall'))"
        expect(now).to_be_visible()
        expect(before).to_be_hidden()
        assert (now.locator(new_wall).count(), before.locator(new_wall).count()) == (1, 0)
        expect(now).to_contain_text("The level as it is now: cover_and_hide v0.")
        tab.locator(f"#{CASE}").get_by_label("baseline").check()
        expect(now).to_be_hidden()
        expect(before).to_be_visible()
        expect(before).to_contain_text("The level as it was when the baseline was recorded: cover_and_hide v0.")
        assert before.locator(".trajectory").count() > 0
        tab.locator(f"#{CASE}").get_by_label("time spent").check()
        assert before.locator(".cell.time").count() > 0
        # Opening a recorded episode switches to `now`: only current episodes have recordings.
        tab.locator(f"#{CASE} .which").select_option("1")
        expect(now.locator(".player-body")).to_be_attached()
        expect(now).to_be_visible()
        expect(before).to_be_hidden()
        section = tab.locator(f"#{CASE}")
        expect(section.get_by_label("now", exact=True)).to_be_checked()
        expect(section.locator(".counts.now").first).to_be_visible()
        tab.locator(f"#{CASE} .which").select_option("")
        expect(section.get_by_label("now", exact=True)).to_be_checked()
        expect(now.locator(".cell.time").first).to_be_attached()
        expect(now).to_be_visible()
        # A link to an episode switches to `now`, too.
        section.get_by_label("baseline").check()
        expect(before).to_be_visible()
        tab.locator(f"#{CASE} .reasons a.episode").first.click()
        expect(now).to_be_visible()
        expect(section.get_by_label("now", exact=True)).to_be_checked()


def test_the_bars_of_atoms_show_which_hold(browser: Browser, file: Path) -> None:
    case = samples.suite().cases[1]
    assert case.fspa is not None
    with chromium.opened(browser, file, f"#{CASE}/0/0", **WIDE) as tab:
        rows = tab.locator(f"#{CASE} .atoms tbody tr")
        assert not rows.locator("..").locator(".holds, .fails").count(), "the moment of the reset is not judged"
        for step in (1, len(case.episodes[0].actions)):
            scrub(tab, step)
            for row, value in zip(rows.all(), case.episodes[0].atoms[step - 1].tolist(), strict=True):
                bar, track = (row.locator(name).bounding_box() for name in (".length", ".signed"))
                assert bar is not None and track is not None
                middle, half = track["x"] + track["width"] / 2, track["width"] / 2
                assert bar["width"] == pytest.approx(half * min(1.0, abs(value)), abs=0.02 * half)
                left = middle if value > 0 else middle - bar["width"]
                assert bar["x"] == pytest.approx(left, abs=1.0)
                assert ("holds" in (row.get_attribute("class") or "")) == (value > 0)
                assert ("fails" in (row.get_attribute("class") or "")) == (value <= 0)
                assert row.locator(".number").inner_text().startswith("+") == (value > 0)
        alive = rows.nth([atom.name for atom in case.fspa.atoms].index("alive"))
        assert alive.locator(".number").inner_text() == "0.00", "the player is dead"
        assert alive.get_attribute("class") == "fails"


def test_names_in_the_text_of_the_player_are_code(browser: Browser, file: Path) -> None:
    last = len(samples.suite().cases[1].episodes[0].actions)
    with chromium.opened(browser, file, f"#{CASE}/0/{last}", **WIDE) as tab:
        state = tab.locator(f"#{CASE} .state")
        assert "`" not in state.inner_text()
        assert "guard" in state.locator("code").all_inner_texts()


def test_the_legend_of_an_episode_lists_its_bodies(browser: Browser, file: Path) -> None:
    with chromium.opened(browser, file, f"#{CASE}/0/5", **WIDE) as tab:
        legend = " ".join(tab.locator(f"#{CASE} .legend.shown li").all_inner_texts())
        assert all(words in legend for words in ("the player", "an enemy: patrol", "what an enemy sees"))
        assert "a moving obstacle" not in legend, "there is none"


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("address", ["", f"#{CASE}/0/20"])
def test_nothing_scrolls_sideways_on_a_small_screen(browser: Browser, file: Path, scheme: str, address: str) -> None:
    with chromium.opened(browser, file, address, color_scheme=scheme, **NARROW) as tab:
        wide = tab.evaluate("[document.documentElement.scrollWidth, document.documentElement.clientWidth]")
        assert wide == [360, 360]
        for selector in (".verdicts", f"#{CASE} .stage", f"#{CASE} .curves"):
            box = tab.locator(selector).bounding_box()
            assert box is not None and box["x"] >= 0 and box["x"] + box["width"] <= 360


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_texts_have_enough_contrast(browser: Browser, file: Path, scheme: str) -> None:
    with chromium.opened(browser, file, f"#{CASE}/0/20", color_scheme=scheme, **WIDE) as tab:
        for selector in (
            ".verdict.pass",
            ".verdict.fail",
            ".sentence",
            ".facts",
            ".cell-reward",
            ".hint",
            ".verdicts a",
            ".reasons li",
            ".state",
        ):
            colour = tab.locator(selector).first.evaluate("element => getComputedStyle(element).color")
            paper = tab.evaluate("getComputedStyle(document.body).backgroundColor")
            assert contrast(colour, paper) >= 4.5, (selector, colour, paper)


def contrast(one: str, other: str) -> float:
    """The contrast ratio of two colours as WCAG 2.2 defines it; the colours are as browsers write them."""

    def luminance(colour: str) -> float:
        red, green, blue = (int(part) / 255 for part in re.findall(r"\d+", colour)[:3])
        linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in (red, green, blue)]
        return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]

    dark, light = sorted((luminance(one), luminance(other)))
    return (light + 0.05) / (dark + 0.05)


def test_names_are_not_run_as_scripts(browser: Browser, tmp_path: Path) -> None:
    suite = samples.suite()
    case = suite.cases[1]
    assert case.level is not None
    evil = "</script><b onclick='x'>"
    enemies = tuple(replace(enemy, name=evil) for enemy in case.level.enemies)
    level = replace(case.level, name=evil, enemies=enemies)
    report = replace(case.report, name=evil, level=evil, causes=(evil, *case.report.causes))
    path = tmp_path / "evil.html"
    path.write_text(html_report(replace(suite, cases=(replace(case, level=level, report=report),))), encoding="utf-8")
    with chromium.opened(browser, path, "#script-b-onclick-x/0/3", **WIDE) as tab:
        assert tab.locator("b").count() == 0
        assert tab.locator("h2", has_text=evil).count() == 1
        titles = tab.locator(".map .enemy title").all_text_contents()
        assert titles and all(title.startswith(f"{evil}: ") for title in titles)


def test_without_scripts_a_note_is_shown(browser: Browser, file: Path) -> None:
    with chromium.opened(browser, file, java_script_enabled=False, **WIDE) as tab:
        assert tab.locator("noscript p").is_visible()
        assert tab.locator(".verdicts tbody tr").count() == len(samples.suite().cases)
        assert tab.locator(".automaton:visible").count() == 2
