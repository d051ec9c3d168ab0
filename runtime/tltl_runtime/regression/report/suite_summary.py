"""The result of a suite in one sentence, for the person who decides what to do, and the counts in it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Final, Literal, TypeVar

from tltl_runtime.regression.report.case_report import CaseReport, CaseStatus
from tltl_runtime.regression.verdict.verdict import CaseVerdict
from tltl_runtime.support.number_text import percent
from tltlc.api import record

_T = TypeVar("_T")

Noun = Literal["level", "set of traces", "case"]
"""What the cases of a suite are.

It is ``case`` if some are played and others are recorded traces, or if several cases play one level.
"""

_PLURALS: Final[Mapping[Noun, str]] = {"level": "levels", "set of traces": "sets of traces", "case": "cases"}

_FAILS: Final = ("no longer meets its spec", "no longer meet their specs")

_PLAYED_VERBS: Final[Mapping[CaseStatus, tuple[str, str]]] = {
    "unfinished": ("can no longer be finished by its agent", "can no longer be finished by their agents"),
    "impossible": ("can no longer be finished", "can no longer be finished"),
    "much_less_often": (
        "is finished much less often by its agent{rates}",
        "are finished much less often by their agents{rates}",
    ),
    "unplayable": ("cannot be played", "cannot be played"),
    "unfinished_before": ("is not finished by its agent, as before", "are not finished by their agents, as before"),
    "too_seldom_before": (
        "is still finished too seldom by its agent{rates}",
        "are still finished too seldom by their agents{rates}",
    ),
    "outdated": (
        "has another spec than its agent was trained for",
        "have other specs than their agents were trained for",
    ),
    "less_often": ("is finished less often by its agent{rates}", "are finished less often by their agents{rates}"),
    "changed": ("changed", "changed"),
    "uncertain": ("may have changed", "may have changed"),
    "low_rate": (
        "plays as before, but is not certainly finished often enough{rates}",
        "play as before, but are not certainly finished often enough{rates}",
    ),
    "as_before": ("plays as before", "play as before"),
}
"""What a sentence says of one level that is played, and of several, in the order of the sentence.

