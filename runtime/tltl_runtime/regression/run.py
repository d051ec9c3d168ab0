"""A suite is run: its cases one after the other, each kept in a folder, so that a run that was stopped goes on."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Generator, Iterator, Sequence
from pathlib import Path
from typing import Final

from tltl_runtime.evaluation.evaluate import Pool
from tltl_runtime.record_json import RecordJsonError, from_json, to_json
from tltl_runtime.regression.account import Account
from tltl_runtime.regression.baseline import Played, Reference, reference_of
from tltl_runtime.regression.case_report import CaseReport, report_on, report_on_broken
from tltl_runtime.regression.play import Ready, Result, episodes, judged, ready
from tltl_runtime.regression.suite import Case, Suite
from tltl_runtime.stealth.episodes.file import SUFFIX
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.record import record, replace
from tltlc.writing import write_files

_REPORT: Final = "case.json"
_VERSION: Final = 1
_RECORDINGS: Final = 3
"""Of how many episodes of each finding there are recordings."""

Told = Callable[[Case, int, Account], None]
"""Is told of a case the number of episodes so far, and the last one."""


@record
class Done:
    """A case that is over; ``kept``: it was played by an earlier run, of which nothing has changed."""

    report: CaseReport
    kept: bool


def regress(
    suite: Suite, cases: Sequence[Case], references: tuple[Reference, ...], folder: Path, pool: Pool, told: Told
) -> Generator[Done]:
    """Judge some cases of a suite, in their order, each as soon as it is over.

    What was played is kept below ``folder``; a case of which nothing has changed since is not played again.

    Raises:
        TltlError: TLT0903, the baseline lacks a case, before anything is played; TLT0005; what playing raises.
    """
    made = [(case, *_prepared(suite, case, references)) for case in cases]
    error = suite.error / len(suite.cases)
    for case, prepared, fault in made:
        if prepared is None:
            assert fault is not None
            yield Done(report_on_broken(case, fault), kept=False)
            continue
        one, reference = prepared
        place, identity = folder / _folder_name(case), _identity(one, reference, error)
        kept = _kept(place, identity)
        if kept:
            yield Done(kept, kept=True)
            continue
        result = judged(one, reference, error, pool, lambda count, last, case=case: told(case, count, last))  # type: ignore[misc]
        yield Done(_write(place, identity, result), kept=False)


def record_baseline(suite: Suite, pool: Pool, told: Told) -> Iterator[Reference]:
    """Play all episodes of each level, variant, spec and policy that the suite's cases are compared with."""
    played: list[Played] = []
    for case in suite.cases:
        one = ready(case, suite.seed, case.reference)
        if one.played in played:
            continue
        played.append(one.played)
        accounts: list[Account] = []
        for each in episodes(one, pool):
            accounts.append(each.account)
            told(case, len(accounts), each.account)
        yield Reference(one.played, tuple(accounts))


def _prepared(
    suite: Suite, case: Case, references: tuple[Reference, ...]
) -> tuple[tuple[Ready, Reference] | None, TltlError | None]:
    """A case that can be played and its reference, or why it cannot be played."""
    try:
        one = ready(case, suite.seed)
    except TltlError as error:
        return None, error
    wanted = replace(one.played, variant=case.reference)
    return (one, reference_of(references, wanted, suite.path)), None


def _folder_name(case: Case) -> str:
    return "".join(each if each.isalnum() or each in "-_+." else "-" for each in case.name)


def _identity(one: Ready, reference: Reference, error: float) -> str:
    """The hash of all that the report on a case depends on."""
    case = one.case
    parts = [
        _VERSION,
        case.name,
        case.episodes,
        to_json(case.thresholds),
        error,
        to_json(one.played),
        to_json(reference),
    ]
    return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()


@record
class _Document:
    identity: str
    report: CaseReport


def _kept(place: Path, identity: str) -> CaseReport | None:
    """The report that an earlier run has left, if nothing has changed since."""
    try:
        found = from_json(_Document, json.loads((place / _REPORT).read_text(encoding="utf-8")), "report")
    except (OSError, ValueError, RecordJsonError, RecursionError):
        # It is played again.
        return None
    there = all((place / name).is_file() for _, name in found.report.recordings)
    return found.report if found.identity == identity and there else None


def _write(place: Path, identity: str, result: Result) -> CaseReport:
    """Write the report on a case and the recordings of the episodes that it speaks of."""
    report = report_on(result)
    by_index = {each.account.index: each.recording for each in result.episodes}
    successes = [each.index for each in report.accounts if each.success]
    spoken_of = [index for finding in report.explanation for index in finding.episodes[:_RECORDINGS]]
    named = {index: f"{index}{SUFFIX}" for index in sorted({*spoken_of, *successes[:1]})}
    report = replace(report, recordings=tuple(named.items()))
    text = json.dumps(to_json(_Document(identity, report)), ensure_ascii=False) + "\n"
    write_files(
        place, {**{name: by_index[index] for index, name in named.items()}, _REPORT: text}, "name another place"
    )
    return report
