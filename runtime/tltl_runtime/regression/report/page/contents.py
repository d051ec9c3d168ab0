"""What a page is made of."""

from __future__ import annotations

from collections.abc import Mapping

from tltl_runtime.regression.explain.account import Account
from tltl_runtime.regression.report.case_report import CaseReport
from tltl_runtime.regression.verdict.verdict import Verdict
from tltl_runtime.stealth.level import Level
from tltl_runtime.stealth.recordings.episode import Episode
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import EMPTY, record


@record
class ReportedCase:
    """A case with what the page draws of it.

    ``level`` and ``fspa`` are what was played, None of a case that cannot be played.  ``episodes`` are the
    recorded ones by their index, ``before`` the accounts of the baseline, ``designed`` the level that it was recorded
    on, None where that is not known any more, ``curve`` the picture of a training that began with its policy, a PNG,
    empty where there is none.
    """

    report: CaseReport
    level: Level | None = None
    fspa: Fspa | None = None
    episodes: Mapping[int, Episode] = EMPTY
    before: tuple[Account, ...] = ()
    designed: Level | None = None
    curve: bytes = b""


@record
class NotRun:
    """A case of the suite that was not judged now: ``why``, as a sentence, and what an ``earlier`` run said of it."""

    name: str
    why: str
    earlier: Verdict | None = None


@record
class SuiteReport:
    """What a suite came to: its name, the seed and the error bound of its verdicts, and its cases in their order.

    ``versions`` are those of what played, by name; ``complete`` says whether all cases were judged, and trained anew,
    that were asked for.  ``not_run`` are the other cases of the suite.  ``note`` is what whoever reads the page should
    know first.
    """

    suite: str
    seed: int
    error: float
    versions: Mapping[str, str]
    cases: tuple[ReportedCase, ...]
    complete: bool = True
    not_run: tuple[NotRun, ...] = ()
    note: str = ""
