"""The section of a case: reasons, automaton, map with player, and curves."""

from __future__ import annotations

import base64
from collections.abc import Iterator, Mapping, Sequence
from typing import Final

from markupsafe import Markup

from tltl_runtime.game.episode import RecordedEpisode
from tltl_runtime.regression.explain.account import Account
from tltl_runtime.regression.report.case_report import CaseReport
from tltl_runtime.regression.report.page.automaton import Drawn, counts_table, picture
from tltl_runtime.regression.report.page.case_maps import case_maps
from tltl_runtime.regression.report.page.contents import NotRun, ReportedCase
from tltl_runtime.regression.report.page.curves import progress_curves, progress_distribution
from tltl_runtime.regression.report.page.episode_links import episode_links
from tltl_runtime.regression.report.page.markup import element, joined, prose
from tltl_runtime.regression.report.page.player_panel import player_panel
from tltl_runtime.regression.report.page.summary import NOT_RUN, badge
from tltl_runtime.regression.report.page.traffic import Traffic, traffic
from tltlc.api import Fspa, formula_text

_KEY: Final = (
    "In blue how many episodes visited a state, in red how many failed in it; the more episodes took an edge, the "
    "thicker it is. The figure in a state's upper right corner is its distance, the least number of transitions to "
    "acceptance."
)
_SHOWN: Final = (("ways", "ways"), ("time", "time spent"), ("failed", "failed ends"))
_WHEN: Final = (("now", "now"), ("before", "baseline"))


def case_section(case: ReportedCase, slug: str, drawn: Drawn | None) -> Markup:
    """The section of a case, with the address ``slug``.  Without level and automaton, it has only texts.

    ``drawn`` is the picture of the case's automaton.
    """
    report, level, fspa = case.report, case.level, case.fspa
    parts: list[Markup] = [
        element("h2", report.name, " ", badge(report.verdict), id=f"title:{slug}"),
        _facts(report, fspa),
        *_why(report, case.episodes, slug),
        *_retrained(case),
    ]
    if level is not None and fspa is not None and drawn is not None:
        now, before = traffic(report.accounts), traffic(case.before)
        parts += [
            _toggles(case.before),
            element("h3", "Automaton", class_="automaton-title"),
            *_automaton(fspa, drawn, now, before),
            element("h3", "Map"),
            element("div", case_maps(case, level), player_panel(fspa, case.episodes), class_="stage"),
            element("h3", "Progress"),
            element("div", *_curves(case), class_="curves"),
            element("h3", "States"),
            element("details", element("summary", "The automaton as a table"), counts_table(fspa, now, before)),
        ]
    return element(
        "section",
        *parts,
        id=slug,
        class_="case",
        data_verdict=report.verdict,
        aria_labelledby=f"title:{slug}",
        data_when="now",
    )


def not_run_section(case: NotRun, slug: str) -> Markup:
    """The section of a case that was not judged in this run, with the reason."""
    earlier = element("p", "An earlier run said ", badge(case.earlier), " of it.") if case.earlier else None
    return element(
        "section",
        element("h2", case.name, " ", badge(NOT_RUN), id=f"title:{slug}"),
        element("p", prose(case.why)),
        earlier,
        id=slug,
        class_="case",
        data_verdict=case.earlier or NOT_RUN,
        aria_labelledby=f"title:{slug}",
    )


def _facts(report: CaseReport, fspa: Fspa | None) -> Markup:
    facts = [f"{report.level} {report.variant}"]
    if report.reference:
        facts.append(f"compared with {report.reference.variant}")
    if report.played:
        facts += [f"spec {report.played.spec}", f"policy {report.played.policy[:12]}"]
    if report.figures and not report.certain:
        facts.append("not certain, though all of its episodes were played")
    goal = element("p", formula_text(fspa), class_="goal") if fspa else None
    return joined((element("p", " · ".join(facts), class_="facts"), goal))


def _why(report: CaseReport, episodes: Mapping[int, RecordedEpisode], slug: str) -> Iterator[Markup]:
    """The list of reasons.  Findings have links to their recorded episodes."""
    lines = [element("li", prose(cause)) for cause in report.causes]
    lines += [
        element("li", prose(finding.text), episode_links(finding, episodes, slug)) for finding in report.explanation
    ]
    lines += [element("li", prose(edit)) for edit in report.edits]
    if lines:
        yield element("h3", "Why")
        yield element("ul", *lines, class_="reasons")


def _retrained(case: ReportedCase) -> Iterator[Markup]:
    """The result of retraining the policy on the changed level."""
    retrained = case.report.retrained
    if retrained is None:
        return
    yield element("h3", "Trained anew from its policy")
    yield element("p", prose(retrained.text))
    yield element("p", f"policy: {retrained.policy}", class_="facts")
    if case.curve:
        source = f"data:image/png;base64,{base64.b64encode(case.curve).decode()}"
        picture_ = element("img", src=source, alt="Pass rate and progress over the steps of the training")
        yield element("details", element("summary", "How the training went"), picture_)


def _automaton(fspa: Fspa, drawn: Drawn, now: Traffic, before: Traffic) -> Iterator[Markup]:
    """The picture of the automaton, and notes on what it does not show."""
    if drawn.svg is not None:
        inside = picture(fspa, drawn.svg, now, before)
        yield element("div", inside, class_="scroll", tabindex=0, role="group", aria_label="Automaton")
        yield element("p", _KEY, class_="hint")
    yield from (element("p", note, class_="warning") for note in drawn.notes)


def _toggles(before: Sequence[Account]) -> Markup:
    when = [_choice("Episodes", "when", _WHEN)] if before else []
    return element("form", *when, _choice("On the map", "shown", _SHOWN), class_="toggles", autocomplete="off")


def _choice(legend: str, name: str, choices: Sequence[tuple[str, str]]) -> Markup:
    """A group of radio buttons; the first is selected."""
    labels = [
        element("label", element("input", type="radio", name=name, value=value, checked=place == 0), f" {words}")
        for place, (value, words) in enumerate(choices)
    ]
    return element("fieldset", element("legend", legend), *labels)


def _curves(case: ReportedCase) -> Iterator[Markup]:
    if case.episodes:
        caption = element(
            "figcaption", "Progress of the recorded episodes of now: green succeeded, red and dashed failed"
        )
        yield element("figure", progress_curves(case.episodes), caption)
    keys = (element("span", "now", class_="key now"), " ", element("span", "baseline", class_="key before"))
    caption = element("figcaption", "Share of episodes by their best progress: ", *(keys if case.before else keys[:1]))
    yield element("figure", progress_distribution(case.report.accounts, case.before), caption)
