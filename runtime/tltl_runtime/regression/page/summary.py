"""The head of the page: which suite, how many verdicts of which kind, and a row for each case."""

from __future__ import annotations

from collections.abc import Sequence

from tltl_runtime.regression.case_report import CaseReport, Figures
from tltl_runtime.regression.page.contents import SuiteReport
from tltl_runtime.regression.page.markup import Markup, element, joined, prose, short
from tltl_runtime.regression.verdict import Verdict

_VERDICTS: tuple[Verdict, ...] = ("pass", "review", "fail")
_HEADS = ("Case", "Verdict", "Met", "Progress", "Reward", "Why")


def summary(suite: SuiteReport, slugs: Sequence[str]) -> Markup:
    """Suite, counts of verdicts, versions and the table of verdicts, whose rows lead to the sections ``slugs``."""
    reports = [case.report for case in suite.cases]
    verdicts = [report.verdict for report in reports]
    counts = [
        element("li", badge(verdict), f" {verdicts.count(verdict)}") for verdict in _VERDICTS if verdict in verdicts
    ]
    least = element("p", "Not all of its cases were judged: the run was stopped.", class_="warning")
    facts = [
        f"seed {suite.seed}",
        f"a wrong verdict is less likely than {suite.error:.3g}",
        *(f"{name} {version}" for name, version in suite.versions.items()),
    ]
    rows = [_row(report, slug) for report, slug in zip(reports, slugs, strict=True)]
    head = element("thead", element("tr", *(element("th", each, scope="col") for each in _HEADS)))
    return joined(
        (
            element("h1", "Regression report: ", element("span", suite.suite, class_="suite")),
            None if suite.complete else least,
            element("ul", *counts, class_="counts-of-verdicts", aria_label="Verdicts"),
            element("p", " · ".join(facts), class_="facts"),
            element("h2", "Verdicts", id="verdicts"),
            element(
                "p",
                element("label", element("input", type="checkbox", id="only-findings"), " only findings"),
                class_="filter",
            ),
            element("table", head, element("tbody", *rows), class_="verdicts"),
        )
    )


def badge(verdict: Verdict) -> Markup:
    """A verdict, as a coloured word."""
    return element("span", verdict, class_=f"verdict {verdict}")


def rate_words(now: Figures) -> str:
    """How many of how many episodes met the spec."""
    return f"{round(now.pass_rate * now.episodes)} of {now.episodes}"


def _row(report: CaseReport, slug: str) -> Markup:
    now, before = report.figures, report.baseline
    reason = prose(report.reasons[0]) if report.reasons else None
    cells = (
        ("Verdict", badge(report.verdict)),
        ("Met", _met(now, before) if now else "–"),
        ("Progress", _against(now.progress.mean, before and before.progress.mean) if now else "–"),
        ("Reward", _against(now.reward.mean, before and before.reward.mean) if now else "–"),
        ("Why", reason),
    )
    name = element("th", element("a", report.name, href=f"#{slug}"), scope="row")
    written = [element("td", inside, data_head=head, class_=f"cell-{head.lower()}") for head, inside in cells]
    return element("tr", name, *written, data_verdict=report.verdict)


def _met(now: Figures, before: Figures | None) -> Markup:
    """The pass rate as a bar with its interval of 95 %, and a mark where the baseline's is."""
    low, high = (100 * end for end in now.pass_interval)
    words = f"{rate_words(now)}, 95 % interval {low:.0f} to {high:.0f} %"
    words += f"; before: {rate_words(before)}" if before else ""
    bar = element(
        "svg",
        element("title", words),
        element("rect", class_="track", width=100, height=14),
        element("rect", class_="rate", width=short(100 * now.pass_rate), height=14),
        element("path", class_="interval", d=f"M{short(low)},4V10M{short(low)},7H{short(high)}M{short(high)},4V10"),
        element("path", class_="before", d=f"M{short(100 * before.pass_rate)},0V14") if before else None,
        class_="bar",
        viewBox="0 0 100 14",
        role="img",
        preserveAspectRatio="none",
    )
    small = element("small", f"before {rate_words(before)}") if before else None
    return joined((bar, element("span", rate_words(now), class_="number"), small))


def _against(now: float, before: float | None) -> Markup:
    small = None if before is None else element("small", f"before {before:.2f}")
    return joined((element("span", f"{now:.2f}", class_="number"), small))
