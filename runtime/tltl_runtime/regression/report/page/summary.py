"""The head of the page: the suite, the counts of verdicts, and a row for each case."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from markupsafe import Markup

from tltl_runtime.evaluation.figures import Figures
from tltl_runtime.regression.report.case_report import CaseReport
from tltl_runtime.regression.report.page.contents import NotRun, SuiteReport
from tltl_runtime.regression.report.page.markup import element, joined, prose, short
from tltl_runtime.regression.retrain.retrained import OUTCOMES
from tltl_runtime.regression.verdict.verdict import Verdict
from tltl_runtime.support.number_text import percent

_VERDICTS: tuple[Verdict, ...] = ("pass", "review", "fail")
_HEADS = ("Verdict", "Met", "Progress", "Reward", "Why")
"""The titles of the columns after the name of the case."""

_WHISKER: Final = "The thin line on a bar is the 95 % interval of its share, for reading; verdicts are by a wider one."

NOT_RUN: Final = "not run"
"""The text in place of a verdict for a case that was not judged in this run."""


def summary(suite: SuiteReport, slugs: Sequence[str]) -> Markup:
    """The suite, the counts of verdicts, the versions and the table of verdicts.

    ``slugs`` are the addresses of the sections, first of the judged cases, then of the others.
    """
    reports = [case.report for case in suite.cases]
    verdicts = [report.verdict for report in reports]
    counts = [
        element("li", badge(verdict), f" {verdicts.count(verdict)}") for verdict in _VERDICTS if verdict in verdicts
    ]
    if suite.not_run:
        counts.append(element("li", badge(NOT_RUN), f" {len(suite.not_run)}"))
    stopped_note = element(
        "p", "The run was stopped before all was judged and trained that was asked for.", class_="warning"
    )
    facts = [
        f"seed {suite.seed}",
        f"probability that any certain fail or review is wrong, or any pass has too low a rate: at most "
        f"{suite.error:.3g}",
        *(f"{name} {version}" for name, version in suite.versions.items()),
    ]
    rows = [_row(report, slug) for report, slug in zip(reports, slugs, strict=False)]
    rows += [_row_not_run(case, slug) for case, slug in zip(suite.not_run, slugs[len(reports) :], strict=True)]
    head = element("thead", element("tr", *(element("th", title, scope="col") for title in ("Case", *_HEADS))))
    return joined(
        (
            element("h1", f"Regression report: {suite.suite}"),
            element("p", suite.note) if suite.note else None,
            None if suite.complete else stopped_note,
            element("ul", *counts, class_="counts-of-verdicts", aria_label="Verdicts"),
            element("p", " · ".join(facts), class_="facts"),
            element("h2", "Verdicts"),
            element(
                "p",
                element("label", element("input", type="checkbox", id="page:only-findings"), " only findings"),
                class_="filter",
            ),
            element("p", element("small", _WHISKER)) if any(report.figures for report in reports) else None,
            element("table", head, element("tbody", *rows), class_="verdicts"),
        )
    )


def badge(verdict: str) -> Markup:
    """A verdict, or the text in its place, as a coloured word."""
    return element("span", verdict, class_=f"verdict {verdict}")


def _row(report: CaseReport, slug: str) -> Markup:
    now, before = report.figures, report.baseline
    retrained = element("small", f"trained anew: {OUTCOMES[report.retrained.outcome]}") if report.retrained else None
    cells = (
        joined((badge(report.verdict), retrained)),
        _met(now, before) if now else "–",
        _against(now.progress.mean, before.progress.mean if before else None) if now else "–",
        _against(now.reward.mean, before.reward.mean if before else None) if now else "–",
        prose(report.headline),
    )
    written = [
        element("td", inside, data_head=head, class_=f"cell-{head.lower()}")
        for head, inside in zip(_HEADS, cells, strict=True)
    ]
    return element("tr", _name(report.name, slug), *written, data_verdict=report.verdict)


def _row_not_run(case: NotRun, slug: str) -> Markup:
    """A row for a case that was not judged in this run, with the verdict of an earlier run."""
    earlier = element("small", f"earlier: {case.earlier}") if case.earlier else None
    cells = (
        element("td", badge(NOT_RUN), earlier, data_head=_HEADS[0]),
        element("td", prose(case.why), data_head=_HEADS[-1], colspan=len(_HEADS) - 1),
    )
    return element("tr", _name(case.name, slug), *cells, data_verdict=case.earlier or NOT_RUN)


def _name(name: str, slug: str) -> Markup:
    """The name of a case, with a link to its section."""
    return element("th", element("a", name, href=f"#{slug}"), scope="row")


def _met(now: Figures, before: Figures | None) -> Markup:
    """The pass rate as a bar with its 95 % confidence interval, and the baseline's bar below it."""
    words = f"{_rate_words(now)}; before: {_rate_words(before)}" if before else _rate_words(now)
    bars = [*_rate(now, "now", top=0, height=12)]
    if before:
        bars += _rate(before, "before", top=15, height=7)
    small = element("small", f"before {_with_share(before)}") if before else None
    # Stretch the bar to the available width.
    manner = {"viewBox": "0 0 100 22", "role": "img", "preserveAspectRatio": "none"}
    bar = element("svg", element("title", words), *bars, class_="bar", **manner)
    return joined((bar, element("span", _with_share(now), class_="number"), small))


def _rate(figures: Figures, kind: str, top: int, height: int) -> Iterator[Markup]:
    """The bar of a pass rate, in percent, with the whiskers of its confidence interval."""
    low, high = (short(100 * end) for end in figures.pass_interval)
    above, middle, below = short(top + height / 6), short(top + height / 2), short(top + 5 * height / 6)
    yield element("rect", class_="track", y=top, width=100, height=height)
    yield element("rect", class_=f"rate {kind}", y=top, width=short(100 * figures.pass_rate), height=height)
    whisker = f"M{low},{middle}H{high}M{low},{above}V{below}M{high},{above}V{below}"
    # A seam separates the whiskers from the bar, which is about as dark.
    yield element("path", class_="seam", d=whisker)
    yield element("path", class_="interval", d=whisker)


def _rate_words(figures: Figures) -> str:
    low, high = (100 * end for end in figures.pass_interval)
    return f"{_of(figures)}, 95 % interval {low:.0f} to {high:.0f} %"


def _of(figures: Figures) -> str:
    """The number of episodes that met the spec, and of all episodes."""
    return f"{round(figures.pass_rate * figures.episodes)} of {figures.episodes}"


def _with_share(figures: Figures) -> str:
    return f"{_of(figures)} · {percent(figures.pass_rate).replace('%', ' %')}"


def _against(now: float, before: float | None) -> Markup:
    small = None if before is None else element("small", f"before {before:.2f}")
    return joined((element("span", f"{now:.2f}", class_="number"), small))
