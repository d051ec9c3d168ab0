"""Compare monitors of specs on a clock that varies with the definition."""

from __future__ import annotations

from functools import cache
from random import Random
from typing import Final, NamedTuple

from tests.memory.timed_definition import TimedDefinition
from tests.memory.timed_texts import DECLARATIONS, TimedTexts, TimedTrace, timed_trace
from tltlc.automaton.fspa import Fspa
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.grammar import tree
from tltlc.grammar.module import Module
from tltlc.grammar.parser import parse_formula
from tltlc.monitor.monitor import Monitor
from tltlc.pipeline import CompileOptions, Session

ALLOWED: Final = {"TLT0310", "TLT0322", "TLT0323", "TLT0501"}
"""Errors of random specs: a comparison that is always or never true, a small maximum, no timer, too many states."""

FINAL: Final = ("satisfied", "violated")


class TimedCase(NamedTuple):
    """A spec: its clauses, the module that it is in, and its automaton."""

    clauses: tuple[tree.Clause, ...]
    module: Module
    fspa: Fspa


DEADLINES: Final = ("over", "lasted", "held", "late", "due", "breach", "lately", "recent", "chain", "lost")
"""The names of atoms that take the place of operators about the future."""


def timed_case(clauses: str, clock: str = "varies") -> TimedCase | None:
    """Return the spec of some clauses; None if it has one of the errors that random specs may have."""
    text = f"clock {clock}\n{DECLARATIONS}spec s {{ {clauses} }}\n"
    session = Session(SourceFile("<timed>", text), CompileOptions(state_budget=300), proofs=False)
    try:
        (fspa,) = session.automata
    except TltlError as error:
        codes = {diagnostic.code for diagnostic in error.diagnostics if diagnostic.severity == "error"}
        assert codes <= ALLOWED, (clauses, error)
        return None
    (spec,) = (declared for declared in session.module.declarations if isinstance(declared, tree.SpecDecl))
    return TimedCase(spec.clauses, session.module, fspa)


def check_timed_seed(seed: int, traces: int = 1) -> int:
    """Compare the monitor of a random spec with the definition, on some random traces; return their number.

    It is 0 if the spec has one of the errors that random specs may have.
    """
    random = Random(seed)
    clauses = TimedTexts(random).clauses()
    case = timed_case(clauses)
    if case is None:
        return 0
    monitor = Monitor(case.fspa)
    for _ in range(traces):
        check_timed_run(case, timed_trace(random, random.randint(1, 10)), random, monitor)
    return traces


def check_timed_run(
    case: TimedCase, trace: TimedTrace, random: Random, monitor: Monitor | None = None, *, exclusive: bool = False
) -> None:
    """Compare each step of a monitor, which is reset, with the definition.

    The values of the atoms about the trace so far must be equal, a state must accept exactly the
    prefixes that meet the spec, and no continuation that is tried contradicts a final verdict. If
    ``exclusive``, p and q do not hold together.
    """
    definition = TimedDefinition(case.module, *trace, {})
    monitor = monitor or Monitor(case.fspa)
    monitor.reset()
    final: str | None = None
    for i, (sample, length_s) in enumerate(zip(*trace, strict=True)):
        where = (case.fspa.formula, i, trace)
        step = monitor.step(sample, length_s)
        for atom, value in zip(case.fspa.atoms, monitor.values, strict=True):
            assert -1.0 <= value <= 1.0, where
            about_past = past_formula(atom.name)
            if about_past is not None:
                expected = definition.robustness(about_past, i)
                assert value == expected, (atom.name, value, expected, *where)
        holds = all(definition.clause_holds(clause, i + 1) for clause in case.clauses)
        assert step.accepting == holds, where
        assert (step.verdict in ("satisfied", "holding")) == holds, where
        assert final in (None, step.verdict), "a final verdict stays"
        if final is None and step.verdict in FINAL:
            final = step.verdict
            _check_final(case, TimedTrace(trace.samples[: i + 1], trace.lengths_s[: i + 1]), holds, random, exclusive)


def _check_final(case: TimedCase, trace: TimedTrace, holds: bool, random: Random, exclusive: bool) -> None:
    for _ in range(3):
        more = timed_trace(random, random.randint(1, 8), exclusive=exclusive)
        samples, lengths_s = [*trace.samples, *more.samples], [*trace.lengths_s, *more.lengths_s]
        definition = TimedDefinition(case.module, samples, lengths_s, {})
        for end in range(len(trace.samples), len(samples) + 1):
            met = all(definition.clause_holds(clause, end) for clause in case.clauses)
            assert met == holds, (case.fspa.formula, "a continuation changes a final verdict", samples, lengths_s, end)


@cache
def past_formula(name: str) -> tree.Expr | None:
    """Return the formula that an atom about the trace so far stands for; None if a deadline is in it."""
    if any(f"{word}(" in name for word in DEADLINES):
        return None
    expr, diagnostics = parse_formula(SourceFile("<formula>", name))
    assert expr is not None and not diagnostics, name
    return expr
