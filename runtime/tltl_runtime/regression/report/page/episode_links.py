"""Links from a finding (a sentence on what a policy does differently) to its examples on the page."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np
from markupsafe import Markup

from tltl_runtime.game.episode import RecordedEpisode
from tltl_runtime.regression.explain.explain import Finding
from tltl_runtime.regression.report.page.render import render
from tltl_runtime.regression.report.page.trace_charts import anchor
from tltl_runtime.regression.report.trace_curves import TraceCurves
from tltl_runtime.regression.suite.slugs import episode_link
from tltlc.api import record

_BEFORE_END_S: Final = 4.0
"""A link opens a failed episode this many seconds before its end, to show what led to it."""


@record
class _Link:
    """A link to an example on the page: a recorded episode, or the picture of a trace.

    ``text`` is the index of the episode or the name of the trace. ``description`` says what the link
    does, for example ``play episode 3``.
    """

    text: str
    address: str
    description: str


def episode_links(finding: Finding, episodes: Mapping[int, RecordedEpisode], slug: str) -> Markup | None:
    """Return links, as HTML, that play the examples of a finding; None if no example was recorded.

    ``episodes`` are the recorded episodes by index. ``slug`` is the case's short name in addresses
    within the page. A failed episode is played from 4 seconds before its end.
    """
    indices = [index for index in finding.episodes if index in episodes]
    if not indices:
        return None
    shows_end = not all(episodes[index].success for index in indices)
    is_plural = len(indices) > 1
    if finding.others:
        named = "episodes that do not" if is_plural else "an episode that does not"
    else:
        named = "episodes" if is_plural else "episode"
    label = f"play {'the end of ' * shows_end}{named}"
    links = [_link(index, episodes[index], slug) for index in indices]
    return render("episode_links.html", label=label, links=links)


def trace_links(finding: Finding, traces: Mapping[int, TraceCurves], slug: str) -> Markup | None:
    """Return links, as HTML, to the pictures of a finding's examples; None if no example is drawn.

    ``traces`` are the drawn traces or episodes by index. ``slug`` is as in :func:`episode_links`.
    """
    shown = {index: traces[index] for index in finding.episodes if index in traces}
    if not shown:
        return None
    kind = next(iter(shown.values())).kind
    named = f"{'an' if kind == 'episode' else 'a'} {kind} that does not" if finding.others else kind
    total = len(finding.episodes)
    if total > 1:
        counted = f"{len(shown)} of {total} {kind}s" if len(shown) < total else f"{kind}s"
        named = f"{counted} that do not" if finding.others else counted
    links = [
        _Link(Path(curves.name).name, f"#{anchor(slug, index)}", f"show the {kind} {curves.name}")
        for index, curves in shown.items()
    ]
    return render("episode_links.html", label=f"show {named}", links=links)


def _link(index: int, episode: RecordedEpisode, slug: str) -> _Link:
    step = 0 if episode.success else _nearest_step(episode, float(episode.times[-1]) - _BEFORE_END_S)
    return _Link(str(index), episode_link(slug, index, step), f"play {'the end of ' * (step > 0)}episode {index}")


def _nearest_step(episode: RecordedEpisode, time: float) -> int:
    """Return the number of the step, from 0 at the reset, whose time is nearest to ``time``, in seconds."""
    return int(np.abs(episode.times - time).argmin())
