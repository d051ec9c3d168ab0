"""The maps of a case: of the level as it is now, and of that of its baseline where this looks otherwise."""

from __future__ import annotations

from collections.abc import Iterator

from tltl_runtime.regression.report.page.contents import ReportedCase
from tltl_runtime.regression.report.page.level_map import level_map, map_key
from tltl_runtime.regression.report.page.markup import Markup, element
from tltl_runtime.stealth.level import Level
from tltlc.core.record import replace


def case_maps(case: ReportedCase, level: Level) -> Markup:
    """The map of the ``level``, its key, and a legend that the page fills in: it depends on what is shown.

    Where the baseline's ways were on a level that looks otherwise, its map is there, too, for the page to show instead.
    """
    said = "\n".join(case.report.reasons)
    legend = element("ul", class_="legend shown", aria_label="Legend of the map")
    return element("div", *_drawn(case, level, said), legend)


def _drawn(case: ReportedCase, level: Level, said: str) -> Iterator[Markup]:
    now, old = level_map(level, said), case.designed
    before = level_map(replace(old, name=level.name, variant=level.variant), said) if old is not None else None
    if not case.before or before == now:
        yield element("div", now, map_key(level, said), class_="drawn both")
        return
    if old is None or before is None:
        told = "The baseline's ways are drawn on the level as it is now: what it was then is not known any more."
        yield element(
            "div", now, element("p", told, class_="hint when-before"), map_key(level, said), class_="drawn both"
        )
        return
    maps = (("now", level, "as it is now"), ("before", old, "as it was when the baseline was recorded"))
    for when, each, words in maps:
        caption = element("p", f"The level {words}: {each.name} {each.variant}.", class_="hint")
        yield element("div", level_map(each, said), caption, map_key(each, said), class_=f"drawn {when}")
