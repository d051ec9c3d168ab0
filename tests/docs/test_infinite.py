"""The programs on the page on semantics, and its examples over infinite traces."""

from __future__ import annotations

from itertools import pairwise

import pytest

import tltlc
from tests.docs.blocks import DOCS, blocks
from tltlc.automaton.fspa import Fspa
from tltlc.monitor import Monitor
from tltlc.monitor.monitor import Step

A, B, NONE = (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)
"""Values of the atoms a and b."""


def compile_spec(formula: str, clauses: str = "semantics infinite") -> Fspa:
    (fspa,) = tltlc.compile_text(f"signal a: bool signal b: bool spec s {{ {clauses} require {formula} }}")
    return fspa


def after(fspa: Fspa, *samples: tuple[float, float]) -> Step:
    monitor = Monitor(fspa)
    return [monitor.step_atoms(sample[: len(fspa.atoms)]) for sample in samples][-1]


@pytest.mark.parametrize("formula", ["G a", "G F a", "F G a", "G(a -> F b)"])
def test_every_state_but_traps_is_a_goal(formula: str) -> None:
    fspa = compile_spec(formula)
    assert {state.verdict for state in fspa.states} <= {"holding", "violated"}
    assert all(state.accepting == (state.verdict == "holding") for state in fspa.states)
    assert (fspa.spec_size, fspa.judge) == (0, "limit")


def test_over_finite_traces_recurrence_depends_on_the_last_sample() -> None:
    assert [after(compile_spec("G F a", ""), *trace).accepting for trace in ((A, NONE), (NONE, A))] == [False, True]
    assert [after(compile_spec("F G a", ""), *trace).accepting for trace in ((A, NONE), (NONE, A))] == [False, True]


def test_obligations_are_in_the_label_and_bounds_can_be_broken() -> None:
    step = after(compile_spec("G(a -> F b)"), A, *[NONE] * 20)
    assert (step.verdict, step.accepting, step.label) == ("holding", True, "G(a -> F b) & F b")
    bounded = compile_spec("G(a -> F[0,9] b)")
    assert [after(bounded, A, *[NONE] * rest).verdict for rest in (8, 9)] == ["holding", "violated"]


def test_two_states_may_have_one_label_and_two_edges_their_states() -> None:
    fspa = compile_spec("G F a & G F b")
    assert [str(state.label) for state in fspa.states] == ["G F a & G F b"] * 2
    ends = [(edge.source, edge.target) for edge in compile_spec("G F a").edges]
    assert ends == [(0, 0), (0, 0)]


def test_the_automaton_decides_when_a_spec_is_judged() -> None:
    assert [compile_spec("a & G b", clauses).judge for clauses in ("", "semantics infinite")] == ["limit", "goal"]
    assert after(compile_spec("a & G b"), (1.0, 1.0)).done
    assert not after(compile_spec("a & G b", "semantics infinite judge at limit"), (1.0, 1.0)).done


def test_progress_is_the_share_of_the_limit_that_was_survived() -> None:
    assert after(compile_spec("G F a", "semantics infinite limit 4 steps"), A, NONE).progress == 0.5
    assert after(compile_spec("G F a"), A, NONE).progress == 0.0
    assert after(compile_spec("a W b", "semantics infinite"), B).progress == 1.0


@pytest.mark.parametrize("imported", ["tltlc.monitor", "tltlc.automaton.compare"])
def test_the_programs_on_the_page_print_the_shown_output(imported: str, capsys: pytest.CaptureFixture[str]) -> None:
    block_pairs = pairwise(blocks(DOCS / "semantics.md"))
    ((program, printed),) = (
        (block, after) for block, after in block_pairs if block.kind == "python" and f"from {imported} " in block.text
    )
    exec(program.text, {})
    assert capsys.readouterr().out == printed.text