``{rates}`` stands for the pass rates, now and before.
"""

_OTHER_VERBS: Final[Mapping[CaseStatus, tuple[str, str]]] = {
    "unfinished": _FAILS,
    "impossible": _FAILS,
    "much_less_often": ("meets its spec much less often{rates}", "meet their specs much less often{rates}"),
    "unplayable": ("cannot be judged", "cannot be judged"),
    "unfinished_before": ("does not meet its spec, as before", "do not meet their specs, as before"),
    "too_seldom_before": ("still meets its spec too seldom{rates}", "still meet their specs too seldom{rates}"),
    "outdated": _PLAYED_VERBS["outdated"],
    "less_often": ("meets its spec less often{rates}", "meet their specs less often{rates}"),
    "changed": ("changed", "changed"),
    "uncertain": ("may have changed", "may have changed"),
    "low_rate": (
        "is as before, but does not certainly meet its spec often enough{rates}",
        "are as before, but do not certainly meet their specs often enough{rates}",
    ),
    "as_before": ("is as before", "are as before"),
}
"""The same for recorded traces, and for suites with both."""

_NOT_ABOUT_RATE: Final = ("changed", "as_before")
"""The statuses of a single case of recorded traces of which the sentence does not count the traces."""

_VERDICTS: Final[tuple[CaseVerdict, ...]] = ("fail", "review", "pass")


def worst_first(items: Sequence[tuple[CaseReport, _T]]) -> list[tuple[CaseReport, _T]]:
    """Return reports with what belongs to them: first those that fail, then those to review.

    The order of reports with the same verdict stays.
    """
    return sorted(items, key=lambda item: _VERDICTS.index(item[0].verdict))


@record
class SuiteSummary:
    """How many cases have which status.

    ``reports`` are those on the judged cases. ``not_judged`` counts the cases that were not judged,
    because the run was stopped or because ``--changed`` left them out.
    """

    reports: tuple[CaseReport, ...]
    not_judged: int = 0

    @property
    def noun(self) -> Noun:
        """What the sentence calls the cases."""
        if not self._have_traces:
            levels = {report.level for report in self.reports}
            return "level" if len(levels) == len(self.reports) else "case"
        return "set of traces" if all(report.traces for report in self.reports) else "case"

    @property
    def counts(self) -> dict[str, int]:
        """The number of judged cases (``judged``), of cases with each status, and two other counts.

        ``new_failures`` counts the cases that play as before, but also fail in a way in which no episode of the
        baseline fails. ``not_judged`` counts the cases that were not judged.
        """
        return {
            "judged": len(self.reports),
            **{status: len(self._having(status)) for status in _PLAYED_VERBS},
            "new_failures": self._new_failures,
            "not_judged": self.not_judged,
        }

    @property
    def sentence(self) -> str:
        """The counts as a sentence: ``2 of 9 levels changed; 7 play as before``."""
        if not self.reports:
            return f"No {self.noun} was judged"
        texts = list(self._texts())
        if self.not_judged:
            texts.append(f"{self.not_judged} {_form(('was', 'were'), self.not_judged)} not judged")
        return "; ".join(texts)

    def _texts(self) -> Iterator[str]:
        """Yield the parts of the sentence on the judged cases."""
        total = len(self.reports)
        if total == 1 and self.noun == "set of traces" and (text := _traces_text(self.reports[0])):
            yield text
            return
        (count, clause), *others = self._clauses()
        if total == 1:
            subject = f"The {self.noun}"
        elif len(self._having("as_before")) == total:
            subject = f"All {total} {_PLURALS[self.noun]}"
        else:
            subject = f"{count} of {total} {_PLURALS[self.noun]}"
        yield f"{subject} {clause}"
        yield from (f"{number} {text}" for number, text in others)

    @property
    def _have_traces(self) -> bool:
        return any(report.traces for report in self.reports)

    @property
    def _new_failures(self) -> int:
        return sum(report.has_new_failure for report in self.reports)

    def _having(self, *statuses: CaseStatus) -> list[CaseReport]:
        return [report for report in self.reports if report.status in statuses]

    def _clauses(self) -> Iterator[tuple[int, str]]:
        """Yield, for each group of cases that occurs, their number and what the sentence says of them."""
        verbs = _OTHER_VERBS if self._have_traces else _PLAYED_VERBS
        impossible, unfinished = len(self._having("impossible")), len(self._having("unfinished", "impossible"))
        if unfinished:
            status: CaseStatus = "impossible" if impossible == unfinished else "unfinished"
            by_nobody = f", {_number(impossible)} of them not by any player" if 0 < impossible < unfinished else ""
            yield unfinished, _form(verbs[status], unfinished) + by_nobody
        for status, verb in verbs.items():
            group = self._having(status)
            if group and status not in ("unfinished", "impossible"):
                text = _form(verb, len(group)).format(rates=_rates_text(group))
                yield len(group), text + (self._new_failures_text(len(group)) if status == "as_before" else "")

    def _new_failures_text(self, count: int) -> str:
        if not self._new_failures:
            return ""
        which = "" if count == 1 else f"{_number(self._new_failures)} of them "
        return f", {which}with {_form(('a new failure', 'new failures'), self._new_failures)}"


def suite_summary(reports: Sequence[CaseReport], not_judged: int = 0) -> SuiteSummary:
    """Return the summary of the reports on the judged cases; ``not_judged`` counts the other cases."""
    return SuiteSummary(tuple(reports), not_judged)


def _rates_text(reports: Sequence[CaseReport]) -> str:
    """Return the pass rates of cases, the least and the greatest: `` (in 4% to 30%, before 100%)``.

    Of a single case, the text also says in 30% of what.
    """
    now, before = (
        sorted(figures.pass_rate for figures in side if figures)
        for side in zip(*((report.figures, report.baseline) for report in reports), strict=True)
    )
    noun = " of traces" if reports[0].traces else " of episodes"
    return f" (in {_range_text(now)}{noun if len(reports) == 1 else ''}, before in {_range_text(before)})"


def _range_text(rates: Sequence[float]) -> str:
    """Return the least and the greatest of sorted rates in percent: ``4% to 30%``."""
    return " to ".join(dict.fromkeys(map(percent, (rates[0], rates[-1])))) if rates else "unknown"


def _traces_text(report: CaseReport) -> str:
    """Return how many traces of a case fail: ``20 of 30 traces break the spec; before: none``.

    A number of traces that cannot be judged comes last.

    Empty if the result of the case is not about how many traces fail.
    """
    now, before = report.figures, report.baseline
    if now is None or before is None or report.status in _NOT_ABOUT_RATE:
        return ""
    failed, failed_before = (round(figures.episodes * (1.0 - figures.pass_rate)) for figures in (now, before))
    causes = {episode.cause for episode in report.episodes if not episode.summary.success}
    verbs = ("breaks", "break") if causes == {"violated"} else ("does not meet", "do not meet")
    unread = f"; {report.traces.now.unread} cannot be judged" if report.traces and report.traces.now.unread else ""
    if not failed:
        met_before = f"{before.episodes - failed_before} of {before.episodes}" if failed_before else "all"
        return f"All {now.episodes} traces meet the spec; before: {met_before}{unread}"
    earlier = f"{failed_before} of {before.episodes}" if failed_before else "none"
    return f"{failed} of {now.episodes} traces {_form(verbs, failed)} the spec; before: {earlier}{unread}"


def _number(count: int) -> str:
    return "one" if count == 1 else str(count)


def _form(forms: tuple[str, str], count: int) -> str:
    """Return the first form for a count of 1, else the second."""
    return forms[0] if count == 1 else forms[1]
