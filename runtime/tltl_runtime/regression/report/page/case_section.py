"""The section of a case: reasons, automaton, map, playback of recorded episodes, and curves."""

from __future__ import annotations

import base64
from collections.abc import Iterator, Sequence
from typing import Literal

from markupsafe import Markup

from tltl_runtime.regression.explain.explain import Finding
from tltl_runtime.regression.report.case_report import CaseReport, new_failure_text
from tltl_runtime.regression.report.page.automaton import AutomatonPicture, counts_table, label_texts, picture
from tltl_runtime.regression.report.page.case_maps import case_maps
from tltl_runtime.regression.report.page.contents import NotRun, ReportedCase, maps_of
from tltl_runtime.regression.report.page.curves import progress_curves, progress_distribution
from tltl_runtime.regression.report.page.episode_links import episode_links, trace_links
from tltl_runtime.regression.report.page.missing_map import missing_map_text
from tltl_runtime.regression.report.page.player_panel import player_panel
from tltl_runtime.regression.report.page.render import render
from tltl_runtime.regression.report.page.trace_charts import trace_charts
from tltl_runtime.regression.report.page.traffic import Traffic, traffic
from tltl_runtime.regression.report.reason_order import ReasonKind
from tltlc.api import Fspa, formula_text, record


@record
class _Reason:
    """A reason for the verdict: a sentence, and links to example episodes or traces on the page.

    ``symbols`` is the sentence with its formula in symbols. ``kind`` is the CSS class of the sentence.
    ``links`` is None if the page shows no example.
    """

    text: str
    symbols: str
    kind: ReasonKind | Literal["new"]
    links: Markup | None = None


@record
class _Drawings:
    """The pictures and tables in the section of a case with an automaton.

    - ``automaton`` is the picture of the automaton, in words and in symbols, or None if it could not be
      laid out; ``notes`` say what it does not show. ``has_symbols`` says whether symbols differ from words.
    - ``maps`` are the maps of the level, or None.
    - ``player`` is the panel that plays recorded episodes on the map, or None if there is no map.
    - ``charts`` are pictures of recorded traces, or of recorded episodes without a map, or None.
    - ``curves`` shows the progress of the recorded episodes, or is None without recordings.
    - ``distribution`` shows how progress is distributed over all episodes.
    - ``table`` says how many episodes visited each state and failed in it.
    """

    automaton: Markup | None
    notes: tuple[str, ...]
    maps: Markup | None
    player: Markup | None
    charts: Markup | None
    curves: Markup | None
    distribution: Markup
    table: Markup
    has_symbols: bool


def case_section(case: ReportedCase, slug: str, automaton: AutomatonPicture | None) -> Markup:
    """Return the section of a judged case as HTML.

    ``slug`` is the case's short name in addresses within the page, such as ``navigation-v1``.
    ``automaton`` is the picture of the case's automaton. It is None for a case that could not be
    judged; the section then has only texts.
    """
    return render(
        "case_section.html",
        slug=slug,
        report=case.report,
        facts=_facts(case.report),
        goal=None if case.fspa is None else _goal_texts(case.fspa, case.clauses),
        is_new_failure=case.report.has_new_failure,
        reasons=tuple(_reasons(case, slug)),
        curve=base64.b64encode(case.curve).decode(),
        has_baseline=bool(case.before),
        drawings=_drawings(case, slug, automaton),
        film_notes=case.film_notes,
        no_map=missing_map_text(case),
        noun="traces" if case.report.traces else "episodes",
    )


def _goal_texts(fspa: Fspa, clauses: Sequence[str]) -> tuple[str, str]:
    """Return what a spec asks for, in words and in symbols.

    The words are the clauses as the author wrote them; if they are unknown, a sentence.
    """
    words = ", ".join(f"`{clause}`" for clause in clauses) or formula_text(fspa)
    return words, f"`{formula_text(fspa, 'unicode')}`"


def not_run_section(case: NotRun, slug: str) -> Markup:
    """Return, as HTML, the section of a case that was not judged in this run, with the reason."""
    return render("not_run_section.html", case=case, slug=slug)


def _facts(report: CaseReport) -> list[str]:
    if report.traces:
        now, before = report.traces.now, report.traces.before
        return [
            f"{_traces_text(len(now.names))} of {now.place}",
            f"compared with {_traces_text(len(before.names))} of {before.place}",
            f"spec {report.traces.spec}",
        ]
    facts = [f"{report.level} {report.variant}"]
    if report.reference:
        facts.append(f"compared with {report.reference.variant}")
    if report.played:
        facts.append(f"spec {report.played.spec}")
    if report.figures and not report.certain:
        facts.append("not certain, though all of its episodes were played")
    return facts


def _traces_text(count: int) -> str:
    return f"{count} recorded trace{'s' * (count != 1)}"


def _reasons(case: ReportedCase, slug: str) -> Iterator[_Reason]:
    """Yield the reasons for the verdict in their order, with links to examples.

    Before them, yield the new failures of a case that passes; leave out the reasons that repeat them.
    """
    report = case.report
    new = report.new_failures if report.has_new_failure else ()
    for finding in new:
        text = new_failure_text(finding)
        yield _Reason(text, text, "new", _links(finding, case, slug))
    shown = {finding.short for finding in new if finding.short}
    for reason in report.ordered_reasons:
        if reason.short in shown:
            continue
        symbols = (reason.finding.symbols if reason.finding else "") or reason.text
        links = _links(reason.finding, case, slug) if reason.finding else None
        yield _Reason(reason.text, symbols, reason.kind, links)


def _links(finding: Finding, case: ReportedCase, slug: str) -> Markup | None:
    links = episode_links(finding, case.episodes, slug) if maps_of(case) else None
    return links or trace_links(finding, case.curves, slug)


def _drawings(case: ReportedCase, slug: str, automaton: AutomatonPicture | None) -> _Drawings | None:
    fspa, level, level_maps = case.fspa, case.level, maps_of(case)
    if fspa is None or automaton is None:
        return None
    noun = "traces" if case.report.traces else "episodes"
    now, before = traffic(case.report.episodes, noun), traffic(case.before, noun)
    return _Drawings(
        automaton=None if automaton.svg is None else _pictures(fspa, automaton.svg, automaton.symbols, now, before),
        notes=automaton.notes,
        maps=None if level is None or level_maps is None else case_maps(case, level, level_maps),
        player=None if level_maps is None else player_panel(fspa, case.episodes, level_maps.values),
        charts=trace_charts(fspa, case.curves, slug, case.films) if case.curves else None,
        curves=progress_curves(case.episodes) if case.episodes else None,
        distribution=progress_distribution(case.report.episodes, case.before),
        table=counts_table(fspa, now, before),
        has_symbols=any(words != symbols for words, symbols in (label_texts(fspa, state.id) for state in fspa.states)),
    )


def _pictures(fspa: Fspa, words: bytes, symbols: bytes | None, now: Traffic, before: Traffic) -> Markup:
    """Return the pictures of an automaton in words and in symbols; the switch of the page shows one of them."""
    shown = picture(fspa, words, now, before)
    if symbols is None:
        return shown
    frame = Markup('<div class="{}">{}</div>')
    return frame.format("in-words", shown) + frame.format("in-symbols", picture(fspa, symbols, now, before))
