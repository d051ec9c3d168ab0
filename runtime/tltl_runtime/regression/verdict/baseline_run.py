"""Record the baseline of a suite: its policies play episodes on the current levels.

A baseline consists of references. A reference has the recorded episodes of one policy on one level.
"""

from __future__ import annotations

import os
from collections.abc import Generator, Sequence
from itertools import count
from pathlib import Path
from typing import Final

from tltl_runtime.evaluation.evaluate import Pool
from tltl_runtime.evaluation.player import LostEpisode
from tltl_runtime.game.level_name import Variant
from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode, summaries_of
from tltl_runtime.regression.suite.result_cache import cache_text, inputs_hash, read_cache
from tltl_runtime.regression.suite.suite import LEAST_EPISODES, Case, Suite
from tltl_runtime.regression.verdict.baseline import Reference, write_baseline
from tltl_runtime.regression.verdict.confidence import rate_interval
from tltl_runtime.regression.verdict.level_texts import level_texts
from tltl_runtime.regression.verdict.play import OnEpisode, PreparedCase, play_episodes, prepare_case
from tltl_runtime.regression.verdict.verdict import CaseVerdict, judge
from tltl_runtime.support.source_hash import sources_hash
from tltl_runtime.wire.errors import WireError
from tltl_runtime.wire.lost_episodes import LostEpisodes
from tltlc.api import TltlError, fileio, record, replace

_TRIES: Final = 3
"""So often an episode is played that is lost with its game."""

_ADVICE: Final = "name another place with --output"


@record
class RecordedReference:
    """The recorded episodes of a policy on a level, and the cases that are compared with them.

    ``outdated`` is a message if the level's spec has changed since the policy was trained, so that
    none of the cases can pass. Otherwise it is None. ``lost`` are the episodes that were lost with their
    games, and played again; None if there are none.
    """

    reference: Reference
    cases: tuple[Case, ...]
    outdated: str | None = None
    lost: LostEpisodes | None = None


def record_baseline(
    suite: Suite, pool: Pool, on_episode: OnEpisode, finished: tuple[Reference, ...] = ()
) -> Generator[RecordedReference]:
    """Play and yield the references that the cases of a suite are compared with, one after the other.

    Cases share a reference if they have the same policy, level and spec, and are compared with the
    same variant of the level. The reference then has as many episodes as the case that asks for
    most. ``on_episode`` is called after each episode.

    ``finished`` are references from earlier recordings. A reference is taken from there, instead
    of being played, if its ``played`` and its number of episodes are the same.

    Raises:
        TltlError: a case cannot be set up (raised before anything is played); TLT0905, a level was
            edited meanwhile; errors from playing.
    """
    yield from _record_references(_groups(suite), pool, on_episode, finished)


def record_and_write_baseline(
    suite: Suite,
    path: Path,
    pool: Pool,
    on_episode: OnEpisode,
    older: tuple[Reference, ...] = (),
    *,
    fresh: bool = False,
) -> Generator[RecordedReference]:
    """Record the baseline of a suite with :func:`record_baseline`, then write it to ``path``.

    Until the baseline is complete, the file at :func:`partial_path` stores the finished references,
    so that a stopped recording can continue. The references of the ``older`` baseline are reused
    if nothing that they depend on has changed, including the source code of tltlc. With ``fresh``,
    only references from a stopped ``fresh`` recording are reused.

    Raises:
        TltlError: TLT0005, a file cannot be written; errors of :func:`record_baseline`.
    """
    groups, partial, references = _groups(suite), partial_path(path), list[Reference]()
    inputs = inputs_hash([fresh])
    finished = (partial and read_cache(tuple[Reference, ...], partial, inputs)) or ()
    # Check that the file can be written before minutes of play.
    _write_partial(partial, inputs, finished)
    reusable = () if fresh else tuple(reference for reference in older if reference.sources == sources_hash())
    for recorded in _record_references(groups, pool, on_episode, (*finished, *reusable)):
        references.append(recorded.reference)
        # References of the older baseline need no copy: they are in the file of that baseline.
        new = tuple(reference for reference in references if reference not in reusable)
        _write_partial(partial, inputs, (*new, *(earlier for earlier in finished if earlier not in new)))
        yield recorded
    write_baseline(path, tuple(references))
    if partial:
        fileio.remove_file(partial, _ADVICE)


