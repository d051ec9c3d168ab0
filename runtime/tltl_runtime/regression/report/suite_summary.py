"""The result of a suite in one sentence, for the person who decides what to do, and the counts in it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Final, Literal, TypeVar

from tltl_runtime.regression.report.case_report import CaseReport, CaseStatus
from tltl_runtime.regression.verdict.verdict import CaseVerdict
from tltlc.api import record

_T = TypeVar("_T")

Noun = Literal["level", "set of traces", "case"]
"""What the cases of a suite are; ``case`` if some are levels and others are recorded traces."""

_PLURALS: Final[Mapping[Noun, str]] = {"level": "levels", "set of traces": "sets of traces", "case": "cases"}

_FAILS: Final = ("no longer meets its spec", "no longer meet their specs")
_FAILED_BEFORE: Final = ("does not meet its spec, as before", "do not meet their specs, as before")

_LEVEL_VERBS: Final[Mapping[CaseStatus, tuple[str, str]]] = {
    "unfinished": ("can no longer be finished by its agent", "can no longer be finished by their agents"),
    "impossible": ("can no longer be finished", "can no longer be finished"),
    "unplayable": ("cannot be played", "cannot be played"),
    "unfinished_before": ("is not finished by its agent, as before", "are not finished by their agents, as before"),
    "changed": ("changed", "changed"),
    "uncertain": ("may have changed", "may have changed"),
    "as_before": ("plays as before", "play as before"),
}
"""What a sentence says of one level, and of several, in the order of the sentence."""

_OTHER_VERBS: Final[Mapping[CaseStatus, tuple[str, str]]] = {
    "unfinished": _FAILS,
    "impossible": _FAILS,
    "unplayable": ("cannot be judged", "cannot be judged"),
    "unfinished_before": _FAILED_BEFORE,
    "changed": ("changed", "changed"),
    "uncertain": ("may have changed", "may have changed"),
    "as_before": ("is as before", "are as before"),
}
"""The same for recorded traces, and for suites with both."""

_VERDICTS: Final[tuple[CaseVerdict, ...]] = ("fail", "review", "pass")


def worst_first(items: Sequence[tuple[CaseReport, _T]]) -> list[tuple[CaseReport, _T]]:
    """Return reports with what belongs to them: first those that fail, then those to review.

    The order of reports with the same verdict stays.
    """
    return sorted(items, key=lambda item: _VERDICTS.index(item[0].verdict))


@record
class SuiteSummary:
    """How many cases have which status.

    ``statuses`` has the status of each judged case. ``new_failures`` counts the cases that play as
    before, but also fail in a way in which no episode of the baseline fails. ``not_judged`` counts the
    cases that were not judged, because the run was stopped or because ``--changed`` left them out.
    """

    noun: Noun
    statuses: tuple[CaseStatus, ...]
    new_failures: int
    not_judged: int = 0

    @property
    def counts(self) -> dict[str, int]:
        """The number of judged cases (``judged``), of cases with each status, and the other two counts."""
        return {
            "judged": len(self.statuses),
            **{status: self.statuses.count(status) for status in _LEVEL_VERBS},
            "new_failures": self.new_failures,
            "not_judged": self.not_judged,
        }

    @property
    def sentence(self) -> str:
        """The counts as a sentence: ``2 of 9 levels changed; 7 play as before``."""
        if not self.statuses:
            return f"No {self.noun} was judged"
        clauses = list(self._clauses())
        total = len(self.statuses)
        count, clause = clauses[0]
        if total == 1:
            subject = f"The {self.noun}"
        elif self.statuses.count("as_before") == total:
            subject = f"All {total} {_PLURALS[self.noun]}"
        else:
            subject = f"{count} of {total} {_PLURALS[self.noun]}"
        texts = [f"{subject} {clause}", *(f"{number} {text}" for number, text in clauses[1:])]
        if self.not_judged:
            texts.append(f"{self.not_judged} {_form(('was', 'were'), self.not_judged)} not judged")
        return "; ".join(texts)

    @property
    def _verbs(self) -> Mapping[CaseStatus, tuple[str, str]]:
        return _LEVEL_VERBS if self.noun == "level" else _OTHER_VERBS

    def _clauses(self) -> Iterator[tuple[int, str]]:
        """Yield, for each group of cases that occurs, their number and what the sentence says of them."""
        impossible = self.statuses.count("impossible")
        unfinished = self.statuses.count("unfinished") + impossible
        if unfinished:
            status: CaseStatus = "impossible" if impossible == unfinished else "unfinished"
            by_nobody = f", {_number(impossible)} of them not by any player" if 0 < impossible < unfinished else ""
            yield unfinished, _form(self._verbs[status], unfinished) + by_nobody
        for status, verb in self._verbs.items():
            count = self.statuses.count(status)
            if count and status not in ("unfinished", "impossible"):
                yield count, _form(verb, count) + (self._new_failures_text(count) if status == "as_before" else "")

    def _new_failures_text(self, count: int) -> str:
        if not self.new_failures:
            return ""
        which = "" if count == 1 else f"{_number(self.new_failures)} of them "
        return f", {which}with {_form(('a new failure', 'new failures'), self.new_failures)}"


def suite_summary(reports: Sequence[CaseReport], not_judged: int = 0) -> SuiteSummary:
    """Return the summary of the reports on the judged cases; ``not_judged`` counts the other cases."""
    are_traces = {report.traces is not None for report in reports}
    noun: Noun = "case" if len(are_traces) == 2 else "set of traces" if are_traces == {True} else "level"
    new = sum(report.has_new_failure for report in reports)
    return SuiteSummary(noun, tuple(report.status for report in reports), new, not_judged)


def _number(count: int) -> str:
    return "one" if count == 1 else str(count)


def _form(forms: tuple[str, str], count: int) -> str:
    """Return the first form for a count of 1, else the second."""
    return forms[0] if count == 1 else forms[1]
