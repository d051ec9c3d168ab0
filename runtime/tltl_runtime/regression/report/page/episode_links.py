"""Links from a finding to its recorded episodes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from markupsafe import Markup

from tltl_runtime.game.episode import RecordedEpisode
from tltl_runtime.game.registry import registered_game
from tltl_runtime.regression.explain.explain import Finding
from tltl_runtime.regression.report.page.markup import element
from tltl_runtime.regression.suite.slugs import episode_link

_BEFORE_END_S: Final = 4.0
"""A failed episode is opened this many seconds before its end, to show what led to the failure."""


def episode_links(finding: Finding, episodes: Mapping[int, RecordedEpisode], slug: str) -> Markup | None:
    """Links that play the recorded ``episodes`` of a finding; None if there are none.

    Failed episodes start shortly before their end.
    """
    indices = [index for index in finding.episodes if index in episodes]
    if not indices:
        return None
    before_end = round(_BEFORE_END_S / registered_game().clock_s)
    links = []
    for index in indices:
        episode = episodes[index]
        step = 0 if episode.success else max(0, len(episode.actions) - before_end)
        words = f"play {'the end of ' * (step > 0)}episode {index}"
        address = episode_link(slug, index, step)
        links += [" ", element("a", str(index), class_="episode", href=address, title=words, aria_label=words)]
    is_end = not all(episodes[index].success for index in indices)
    label = f"play {'the end of ' * is_end}episode{'s' * (len(indices) > 1)}"
    if finding.others:
        label = f"those that do not, {label}" if len(indices) > 1 else f"one that does not, {label}"
    return element("span", f" {label}:", *links, class_="links")
