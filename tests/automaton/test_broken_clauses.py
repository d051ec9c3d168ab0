"""Compare the clause that is named for a failing trace with one automaton for each clause."""

from __future__ import annotations

from itertools import count
from random import Random

import pytest

from tltlc import TltlError, compile_text
from tltlc.automaton import broken_clauses
from tltlc.automaton.fspa import BrokenClause, Fspa
from tltlc.core.source import SourceFile
from tltlc.monitor import Monitor
from tltlc.pipeline import Session
from tltlc.resolve.spec import Spec
from tltlc.tools.judge.clauses import clauses_of

ATOMS = "abcd"


def random_formula(rng: Random, depth: int) -> str:
    if depth == 0 or rng.random() < 0.2:
        return rng.choice(("", "not ")) + rng.choice(ATOMS)
    inner = random_formula(rng, depth - 1)
    op = rng.choice(("and", "or", "implies", "until", "weak_until", "eventually", "always", "next", "within"))
    if op in ("eventually", "always", "next"):
        return f"({op} {inner})"
    if op == "within":
        return f"(eventually within {rng.randint(1, 3)} steps {inner})"
    return f"({inner} {op} {random_formula(rng, depth - 1)})"


def random_clause(rng: Random) -> str:
    kind = rng.choice(("keep", "avoid", "reach", "then", "answer", "require"))
    if kind == "then":
        return f"reach {random_formula(rng, 1)} then {random_formula(rng, 1)}"
    if kind == "answer":
        return f"keep {rng.choice(ATOMS)} implies eventually within 2 steps {rng.choice(ATOMS)}"
    return f"{kind} {random_formula(rng, 2 if kind == 'require' else 0)}"


def random_specs(rng: Random, *, infinite: bool) -> list[tuple[Spec, Fspa]]:
    """Return some specs of two to four clauses that some trace can meet, with their automata."""
    found: list[tuple[Spec, Fspa]] = []
    while len(found) < (10 if infinite else 60):
        lines = [*(f"signal {atom}: bool" for atom in ATOMS), *(["exclusive a, b"] if rng.random() < 0.3 else [])]
        clauses = [random_clause(rng) for _ in range(rng.randint(2, 4))]
        lines += ["spec s {", *(["semantics infinite"] if infinite else []), *clauses, "}"]
        session = Session(SourceFile("s.tltl", "\n".join(lines)))
        try:
            (fspa,) = session.automata
        except TltlError:
            continue
        if fspa.states[0].verdict != "violated":
            found.append((session.specs[0], fspa))
    return found


def random_sample(rng: Random, fspa: Fspa) -> dict[str, float]:
    holds = {atom: rng.random() < 0.4 for atom in ATOMS}
    if fspa.exclusive and holds["a"]:
        holds["b"] = False
    return {signal.name: float(holds[signal.name]) for signal in fspa.signals}


def broken_by(trace: list[dict[str, float]], clause: Fspa) -> bool:
    monitor = Monitor(clause)
    for sample in trace:
        monitor.step(sample)
    return monitor.failure is not None


@pytest.mark.parametrize("infinite", [False, True])
@pytest.mark.parametrize("seed", range(3))
def test_the_clause_that_a_trace_breaks_is_broken_by_it(seed: int, infinite: bool) -> None:
    rng, failures, named = Random(seed), 0, 0
    for spec, fspa in random_specs(rng, infinite=infinite):
        parts = clauses_of(fspa, spec).parts
        assert fspa.clauses == tuple(part.text for part in parts)
        for _ in range(5):
            monitor, trace = Monitor(fspa), list[dict[str, float]]()
            for number in range(1, 9):
                trace.append(random_sample(rng, fspa))
                step = monitor.step(trace[-1])
                assert step.failed_step in (None, number)
                if monitor.failure is not None:
                    break
            if monitor.failure is None or monitor.failure.cause is None:
                continue
            failures += 1
            broken = [index for index, part in enumerate(parts) if broken_by(trace, part.fspa)]
            clause = monitor.failure.cause.clause
            named += clause is not None
            assert clause is None or clause in broken
            # Where a state does not tell which clause is broken, no clause is named. That is rare.
            assert clause is not None or not broken or failures > 10 * (failures - named)
    assert failures > 20


def test_the_first_of_two_broken_clauses_is_named() -> None:
    (fspa,) = compile_text("signal a: bool  signal b: bool\nspec s { avoid a  avoid b  reach not a and not b }")
    (edge,) = (edge for edge in fspa.edges if edge.broken)
    assert edge.broken == (BrokenClause(0, (((0, True),),)), BrokenClause(1, (((1, True),),)))
    step = Monitor(fspa).step({"a": True, "b": True})
    assert (step.failed_clause, step.failed_atom, step.failed_step) == ("avoid a", "a", 1)


def test_clauses_that_fail_only_together_are_not_named() -> None:
    (fspa,) = compile_text("signal a: bool  signal b: bool\nspec s { reach a  keep b implies always not a }")
    step = Monitor(fspa).step({"a": False, "b": True})
    assert (step.failed_clause, step.failed_atom, step.failed_step) == (None, "b", 1)


def test_a_spec_of_one_clause_needs_no_conditions_of_its_own() -> None:
    (fspa,) = compile_text("signal a: bool\nspec s { avoid a }")
    (edge,) = (edge for edge in fspa.edges if edge.broken)
    assert edge.broken == (BrokenClause(0, edge.guard.primes),)


def test_a_clause_whose_automaton_is_too_large_is_never_named() -> None:
    from tltlc.automaton.broken_clauses import with_broken_clauses

    text = "signal a: bool  signal b: bool\nspec s { require always for 40 steps a  avoid b }"
    session = Session(SourceFile("s.tltl", text))
    (fspa,) = session.automata
    small = with_broken_clauses(fspa, session.specs[0], state_budget=10)
    assert {broken.clause for edge in small.edges for broken in edge.broken} == {1}


def test_a_trace_of_a_spec_that_none_meets_fails_at_its_first_step() -> None:
    (fspa,) = compile_text("signal a: bool\nspec s { reach a  avoid a }")
    monitor = Monitor(fspa)
    numbers = count(1)
    steps = [monitor.step({"a": next(numbers) == 2}) for _ in range(3)]
    assert {(step.failed_clause, step.failed_atom, step.failed_step) for step in steps} == {(None, None, 1)}


def test_no_clause_is_named_if_the_search_is_too_long(monkeypatch: pytest.MonkeyPatch) -> None:
    """Less than all traces would name clauses that are not broken."""
    lines = [f"signal {name}: bool" for name in ("a", "b", "g0", "g1", "g2", "g3")]
    text = "\n".join([*lines, "spec s {", "avoid a", "avoid b", *(f"reach g{number}" for number in range(4)), "}"])
    (whole,) = compile_text(text)
    assert any(edge.broken for edge in whole.edges)
    monkeypatch.setattr(broken_clauses, "_LEAST_STEPS", 20)
    monkeypatch.setattr(broken_clauses, "_STEPS_PER_EDGE", 0)
    (cut,) = compile_text(text)
    assert cut.clauses == whole.clauses
    assert not any(edge.broken for edge in cut.edges)
