"""The maps of a case: the level now and, if it looked different then, the level of the baseline."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from markupsafe import Markup

from tltl_runtime.game.level import Level
from tltl_runtime.game.level_maps import LevelMaps
from tltl_runtime.regression.report.page.contents import ReportedCase
from tltl_runtime.regression.report.page.mentions import report_mentions
from tltl_runtime.regression.report.page.render import render
from tltlc.api import record, replace


@record
class _DrawnMap:
    """A map of a level for the page, and the key (explanation) to its signs.

    ``when`` says with which episodes the page shows the map: those played ``now``, those played
    ``before`` (the baseline), or ``both``. ``is_of_unknown_baseline`` is true if the page shows this
    map for the baseline only because the level of the baseline is unknown. ``is_one_of_many`` is true
    if some of the recorded episodes were played on other maps, as in a game that generates its maps.
    """

    when: str
    picture: Markup
    key: Markup
    caption: str = ""
    is_of_unknown_baseline: bool = False
    is_one_of_many: bool = False


def case_maps(case: ReportedCase, level: Level, level_maps: LevelMaps[Any, Any]) -> Markup:
    """Return HTML with the map of ``level``, the key to its signs, and an empty legend.

    ``level_maps`` draws the maps. The page's script fills in the legend. If the level of the baseline
    looks different, the HTML contains its map, too, and the page shows one of the two.
    """
    maps = tuple(_maps(case, level, level_maps))
    return render("case_maps.html", maps=maps, is_on_empty_plan=case.is_on_empty_plan)


def _maps(case: ReportedCase, level: Level, maps: LevelMaps[Any, Any]) -> Iterator[_DrawnMap]:
    others = not all(maps.is_map_of(level, episode) for episode in case.episodes.values())
    old_level, mentioned = case.baseline_level, report_mentions(maps, level, case.report)
    map_now, key_now = maps.picture(level, mentioned), maps.key(level, mentioned)
    if old_level is None or not case.before:
        yield _DrawnMap("both", map_now, key_now, is_of_unknown_baseline=bool(case.before), is_one_of_many=others)
        return
    mentioned_before = report_mentions(maps, old_level, case.report)
    if maps.picture(replace(old_level, name=level.name, variant=level.variant), mentioned_before) == map_now:
        yield _DrawnMap("both", map_now, key_now, is_one_of_many=others)
        return
    caption = f"The level as it is now: {level.name} {level.variant}."
    yield _DrawnMap("now", map_now, key_now, caption, is_one_of_many=others)
    caption = f"The level as it was when the baseline was recorded: {old_level.name} {old_level.variant}."
    yield _DrawnMap("before", maps.picture(old_level, mentioned_before), maps.key(old_level, mentioned_before), caption)
