"""The links from a sentence of an explanation to the recorded ones of the episodes that it speaks of."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tltl_runtime.regression.explain.explain import Finding
from tltl_runtime.regression.report.page.markup import Markup, element
from tltl_runtime.regression.suite.slugs import episode_link
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.world.player import DECISION

_BEFORE_END: Final = round(4.0 / DECISION)
"""Decisions before its end at which a failed episode is opened: what led to it is still to come."""


def episode_links(finding: Finding, episodes: Mapping[int, Episode], slug: str) -> Markup | None:
    """Links that play the ``episodes`` of a finding, those that failed from shortly before their end; None for none."""
    there = [index for index in finding.episodes if index in episodes]
    if not there:
        return None
    links = []
    for index in there:
        episode = episodes[index]
        step = 0 if episode.success else max(0, len(episode.actions) - _BEFORE_END)
        words = f"play {'the end of ' * (step > 0)}episode {index}"
        address = episode_link(slug, index, step)
        links += [" ", element("a", str(index), class_="episode", href=address, title=words, aria_label=words)]
    is_end = not all(episodes[index].success for index in there)
    what = f"play {'the end of ' * is_end}episode{'s' * (len(there) > 1)}"
    if finding.others:
        what = f"those that do not, {what}" if len(there) > 1 else f"one that does not, {what}"
    return element("span", f" {what}:", *links, class_="links")
