"""Tools that read specs with memory: none fails, and what they show is what a monitor does, on random specs."""

from __future__ import annotations

from random import Random

from hypothesis import given
from hypothesis import strategies as st

from tests.fuzzing import times
from tests.memory.runs import random_case, random_trace
from tltlc.core.source import SourceFile
from tltlc.monitor import Monitor
from tltlc.pipeline import CompileOptions, Session
from tltlc.tools.diff.pairs import diff
from tltlc.tools.explain.explanation import explain
from tltlc.tools.explain.text import text
from tltlc.tools.fmt import STYLES, format_text
from tltlc.tools.judge.clauses import clauses_of
from tltlc.tools.judge.judge import Judge
from tltlc.tools.lint.run import lint
from tltlc.tools.witness.blocks import BlockWriter
from tltlc.tools.witness.cover import cover
from tltlc.tools.witness.text import as_csv, as_test
from tltlc.tools.witness.transitions import Moves

SEEDS = st.integers(0, 2**32)


@times(40)
@given(SEEDS)
def test_traces_explanations_and_comparisons_agree_with_the_monitor(seed: int) -> None:
    case = random_case(seed)
    if case is None or case.fspa.semantics == "infinite":
        return
    fspa = case.fspa
    assert text(explain(fspa))
    blocks = BlockWriter(fspa)
    for witness in cover(Moves(fspa)).traces:
        # Both run the monitor, and fail if it takes other states.
        as_csv(fspa, witness)
        as_test(fspa, witness, "t", blocks)
    assert diff(fspa, fspa, feasible_only=True).comparison.relation == "equivalent"


@times(40)
@given(SEEDS)
def test_a_spec_is_judged_and_formatted(seed: int) -> None:
    case = random_case(seed)
    if case is None:
        return
    source = case.module.source
    session = _session(source)
    for style in STYLES:
        formatted = _session(source.with_text(format_text(source.text, style))).automata
        assert formatted == session.automata
    samples = random_trace(Random(seed))
    verdict = Judge(case.fspa, clauses_of(case.fspa, session.program.specs[0]), details=True).verdict(samples)
    monitor = Monitor(case.fspa)
    steps = [monitor.step(sample) for sample in samples]
    assert (verdict.outcome.accepted, verdict.outcome.verdict) == (steps[-1].accepting, steps[-1].verdict)


@times(10)
@given(SEEDS)
def test_a_spec_is_linted(seed: int) -> None:
    case = random_case(seed)
    if case is not None:
        lint(case.module.source)


def _session(source: SourceFile) -> Session:
    # As for random specs, without the slow proofs that predicates stay in their ranges.
    return Session(source, CompileOptions(state_budget=300), proofs=False)
