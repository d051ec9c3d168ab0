"""The head of the page: the suite, the counts of verdicts, and a row for each case."""

from __future__ import annotations

from collections.abc import Sequence

from markupsafe import Markup

from tltl_runtime.evaluation.figures import Figures
from tltl_runtime.regression.report.case_report import CaseReport
from tltl_runtime.regression.report.page.contents import SuiteReport
from tltl_runtime.regression.report.page.render import render
from tltl_runtime.regression.report.retraining_result import OUTCOMES
from tltl_runtime.regression.report.suite_summary import suite_summary, worst_first
from tltl_runtime.regression.verdict.verdict import CaseVerdict
from tltl_runtime.support.markup import coordinate
from tltl_runtime.support.number_text import mean_text, percent
from tltlc.api import record

_VERDICTS: tuple[CaseVerdict, ...] = ("fail", "review", "pass")


@record
class _Mean:
    """The mean of a figure, such as progress, as text: now and in the baseline.

    ``before`` is empty if there is no baseline.
    """

    now: str
    before: str


@record
class _PassRateBar:
    """A bar that shows a pass rate, in an SVG drawing that is 100 units wide and 22 units high.

    ``width`` is the pass rate in percent. ``kind`` is the CSS class of the bar, ``now`` or
    ``before``. ``whiskers`` is the SVG path that marks the confidence interval.
    """

    kind: str
    top: int
    width: str
    height: int
    whiskers: str


@record
class _PassRate:
    """The pass rate of a case, now and in the baseline: as texts, and as ``bars``.

    ``before`` is empty if there is no baseline. ``description`` says in words what the bars show.
    """

    now: str
    before: str
    description: str
    bars: tuple[_PassRateBar, ...]


@record
class _Row:
    """The table row of a judged case.

    ``slug`` is the case's short name in addresses within the page. ``retrained`` is the outcome of
    retraining its policy, or None. ``pass_rate``, ``progress`` and ``reward`` are None for a case that
    could not be played or judged. ``is_new_failure`` says that the case
    passes, but fails in a way that its baseline does not have.
    """

    name: str
    slug: str
    verdict: CaseVerdict
    retrained: str | None
    pass_rate: _PassRate | None
    progress: _Mean | None
    reward: _Mean | None
    headline: str
    is_new_failure: bool


def summary(suite: SuiteReport, slugs: Sequence[str]) -> Markup:
    """Return the head of the page as HTML.

    ``slugs`` are the short names of the cases in addresses within the page: first those of the
    judged cases, then those of ``suite.not_run``.
    """
    reports = [case.report for case in suite.cases]
    verdicts = [report.verdict for report in reports]
    rows = [_row(report, slug) for report, slug in worst_first(list(zip(reports, slugs, strict=False)))]
    return render(
        "summary.html",
        suite=suite,
        sentence=suite_summary(reports, len(suite.not_run)).sentence,
        counts=[(verdict, verdicts.count(verdict)) for verdict in _VERDICTS if verdict in verdicts],
        has_bars=any(report.figures for report in reports),
        rows=rows,
        not_run=list(zip(suite.not_run, slugs[len(reports) :], strict=True)),
    )


def provenance(suite: SuiteReport) -> Markup:
    """Return the end of the page as HTML: the seed, the error, the versions, and what was played."""
    facts = [
        *([] if suite.seed is None else [f"seed {suite.seed}"]),
        f"probability that any certain fail or review is wrong, or any pass has too low a rate: at most "
        f"{suite.error:.3g}",
        *(f"{name} {version}" for name, version in suite.versions.items()),
    ]
    played = [(case.report.name, case.report.played) for case in suite.cases if case.report.played]
    return render("provenance.html", facts=facts, played=played)


def _row(report: CaseReport, slug: str) -> _Row:
    now, before = report.figures, report.baseline
    return _Row(
        name=report.name,
        slug=slug,
        verdict=report.verdict,
        retrained=OUTCOMES[report.retrained.outcome] if report.retrained else None,
        pass_rate=_pass_rate(now, before) if now else None,
        progress=_mean(now.progress.mean, before.progress.mean if before else None) if now else None,
        reward=_mean(now.reward.mean, before.reward.mean if before else None) if now else None,
        headline=report.headline,
        is_new_failure=report.has_new_failure,
    )


def _mean(now: float, before: float | None) -> _Mean:
    return _Mean(mean_text(now), "" if before is None else mean_text(before))


def _pass_rate(now: Figures, before: Figures | None) -> _PassRate:
    """Return the pass rates ``now`` and ``before``, each as text and as a bar with a 95 % interval.

    ``before`` is None if there is no baseline.
    """
    bar = _bar(now, "now", top=0, height=12)
    if before is None:
        return _PassRate(_pass_text(now), "", _rate_words(now), (bar,))
    description = f"{_rate_words(now)}; before: {_rate_words(before)}"
    return _PassRate(_pass_text(now), _pass_text(before), description, (bar, _bar(before, "before", top=15, height=7)))


def _bar(figures: Figures, kind: str, top: int, height: int) -> _PassRateBar:
    low, high = (coordinate(100 * end) for end in figures.pass_interval)
    above, middle, below = coordinate(top + height / 6), coordinate(top + height / 2), coordinate(top + 5 * height / 6)
    whiskers = f"M{low},{middle}H{high}M{low},{above}V{below}M{high},{above}V{below}"
    return _PassRateBar(kind, top, coordinate(100 * figures.pass_rate), height, whiskers)


def _rate_words(figures: Figures) -> str:
    low, high = (100 * end for end in figures.pass_interval)
    return f"{_passed_text(figures)}, 95 % interval {low:.0f} to {high:.0f} %"


def _passed_text(figures: Figures) -> str:
    """Return how many of the episodes met the spec, for example ``12 of 25``."""
    return f"{round(figures.pass_rate * figures.episodes)} of {figures.episodes}"


def _pass_text(figures: Figures) -> str:
    return f"{_passed_text(figures)} · {percent(figures.pass_rate).replace('%', ' %')}"
