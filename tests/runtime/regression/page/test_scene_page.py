"""The page of a game that says where things are, in a real browser."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.runtime.gymnasium_games import vault
from tests.runtime.gymnasium_games.vault_episodes import played
from tests.runtime.regression.page import chromium, samples
from tltl_runtime.gymnasium_games.gymnasium_game import GAME
from tltl_runtime.regression.report.page.contents import ReportedCase, SuiteReport, maps_of
from tltl_runtime.regression.report.page.missing_map import missing_map_text, with_plan
from tltl_runtime.regression.report.page.page import html_report
from tltlc.core.record import replace

if TYPE_CHECKING:
    from playwright.sync_api import Browser
    from playwright.sync_api import Page as Tab

needs_browser = pytest.mark.skipif(bool(chromium.MISSING), reason=f"not installed: {', '.join(chromium.MISSING)}")

if not chromium.MISSING:
    from playwright.sync_api import expect

WIDE = {"viewport": {"width": 1280, "height": 900}}


def case_of(folder: Path, scene: str, *, fixed: bool = True) -> ReportedCase:
    """A case of six episodes, of which some meet the guard; with ``fixed``, the key lies always in the same place."""
    if fixed:
        code = vault.CODE.replace("(int(self.np_random.integers(2, 5)), 4)", "(3, 4)")
        vault.write(folder, vault__py=code)
    else:
        vault.write(
            folder, vault__py=vault.CODE.replace('"shelf": ((0, 5), (4, 6))', '"shelf": ((0, 5), (self.key[0], 6))')
        )
    episodes = [played(folder / "vault.game.toml", seed, scene=scene) for seed in range(6)]
    level = GAME.played_level(episodes[0].level, episodes)
    shown = [replace(episode, level=replace(episode.level, landmarks=level.landmarks)) for episode in episodes]
    case = samples.reported(f"vault:{scene}", "fail", shown, shown[:2])
    return replace(case, level=level, baseline_level=level)


def page(path: Path, *cases: ReportedCase) -> Path:
    report = SuiteReport("vault", 7, 0.05, {}, cases)
    path.write_text(html_report(report), encoding="utf-8")
    return path


@pytest.fixture(name="browser", scope="module")
def _browser() -> Iterator[Browser]:
    with chromium.browser() as started:
        yield started


@pytest.fixture(name="file", scope="module")
def _file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("vault")
    return page(folder / "report.html", case_of(folder, "tiled"), case_of(folder, "plain"))


@pytest.fixture(name="tab")
def _tab(browser: Browser, file: Path) -> Iterator[Tab]:
    with chromium.opened(browser, file, **WIDE) as opened:
        yield opened


@needs_browser
@pytest.mark.parametrize("slug", ["vault-tiled", "vault-plain"])
def test_the_map_shows_the_ways_and_where_episodes_failed(tab: Tab, slug: str) -> None:
    section = tab.locator(f"#{slug}")
    section.scroll_into_view_if_needed()
    expect(section.locator(".map .ends .end")).to_have_count(6)
    assert section.locator(".map .trajectories .trajectory").count() >= 6
    expect(section.locator(".reasons")).to_contain_text("dies in the inner vault by guard_1")
    assert section.locator(".map .mentioned").all_text_contents() == ["inner vault"]
    section.get_by_label("time spent").check()
    assert section.locator(".map .heat .cell").count() > 5
    section.get_by_label("failed ends").check()
    assert section.locator(".map .heat .cell").count() >= 1


@needs_browser
def test_an_episode_plays_with_all_its_entities(browser: Browser, file: Path) -> None:
    with chromium.opened(browser, file, "#vault-plain/0/0", **WIDE) as tab:
        section = tab.locator("#vault-plain")
        assert section.locator(".player meter").count() == 1, "progress alone: the game has no health"
        bodies = section.locator(".map .live .body")
        assert bodies.locator("title").all_text_contents() == ["key", "guard_1", "exit", "the player"]
        assert section.locator(".map .live text").all_text_contents() == ["key", "guard_1", "exit"]
        expect(section.locator(".map .landmark").first).to_be_hidden()
        expect(section.locator(".legend.shown")).to_contain_text("the player, in the colour of the state")
        before = bodies.nth(1).locator("circle").get_attribute("cy")
        section.locator(".controls .on").click()
        assert bodies.nth(1).locator("circle").get_attribute("cy") != before, "the guard walks"
        section.locator(".controls .last").click()
        assert bodies.locator("title").all_text_contents() == ["guard_1", "exit", "the player"], "the key is taken"


@needs_browser
def test_a_game_that_changes_its_map_says_so(browser: Browser, tmp_path: Path) -> None:
    path = page(tmp_path / "report.html", case_of(tmp_path, "plain", fixed=False))
    with chromium.opened(browser, path, **WIDE) as tab:
        expect(tab.locator("#vault-plain .drawn .hint")).to_contain_text("changes its map from episode to episode")


def without_outline(case: ReportedCase) -> ReportedCase:
    """Return the case as it is if the game has no outline."""

    def blank(level: Any) -> Any:
        return replace(level, outline=None)

    episodes = {
        index: replace(episode, level=blank(episode.level))  # type: ignore[type-var]
        for index, episode in case.episodes.items()
    }
    level = blank(case.level)
    return replace(case, level=level, baseline_level=level, episodes=episodes)


@needs_browser
def test_positions_without_an_outline_are_drawn_on_an_empty_plan_with_a_scale(browser: Browser, tmp_path: Path) -> None:
    case = without_outline(case_of(tmp_path, "plain"))
    assert maps_of(case) is None
    path = page(tmp_path / "report.html", with_plan(case))
    with chromium.opened(browser, path, "#vault-plain/0/0", **WIDE) as tab:
        section = tab.locator("#vault-plain")
        assert section.locator(".map .wall").count() == section.locator(".map .region").count() == 0
        assert section.locator(".map .scale-name").all_text_contents() == ["2 m"]
        expect(section.locator(".drawn .hint")).to_have_text(re.compile("positions, but no outline.*tltl_outline"))
        bodies = section.locator(".map .live .body")
        assert bodies.locator("title").all_text_contents() == ["key", "guard_1", "exit", "the player"]
        expect(section.locator("svg.map")).to_be_visible()
        frame = section.locator("svg.map").bounding_box()
        assert frame is not None
        for body in bodies.all():
            box = body.bounding_box()
            assert box is not None and frame["x"] < box["x"] and box["x"] + box["width"] < frame["x"] + frame["width"]
        tab.goto(f"{path.as_uri()}#vault-plain")
        expect(section.locator(".map .ends .end")).to_have_count(6)


def test_a_page_without_a_map_says_why(tmp_path: Path) -> None:
    case = without_outline(case_of(tmp_path, "plain"))
    assert missing_map_text(with_plan(case)) == ""
    unknown = tuple(replace(episode, way=(), place=None) for episode in case.report.episodes)
    blind = replace(case, report=replace(case.report, episodes=unknown))
    assert with_plan(blind) == blind
    text = html_report(SuiteReport("vault", 7, 0.05, {}, (blind,)))
    assert "There is no map: the game does not say where the player is. Add <code>tltl_positions()</code>, or" in text


def test_the_page_has_no_map_unless_the_game_says_where_the_player_is(tmp_path: Path) -> None:
    case = case_of(tmp_path, "plain")
    assert maps_of(case) is GAME.maps
    unknown = tuple(replace(episode, way=()) for episode in case.report.episodes)
    assert maps_of(replace(case, report=replace(case.report, episodes=unknown))) is None
    assert case.level is not None
    assert maps_of(replace(case, level=replace(case.level, outline=None))) is None  # type: ignore[type-var]


def test_a_baseline_without_places_is_left_out(tmp_path: Path) -> None:
    case = case_of(tmp_path, "plain")
    before = tuple(replace(episode, way=(), place=None) for episode in case.before)
    text = html_report(SuiteReport("vault", 7, 0.05, {}, (replace(case, before=before),)))
    assert '"before":{"trajectories":[]' in text
