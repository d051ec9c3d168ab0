"""The reasons of a verdict, as sentences, most important first."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from statistics import fmean

from tltl_runtime.game.level import Level
from tltl_runtime.game.level_files import file_kind
from tltl_runtime.game.mentions import Mentions
from tltl_runtime.regression.explain.phrase import Phrase
from tltl_runtime.regression.suite.changed_keys import ChangedKeys, changed_keys
from tltl_runtime.regression.suite.thresholds import Thresholds
from tltl_runtime.regression.verdict.baseline import Identity
from tltl_runtime.regression.verdict.level_texts import Texts
from tltl_runtime.regression.verdict.verdict import Judgement, differing_figures
from tltl_runtime.spec.episode_summary import EpisodeSummary
from tltl_runtime.support.number_text import count_text, interval_text, percent_exactly
from tltlc.api import Fspa


def reasons(
    judgement: Judgement,
    thresholds: Thresholds,
    now: Sequence[EpisodeSummary],
    before: Sequence[EpisodeSummary],
    *,
    are_traces: bool = False,
) -> Iterator[str]:
    """Yield a sentence on the pass rate, then one for each of progress and reward that may have changed.

    ``judgement`` is the verdict on the episodes ``now``. ``before`` are the episodes of the baseline.
    If the episodes ``are_traces`` (recorded traces), they have no seeds, and the means over all of them
    are compared.
    """
    passed, passed_before = (sum(episode.success for episode in episodes) for episodes in (now, before))
    pass_rate, fail_rate = percent_exactly(thresholds.pass_rate), percent_exactly(thresholds.fail_rate)
    noun = "traces" if are_traces else "episodes"
    met = f"met in {_count(passed, now, before, noun)}, before in {_count(passed_before, before, now)}"
    if judgement.verdict == "fail":
        yield f"{met}: certainly in less than {fail_rate}"
    elif judgement.rate_interval[0] >= thresholds.pass_rate:
        yield f"{met}: certainly in {pass_rate} or more"
    elif judgement.certain and judgement.rate_interval[1] < thresholds.pass_rate:
        yield f"{met}: certainly in {fail_rate} to {pass_rate}"
    else:
        yield f"{met}: certainly in {interval_text(judgement.rate_interval)}, but {pass_rate} or more is required"
    for change in judgement.changes:
        yield _change_text(change.figure, change.now, change.before)
    if judgement.verdict == "review" and not judgement.certain:
        certain = {change.figure for change in judgement.changes}
        for figure in (
            name for name in differing_figures(now, before, thresholds, paired=not are_traces) if name not in certain
        ):
            text = _uncertain_change_text(figure, now, before, paired=not are_traces)
            yield f"{text}; the difference is {getattr(thresholds, figure):g} or more, but not certain"


def _count(count: int, episodes: Sequence[EpisodeSummary], others: Sequence[EpisodeSummary], noun: str = "") -> str:
    """Return a count of ``episodes`` as a text, to be compared with a count of ``others``."""
    return count_text(count, len(episodes), noun, is_compared=len(episodes) != len(others))


def _change_text(figure: str, now: float, before: float) -> str:
    """Say how a mean has changed: ``progress is lower, 0.62 on average; before: 0.97``."""
    direction = "lower" if now < before else "higher"
    return f"{figure} is {direction}, {now:.2f} on average; before: {before:.2f}"


def _uncertain_change_text(
    figure: str, now: Sequence[EpisodeSummary], before: Sequence[EpisodeSummary], *, paired: bool
) -> str:
    """Say how the mean of a figure, such as ``progress``, has changed.

    If the episodes ``now`` and ``before`` are ``paired``, the means are over the seeds that both have,
    otherwise over all episodes. Reports also show the mean over all episodes of the baseline. If
    that mean looks different, the sentence mentions it, too.
    """
    count = min(len(now), len(before)) if paired else None
    new, old, overall = (
        fmean(getattr(episode, figure) for episode in episodes) for episodes in (now[:count], before[:count], before)
    )
    if f"{old:.2f}" == f"{overall:.2f}":
        return _change_text(figure, new, old)
    direction = "lower" if new < old else "higher"
    compared = f"before, in the same {count} episodes: {old:.2f} (in all {len(before)}: {overall:.2f})"
    return f"{figure} is {direction}, {new:.2f} on average; {compared}"


def obstacles(level: Level, fspa: Fspa) -> Iterator[Phrase]:
    """Yield a sentence for each entity of the spec that no player can reach in the level.

    If several entities cannot be reached for the same reason, only the first gets a sentence.
    """
    entities = level.game.unreachable_entities(level, fspa)
    first_entities = {entity.diagnostic.help: entity for entity in reversed(entities)}
    for entity in first_entities.values():
        text = f"{entity.diagnostic.title}: {entity.diagnostic.help}"
        yield Phrase(text, Mentions((entity.name, *entity.obstacles)))


def edits(
    now: Identity, before: Identity, descriptions: Sequence[str], texts: Texts = (), texts_before: Texts = ()
) -> Iterator[Phrase]:
    """Yield sentences on how a case differs from its baseline: in files, overlays and versions.

    An overlay is a file that changes a level. ``now`` and ``before`` identify what was played now
    and for the baseline. ``descriptions`` are the designer's descriptions of the overlays; each is
    yielded unchanged. ``texts`` and ``texts_before`` have the known texts of the level's files. If
    both texts of a changed file are known, its sentence names the changed keys.
    """
    old, new = dict(before.files), dict(now.files)
    changed_names = [name for name in dict.fromkeys((*new, *old)) if old.get(name) != new.get(name)]
    # If the variants differ, an overlay that only one of them uses has not changed since the baseline.
    variant_overlays: set[str] = set()
    if now.variant != before.variant:
        variant_overlays = {name for name in changed_names if file_kind(name) == "overlay"} - (old.keys() & new.keys())
    if own_changes := [name for name in changed_names if name not in variant_overlays]:
        keys = [_changed_keys(dict(texts_before).get(name), dict(texts).get(name)) for name in own_changes]
        files = (f"{name} ({its.text})" if its.text else name for name, its in zip(own_changes, keys, strict=True))
        mentions = Mentions(tuple(part for its in keys for part in its.parts))
        yield Phrase(f"changed since the baseline: {', '.join(files)}", mentions)
    if variant_overlays:
        overlays = ", ".join(name for name in changed_names if name in variant_overlays)
        yield Phrase(f"differs from `{before.variant}` by {overlays}")
    yield from map(Phrase, descriptions)
    for name, version in before.versions.items():
        if (version_now := now.versions.get(name)) != version:
            this_run = f"with {version_now}" if version_now else "without it"
            yield Phrase(f"the baseline was recorded with {name} {version}, this run {this_run}")


def _changed_keys(before: str | None, now: str | None) -> ChangedKeys:
    """Return the changed keys of a file; their description is empty if one of the texts is unknown."""
    return ChangedKeys("") if before is None or now is None else changed_keys(before, now)
