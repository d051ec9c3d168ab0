"""The reasons of a verdict, as sentences, most important first."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from statistics import fmean
from typing import Any

from tltl_runtime.game.level import Level
from tltl_runtime.game.level_files import file_kind
from tltl_runtime.game.level_name import is_scene
from tltl_runtime.game.mentions import Mentions
from tltl_runtime.regression.explain.phrase import Phrase
from tltl_runtime.regression.suite.changed_keys import LAYOUT, ChangedKeys, changed_keys
from tltl_runtime.regression.suite.changed_lines import changed_lines
from tltl_runtime.regression.suite.thresholds import Thresholds
from tltl_runtime.regression.verdict.baseline import Identity
from tltl_runtime.regression.verdict.level_texts import Texts
from tltl_runtime.regression.verdict.verdict import Judgement, differing_figures
from tltl_runtime.spec.episode_summary import EpisodeSummary
from tltl_runtime.support.number_text import count_text, interval_texts, mean_text, percent_exactly
from tltlc.api import Fspa


def reasons(
    judgement: Judgement,
    thresholds: Thresholds,
    now: Sequence[EpisodeSummary],
    before: Sequence[EpisodeSummary],
    *,
    are_traces: bool = False,
    reference: str = "",
) -> Iterator[str]:
    """Yield a sentence on the pass rate, then one for each of progress and reward that may have changed.

    ``judgement`` is the verdict on the episodes ``now``. ``before`` are the episodes of the baseline.
    If the episodes ``are_traces`` (recorded traces), they have no seeds, and the means over all of them
    are compared. ``reference`` is the variant that the baseline played; empty if it is the variant that
    is played now.
    """
    passed, passed_before = (sum(episode.success for episode in episodes) for episodes in (now, before))
    pass_rate, fail_rate = percent_exactly(thresholds.pass_rate), percent_exactly(thresholds.fail_rate)
    noun = "traces" if are_traces else "episodes"
    earlier = f"`{reference}` before" if reference else "before"
    met = f"met in {_count(passed, now, before, noun)}, {earlier} in {_count(passed_before, before, now)}"
    if judgement.verdict == "fail":
        yield f"{met}: certainly in less than {fail_rate}"
    elif judgement.rate_interval[0] >= thresholds.pass_rate:
        yield f"{met}: certainly in {pass_rate} or more"
    elif judgement.certain and judgement.rate_interval[1] < thresholds.pass_rate:
        yield f"{met}: certainly in {fail_rate} to {pass_rate}"
    else:
        low, high = interval_texts(judgement.rate_interval)
        possible = f"with so few {noun}, the true rate may be as low as {low}"
        if passed < thresholds.pass_rate * len(now):
            possible = f"the true rate may be {low} to {high}"
        yield f"{met}: {possible}, and {pass_rate} or more is required"
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
    """Say how a mean has changed: ``progress is lower, 0.620 on average; before: 0.970``."""
    direction = "lower" if now < before else "higher"
    return f"{figure} is {direction}, {mean_text(now)} on average; before: {mean_text(before)}"


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
    if mean_text(old) == mean_text(overall):
        return _change_text(figure, new, old)
    direction = "lower" if new < old else "higher"
    compared = f"before, in the same {count} episodes: {mean_text(old)} (in all {len(before)}: {mean_text(overall)})"
    return f"{figure} is {direction}, {mean_text(new)} on average; {compared}"


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
    """Yield sentences on how a case differs from its baseline, in files and overlays.

    An overlay is a file that changes a level. ``now`` and ``before`` identify what was played now
    and for the baseline. ``descriptions`` say what the variant changes; each is
    yielded unchanged. ``texts`` and ``texts_before`` have the known texts of the level's files. If
    both texts of a changed file are known, its sentence names the changed keys or lines. A game file
    whose changes are about other scenes or variants is left out.
    """
    old, new = dict(before.files), dict(now.files)
    changed_names = [name for name in dict.fromkeys((*new, *old)) if old.get(name) != new.get(name)]
    # If the variants differ, a file that only one of them uses has not changed since the baseline.
    variant_files: set[str] = set()
    if now.variant != before.variant:
        shared = old.keys() & new.keys()
        variant_files = {name for name in changed_names if _is_of_variants(name, now)} - shared
    own_changes = {
        name: _changes(name, dict(texts_before).get(name), dict(texts).get(name), now)
        for name in changed_names
        if name not in variant_files
    }
    if named := {name: its for name, its in own_changes.items() if its is not None}:
        files = (f"{name} ({its.text})" if its.text else name for name, its in named.items())
        mentions = Mentions(tuple(part for its in named.values() for part in its.parts))
        yield Phrase(f"changed since the baseline: {', '.join(files)}", mentions)
    # The description of a game's variant names its files.
    if variant_files and not _is_game(now):
        listed = ", ".join(name for name in changed_names if name in variant_files)
        yield Phrase(f"differs from `{before.variant}` by {listed}")
    yield from map(Phrase, descriptions)


def version_changes(now: Identity, before: Identity) -> Iterator[str]:
    """Yield a sentence for each software whose version is not that of the baseline."""
    for name, version in before.versions.items():
        if (version_now := now.versions.get(name)) != version:
            this_run = f"with {version_now}" if version_now else "without it"
            yield f"the baseline was recorded with {name} {version}, this run {this_run}"


def is_unchanged(now: Identity, before: Identity) -> bool:
    """Whether a case is played as its baseline was: with equal files, spec, policy, seed and versions."""
    return now == before


def _is_of_variants(name: str, now: Identity) -> bool:
    """Whether a file may belong to some variants alone: an overlay, or a file that a scene depends on."""
    return file_kind(name) == "overlay" or _is_game(now)


def _is_game(now: Identity) -> bool:
    """Whether the level is a scene of a game file, which is then the first of its files."""
    return bool(now.files) and is_scene(now.files[0][0])


def _changes(name: str, before: str | None, now: str | None, played: Identity) -> ChangedKeys | None:
    """Return the changes of a file; their description is empty if one of the texts is unknown.

    None if the file is a game file, and nothing in it has changed that the scene depends on.
    """
    if before is None or now is None:
        return ChangedKeys("")
    if is_scene(name):
        changes = changed_keys(before, now, lambda document: _own_part(document, played))
        return None if changes.text == LAYOUT else changes
    return changed_keys(before, now) if name.endswith(".toml") else ChangedKeys(changed_lines(before, now))


def _own_part(document: Mapping[str, Any], played: Identity) -> Mapping[str, Any]:
    """Return the part of a game file that a scene depends on, without other scenes and other variants."""
    tables = document.get("scene")
    scenes = [table for table in tables if isinstance(table, dict)] if isinstance(tables, list) else []
    own = [scene for scene in scenes if scene.get("name") == played.level]
    return {**document, "scene": [{**scene, "variants": _own_variant(scene, played)} for scene in own]}


def _own_variant(scene: Mapping[str, Any], played: Identity) -> Mapping[str, Any]:
    variants = scene.get("variants")
    return {played.variant: variants.get(played.variant)} if isinstance(variants, dict) else {}