def partial_path(path: Path) -> Path | None:
    """Return the file that stores finished references until the baseline at ``path`` is complete.

    Its name is that of the baseline with ``.partial`` appended; symbolic links in ``path`` are
    resolved. None if ``path`` exists and is not a regular file, for example a device or a pipe.
    """
    if fileio.exists(path) and not fileio.is_file(path):
        return None
    return Path(f"{os.path.realpath(path)}.partial")


def verdict_if_unchanged(suite: Suite, case: Case, reference: Reference) -> CaseVerdict:
    """Return the verdict on a case if its policy played exactly the episodes of the baseline again.

    ``reference`` has these episodes. A verdict other than ``pass`` means that the case does not pass
    even if nothing changes.
    """
    summaries, error = summaries_of(reference.episodes), suite.error / len(suite.cases)
    for played in range(LEAST_EPISODES, case.episodes + 1):
        if judgement := judge(summaries[:played], summaries, case.episodes, case.thresholds, error):
            return judgement.verdict
    raise AssertionError("the last episode settles every verdict")


def episodes_for_certainty(pass_rate: float, error: float) -> int:
    """Return after how many episodes, all of them successful, the pass rate is certainly high enough.

    High enough means at least ``pass_rate``. Certain means that the probability of a mistake is at
    most ``error``. The number is at least 25, the least for any verdict.
    """
    return next(successes for successes in count(LEAST_EPISODES) if rate_interval(successes, 0, error)[0] >= pass_rate)


def _groups(suite: Suite) -> list[list[PreparedCase]]:
    """Set up the played cases of a suite to record their baseline; group those that share a reference."""
    groups: list[list[PreparedCase]] = []
    for case in suite.played_cases:
        prepared = _prepare(case, suite.seed)
        matches = [group for group in groups if group[0].played == prepared.played]
        if matches:
            matches[0].append(prepared)
        else:
            groups.append([prepared])
    return groups


def _prepare(case: Case, seed: int) -> PreparedCase:
    """Set up a case to play the variant that it is compared with.

    Raises:
        TltlError: the errors of :func:`prepare_case`, with the name of the case in front.
    """
    try:
        return prepare_case(case, seed, Variant(case.reference))
    except TltlError as error:
        diagnostics = [
            replace(diagnostic, title=f"case `{case.name}`: {diagnostic.title}") for diagnostic in error.diagnostics
        ]
        raise TltlError(diagnostics) from None


def _record_references(
    groups: Sequence[Sequence[PreparedCase]], pool: Pool, on_episode: OnEpisode, finished: tuple[Reference, ...]
) -> Generator[RecordedReference]:
    for group in groups:
        longest = max(group, key=lambda prepared: prepared.case.episodes)
        matches = [
            reference
            for reference in finished
            if reference.played == longest.played and len(reference.episodes) == longest.case.episodes
        ]
        reference, lost = (matches[0], None) if matches else _play_reference(longest, pool, on_episode)
        outdated = next((prepared.outdated for prepared in group if prepared.outdated), None)
        yield RecordedReference(reference, tuple(prepared.case for prepared in group), outdated, lost)


def _play_reference(prepared: PreparedCase, pool: Pool, on_episode: OnEpisode) -> tuple[Reference, LostEpisodes | None]:
    """Play the episodes of a reference; return it, and the episodes that were lost with their games.

    A lost episode is played again, because a baseline needs all episodes.

    Raises:
        WireError: an episode was lost in each of several tries, or too many were lost.
    """
    played: dict[int, ExplainedEpisode] = {}
    lost: list[LostEpisode] = []
    # Read the texts first: an edit during play raises an error, so these are the texts that are played.
    texts = level_texts(prepared.setup.level, prepared.setup.variant, prepared.played.files)
    for _ in range(_TRIES):
        missing = [index for index in range(prepared.case.episodes) if index not in played]
        for episode in play_episodes(prepared, pool, lost.append, missing) if missing else ():
            played[episode.explained.summary.index] = episode.explained
            on_episode(prepared.case, len(played), episode.explained)
    if len(played) < prepared.case.episodes:
        raise WireError([lost[-1].fault])
    reference = Reference(prepared.played, tuple(played[index] for index in sorted(played)), texts, sources_hash())
    return reference, LostEpisodes(len(lost), lost[0].fault) if lost else None


def _write_partial(path: Path | None, inputs: str, references: tuple[Reference, ...]) -> None:
    if path:
        fileio.write_file(path, cache_text(inputs, references), _ADVICE, over_inputs=True)
