"""The maps of a case: the level as it is now and, if it looks different, the level of the baseline."""

from __future__ import annotations

from collections.abc import Iterator

from markupsafe import Markup

from tltl_runtime.game.level import Level
from tltl_runtime.regression.report.page.contents import ReportedCase
from tltl_runtime.regression.report.page.markup import element
from tltl_runtime.regression.report.page.stealth.level_map import level_map, map_key
from tltlc.api import replace


def case_maps(case: ReportedCase, level: Level) -> Markup:
    """The map of the ``level``, its key, and an empty legend that the page's script fills in.

    If the level of the baseline looks different, its map is included, too.  The page shows one of them.
    """
    sentences = "\n".join(case.report.reasons)
    legend = element("ul", class_="legend shown", aria_label="Legend of the map")
    return element("div", *_drawn(case, level, sentences), legend)


def _drawn(case: ReportedCase, level: Level, sentences: str) -> Iterator[Markup]:
    now, old = level_map(level, sentences), case.designed
    before = level_map(replace(old, name=level.name, variant=level.variant), sentences) if old is not None else None
    if not case.before or before == now:
        yield element("div", now, map_key(level, sentences), class_="drawn both")
        return
    if old is None or before is None:
        hint = "The baseline's ways are drawn on the level as it is now: what it was then is not known any more."
        yield element(
            "div", now, element("p", hint, class_="hint when-before"), map_key(level, sentences), class_="drawn both"
        )
        return
    maps = (("now", level, "as it is now"), ("before", old, "as it was when the baseline was recorded"))
    for when, shown, words in maps:
        caption = element("p", f"The level {words}: {shown.name} {shown.variant}.", class_="hint")
        yield element("div", level_map(shown, sentences), caption, map_key(shown, sentences), class_=f"drawn {when}")
