"""The baseline of a suite is recorded: its policies play all episodes, on the levels as they are now."""

from __future__ import annotations

import os
from collections.abc import Generator, Sequence
from itertools import count
from pathlib import Path
from typing import Final

from tltl_runtime.evaluation.evaluate import Pool
from tltl_runtime.regression.explain.account import Account
from tltl_runtime.regression.suite.level_texts import level_texts
from tltl_runtime.regression.suite.result_cache import inputs_hash, kept_text, read_kept
from tltl_runtime.regression.suite.suite import LEAST_EPISODES, Case, Suite
from tltl_runtime.regression.verdict.baseline import Reference, write_baseline
from tltl_runtime.regression.verdict.confidence import rate_interval
from tltl_runtime.regression.verdict.play import Ready, Told, episodes, ready
from tltl_runtime.regression.verdict.verdict import Verdict, judge
from tltl_runtime.support.source_hash import sources_hash
from tltlc.core.record import record, replace
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.io.files import exists, is_file
from tltlc.io.writing import remove_file, write_file

_ADVICE: Final = "name another place with --output"


@record
class Compared:
    """What was recorded, the cases that are compared with it, and why none of them passes whose spec is another now."""

    reference: Reference
    cases: tuple[Case, ...]
    outdated: str | None = None


def record_baseline(suite: Suite, pool: Pool, told: Told, kept: tuple[Reference, ...] = ()) -> Generator[Compared]:
    """Play all episodes of each level, variant, spec and policy that the suite's cases are compared with.

    Of cases that are compared with the same, that counts which asks for most episodes.  What is ``kept`` of an earlier
    recording is not played again where nothing has changed since.

    Raises:
        TltlError: something does not fit, before anything is played; TLT0905, a level was edited since; what playing
            raises.
    """
    yield from _recorded(_groups(suite), pool, told, kept)


def write_recorded(
    suite: Suite, path: Path, pool: Pool, told: Told, older: tuple[Reference, ...] = (), *, fresh: bool = False
) -> Generator[Compared]:
    """Record the baseline of a suite, as :func:`record_baseline` does, and write it to ``path`` when all is over.

    Until then what is over is kept at :func:`kept_at`, so that a recording that was stopped goes on.  What an ``older``
    baseline has is not played again where nothing has changed since, nor the code that plays, unless all is to be
    ``fresh``, which goes on with what such a recording has left alone.

    Raises:
        TltlError: TLT0005, a file cannot be written; what :func:`record_baseline` raises.
    """
    groups, partial, found = _groups(suite), kept_at(path), list[Reference]()
    inputs = inputs_hash([fresh])
    kept = (partial and read_kept(tuple[Reference, ...], partial, inputs)) or ()
    # The place may refuse: better to know before minutes of play.
    _keep(partial, inputs, kept)
    known = () if fresh else tuple(each for each in older if each.sources == sources_hash())
    for each in _recorded(groups, pool, told, (*kept, *known)):
        found.append(each.reference)
        # What is older stays where it is.
        new = tuple(reference for reference in found if reference not in known)
        _keep(partial, inputs, (*new, *(other for other in kept if other not in new)))
        yield each
    write_baseline(path, tuple(found))
    if partial:
        remove_file(partial, _ADVICE)


def kept_at(path: Path) -> Path | None:
    """Where a recording keeps what is over: beside the file that ``path`` leads to, None where that is no file but a
    device or a pipe.
    """
    if exists(path) and not is_file(path):
        return None
    return Path(f"{os.path.realpath(path)}.partial")


def verdict_as_it_is(suite: Suite, case: Case, reference: Reference) -> Verdict:
    """The verdict of a case whose episodes are those of its reference, one by one."""
    accounts, error = reference.accounts, suite.error / len(suite.cases)
    for played in range(LEAST_EPISODES, case.episodes + 1):
        if found := judge(accounts[:played], accounts, case.episodes, case.thresholds, error):
            return found.verdict
    raise AssertionError("the last episode settles every verdict")


def enough_episodes(pass_rate: float, error: float) -> int:
    """Episodes in which a spec has to be met, if it always is, for its pass rate to be certain at that error."""
    return next(met for met in count(LEAST_EPISODES) if rate_interval(met, 0, error)[0] >= pass_rate)


def _groups(suite: Suite) -> list[list[Ready]]:
    """Cases that are compared with the same, made ready to play that."""
    groups: list[list[Ready]] = []
    for case in suite.cases:
        one = _ready(case, suite.seed)
        same = [group for group in groups if group[0].played == one.played]
        if same:
            same[0].append(one)
        else:
            groups.append([one])
    return groups


def _ready(case: Case, seed: int) -> Ready:
    """A case's reference made ready to play; what does not fit is said with the case's name."""
    try:
        return ready(case, seed, case.reference)
    except TltlError as error:
        named = [replace(each, title=f"case `{case.name}`: {each.title}") for each in error.diagnostics]
        raise TltlError(named) from None


def _recorded(
    groups: Sequence[Sequence[Ready]], pool: Pool, told: Told, kept: tuple[Reference, ...]
) -> Generator[Compared]:
    for group in groups:
        one = max(group, key=lambda each: each.case.episodes)
        there = [each for each in kept if each.played == one.played and len(each.accounts) == one.case.episodes]
        reference = there[0] if there else _played(one, pool, told)
        outdated = next((each.outdated for each in group if each.outdated), None)
        yield Compared(reference, tuple(each.case for each in group), outdated)


def _played(one: Ready, pool: Pool, told: Told) -> Reference:
    accounts: list[Account] = []
    # An edit while they are played ends the episodes: the texts of before are those that are played.
    texts = level_texts(one.setup.level, one.setup.variant, one.played.files)
    for each in episodes(one, pool):
        accounts.append(each.account)
        told(one.case, len(accounts), each.account)
    return Reference(one.played, tuple(accounts), texts, sources_hash())


def _keep(path: Path | None, inputs: str, references: tuple[Reference, ...]) -> None:
    if path:
        write_file(path, kept_text(inputs, references), _ADVICE, over_inputs=True)
