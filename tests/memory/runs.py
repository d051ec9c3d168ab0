"""Random specs about the trace so far, and the comparison of a monitor with the definition."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from random import Random
from typing import Final, NamedTuple

from tests.memory.definition import Definition, formula
from tests.memory.texts import CLOCKS, DECLARATIONS, Texts, trace
from tltlc.automaton.fspa import Fspa
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.grammar import tree
from tltlc.grammar.module import Module
from tltlc.monitor.monitor import Monitor
from tltlc.pipeline import CompileOptions, Session

ALLOWED: Final = {"TLT0310", "TLT0322", "TLT0501"}
"""Errors of random specs: a comparison that is always or never true, a small maximum, too many states."""

FINAL: Final = ("satisfied", "violated")


class Case(NamedTuple):
    """A random spec: its formula, the module that declares its names, and its automaton."""

    requirement: str
    module: Module
    fspa: Fspa


def random_case(seed: int) -> Case | None:
    """Return a random spec; None if it has one of the errors that random specs may have."""
    random = Random(seed)
    clock = random.randrange(len(CLOCKS))
    requirement = Texts(random, clock).spec(random.choice((0, 1, 1, 2, 3)))
    text = f"clock {CLOCKS[clock]}\n{DECLARATIONS}\nspec s = {requirement}\n"
    # The proofs that predicates stay in their ranges take longer than everything else.
    session = Session(SourceFile("<memory>", text), CompileOptions(state_budget=300), proofs=False)
    try:
        (fspa,) = session.automata
    except TltlError as error:
        codes = {diagnostic.code for diagnostic in error.diagnostics if diagnostic.severity == "error"}
        assert codes <= ALLOWED, error
        return None
    return Case(requirement, session.module, fspa)


def random_trace(random: Random) -> list[dict[str, float]]:
    """Return a trace of 1 to 12 samples."""
    return trace(random, random.randint(1, 12))


def random_params(random: Random, fspa: Fspa) -> dict[str, float]:
    """Return values for some of the params of an automaton."""
    return {param.name: float(random.randint(1, 6)) for param in fspa.params if random.random() < 0.3}


def check_seed(seed: int, traces: int = 1) -> int:
    """Compare the monitor of a random spec with the definition, on some random traces; return their number.

    It is 0 if the spec has one of the errors that random specs may have.
    """
    case = random_case(seed)
    if case is None:
        return 0
    random = Random(seed + 1)
    for _ in range(traces):
        check_run(case, random_trace(random), random_params(random, case.fspa), random)
    return traces


def check_run(case: Case, samples: Sequence[Mapping[str, float]], params: Mapping[str, float], random: Random) -> None:
    """Compare each step of a monitor with the definition.

    The values of all atoms must be equal, a state must accept exactly the prefixes on which the formula
    holds, and a final verdict must be right for random continuations.
    """
    definition = Definition(case.module, samples, params)
    monitor = Monitor(case.fspa, params)
    requirement = formula(case.requirement)
    final: str | None = None
    for i, sample in enumerate(samples):
        step = monitor.step(sample)
        expected = tuple(definition.robustness(_formula(atom.name), i) for atom in case.fspa.atoms)
        assert monitor.values == expected, f"the atoms at sample {i}"
        holds = definition.holds(requirement, end=i + 1)
        assert step.accepting == holds, f"the formula after sample {i}"
        assert (step.verdict in ("satisfied", "holding")) == holds
        assert final in (None, step.verdict), "a final verdict stays"
        if final is None and step.verdict in FINAL:
            final = step.verdict
            _check_final(case, [*samples[: i + 1], *random_trace(random)], params, i, holds)


def _check_final(
    case: Case, samples: Sequence[Mapping[str, float]], params: Mapping[str, float], i: int, holds: bool
) -> None:
    definition, requirement = Definition(case.module, samples, params), formula(case.requirement)
    for end in range(i + 1, len(samples) + 1):
        assert definition.holds(requirement, end=end) == holds, "no continuation changes a final verdict"


@cache
def _formula(name: str) -> tree.Expr:
    return formula(name)
