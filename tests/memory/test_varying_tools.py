"""Tools that read specs on a clock that varies: none fails, and formatting and judging keep what specs mean."""

from __future__ import annotations

from random import Random

from hypothesis import given

from tests.fuzzing import SEEDS, times
from tests.interfaces.lsp.texts import open_text
from tests.memory.timed_runs import timed_case
from tests.memory.timed_texts import TimedTexts, timed_trace
from tltlc.core.source import SourceFile
from tltlc.interfaces.lsp.hover import hover
from tltlc.monitor import Monitor
from tltlc.monitor.samples import STEP_LENGTH
from tltlc.pipeline import CompileOptions, Session
from tltlc.tools.explain.explanation import explain
from tltlc.tools.explain.text import text
from tltlc.tools.fmt import STYLES, format_text
from tltlc.tools.judge.clauses import clauses_of
from tltlc.tools.judge.judge import Judge
from tltlc.tools.lint.run import lint


@times(40)
@given(SEEDS)
def test_a_spec_is_explained_judged_and_formatted(seed: int) -> None:
    random = Random(seed)
    case = timed_case(TimedTexts(random).clauses())
    if case is None:
        return
    assert text(explain(case.fspa))
    source = case.module.source
    session = _session(source)
    for style in STYLES:
        formatted = _session(source.with_text(format_text(source.text, style))).automata
        assert formatted == session.automata
    trace = timed_trace(random, 8)
    samples = [{**sample, STEP_LENGTH: length_s} for sample, length_s in zip(*trace, strict=True)]
    verdict = Judge(case.fspa, clauses_of(case.fspa, session.program.specs[0]), details=True).verdict(samples)
    monitor = Monitor(case.fspa)
    steps = [monitor.step(sample, length_s) for sample, length_s in zip(*trace, strict=True)]
    assert (verdict.outcome.accepted, verdict.outcome.verdict) == (steps[-1].accepting, steps[-1].verdict)


@times(15)
@given(SEEDS)
def test_a_spec_is_linted(seed: int) -> None:
    case = timed_case(TimedTexts(Random(seed)).clauses())
    if case is not None:
        lint(case.module.source)


def test_a_goal_with_a_bound_is_linted() -> None:
    case = timed_case(
        "require eventually within 0.3 s ((q iff q) then (eventually (r and eventually within 0.25 s p))) "
        "or always for 0.1 s (once within 0.3 s q)"
    )
    assert case is not None
    lint(case.module.source)


def test_an_editor_shows_what_has_a_bound() -> None:
    source = (
        "clock varies\nsignal a: bool\nlet soon = eventually within 2 s a\nspec s { keep a implies eventually soon }"
    )
    for place in ("soon =", "soon }", "keep", "eventually within", "eventually soon"):
        document, offset, _ = open_text(source.replace(place, "¦" + place, 1))
        shown = hover(document, offset, None, "utf-16")
        # An operator of its own has no timer, so nothing is said about it.
        assert (shown is None) == place.startswith("eventually")


def _session(source: SourceFile) -> Session:
    return Session(source, CompileOptions(state_budget=300), proofs=False)
