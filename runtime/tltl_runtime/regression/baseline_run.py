"""The baseline of a suite is recorded: its policies play all episodes, on the levels as they are now."""

from __future__ import annotations

import json
from collections.abc import Generator
from pathlib import Path
from typing import Final

from tltl_runtime.evaluation.evaluate import Pool
from tltl_runtime.record_json import RecordJsonError, from_json, to_json
from tltl_runtime.regression.account import Account
from tltl_runtime.regression.baseline import Reference, write_baseline
from tltl_runtime.regression.play import Ready, Told, episodes, ready
from tltl_runtime.regression.suite import Case, Suite
from tltl_runtime.sources import sources_hash
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.files import reason
from tltlc.record import record
from tltlc.writing import write_file

_ADVICE: Final = "name another place with --output"


def record_baseline(
    suite: Suite, pool: Pool, told: Told, kept: tuple[Reference, ...] = ()
) -> Generator[tuple[Case, Reference]]:
    """Play all episodes of each level, variant, spec and policy that the suite's cases are compared with.

    Each comes as soon as it is over, with the case that asks for most episodes among those that are compared with it.
    What is ``kept`` of an earlier recording is not played again where nothing has changed since.

    Raises:
        TltlError: something does not fit, before anything is played; TLT0905, a level was edited since; what playing
            raises.
    """
    wanted: list[Ready] = []
    for case in suite.cases:
        one = ready(case, suite.seed, case.reference)
        rows = [row for row, other in enumerate(wanted) if other.played == one.played]
        if not rows:
            wanted.append(one)
        elif wanted[rows[0]].case.episodes < case.episodes:
            wanted[rows[0]] = one
    for one in wanted:
        there = [each for each in kept if each.played == one.played and len(each.accounts) == one.case.episodes]
        yield one.case, there[0] if there else _played(one, pool, told)


def write_recorded(suite: Suite, path: Path, pool: Pool, told: Told) -> Generator[tuple[Case, Reference]]:
    """Record the baseline of a suite, as :func:`record_baseline` does, and write it to ``path`` when all is over.

    Until then what is over is kept beside it, so that a recording that was stopped goes on.

    Raises:
        TltlError: TLT0005, a file cannot be written; what :func:`record_baseline` raises.
    """
    partial = path.with_name(f"{path.name}.partial")
    kept, found = _kept(partial), list[Reference]()
    # The place may refuse: better to know before minutes of play.
    _keep(partial, kept)
    for case, reference in record_baseline(suite, pool, told, kept):
        found.append(reference)
        _keep(partial, (*found, *(each for each in kept if each not in found)))
        yield case, reference
    write_baseline(path, tuple(found))
    _remove(partial)


def _played(one: Ready, pool: Pool, told: Told) -> Reference:
    accounts: list[Account] = []
    for each in episodes(one, pool):
        accounts.append(each.account)
        told(one.case, len(accounts), each.account)
    return Reference(one.played, tuple(accounts))


@record
class _Partial:
    sources: str
    references: tuple[Reference, ...]


def _keep(path: Path, references: tuple[Reference, ...]) -> None:
    write_file(path, json.dumps(to_json(_Partial(sources_hash(), references))), _ADVICE)


def _kept(path: Path) -> tuple[Reference, ...]:
    """What the same code has left there; nothing where it cannot be read."""
    try:
        found = from_json(_Partial, json.loads(path.read_text(encoding="utf-8")), "partial")
    except (OSError, ValueError, RecordJsonError, RecursionError):
        return ()
    return found.references if found.sources == sources_hash() else ()


def _remove(path: Path) -> None:
    try:
        path.unlink(missing_ok=True)
    except OSError as error:
        raise TltlError([Diagnostic("TLT0005", f"cannot remove `{path}`: {reason(error)}", help=_ADVICE)]) from None
