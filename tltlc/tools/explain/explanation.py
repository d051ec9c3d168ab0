"""The explanation of a spec, as data.

All output formats of ``tltlc explain`` are written from it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

from tltlc.automaton.fspa import Fspa, Guard, Implicant, Text
from tltlc.automaton.memory import given_atoms
from tltlc.automaton.memory_phrases import Speaker, spoken
from tltlc.automaton.register_phrases import register_phrases, start_phrase
from tltlc.automaton.text import formula_text, label_range_text, label_text, times_of
from tltlc.automaton.work import OutOfWork
from tltlc.backends.drawing.folding import fold_runs
from tltlc.core.record import record
from tltlc.logic.formula import TRUE, Formula, and_, atom, not_, or_, rebuild
from tltlc.logic.text.outline import Outline, outline
from tltlc.logic.text.phrases import phrase
from tltlc.resolve.registers import SATURATING, following_atoms
from tltlc.resolve.sources import sources
from tltlc.tools.explain.boundaries import boundaries
from tltlc.tools.explain.ending import ending
from tltlc.tools.explain.next_steps import edges_leading_on
from tltlc.tools.witness.step_lengths import length_of
from tltlc.tools.witness.traces import Witness, accepting_trace, rejecting_trace
from tltlc.tools.witness.transitions import Moves, SampledEdge

ANYTHING: Final = "anything"
"""What texts say for a condition that is always true."""
_MOST_WORK: Final = 2_000_000
"""The most steps of work in the search for an infinite trace."""


@record
class NextStep:
    """An edge towards the goal: its condition in words (``when``), and the state to which it leads."""

    when: str
    state: int


@record
class StateRow:
    """A state of the automaton. ``remains`` says what remains to be satisfied.

    ``distance`` is the least number of steps to an accepting state; it is None in a trap. ``leads``
    has the edges from this state that make progress towards the goal, as
    :func:`~tltlc.tools.explain.next_steps.edges_leading_on` finds them.
    """

    id: int
    remains: str
    verdict: str
    distance: int | None
    leads: tuple[NextStep, ...]


@record
class CountingRun:
    """States that differ only in a count, such as the steps that are left of a bound. Each leads to the next.

    ``remains`` says what remains to be satisfied in these states. It has a range in place of the
    count.
    """

    states: tuple[int, ...]
    remains: str


@record
class TrapCondition:
    """A condition on one step that breaks the spec for good in some ``states``.

    ``when`` is the condition in words. ``everywhere`` is true if the condition does so in every
    state whose verdict is not final yet, that is, neither satisfied nor violated.
    """

    when: str
    states: tuple[int, ...]
    everywhere: bool


@record
class TraceStep:
    """One or more consecutive steps of a trace with the same condition.

    ``times`` is the number of steps, ``what`` the condition in words, and ``state`` the state after
    the last step. ``seconds`` is the time that they take, from the step before on, if the clock varies.
    """

    times: int
    what: str
    state: int
    seconds: float | None = None


@record
class ExampleTrace:
    """A trace that succeeds or fails.

    ``cycle`` is the index of the first step that repeats for ever, or None for a finite trace.
    """

    steps: tuple[TraceStep, ...]
    cycle: int | None


@record
class Remembered:
    """A value of the trace so far that the monitor keeps: the ``name`` of its register, and ``words`` for it.

    ``start`` says what it is at the first step, before its event, or otherwise where a reader may expect
    something else; it is empty if nothing needs to be said. ``maximum`` is where a count or a time stops,
    in ``unit``: ``steps``, an SI unit, or empty for a plain number. It is None for values that do not stop.
    """

    name: str
    words: str
    start: str
    unit: str
    maximum: float | None


@record
class Explanation:
    """A spec in words. The fields are those of the JSON of ``tltlc explain --format json``.

    ``outline`` has the goals and rules of the formula. It is None if the automaton comes from
    another tool and has no formula. ``exclusive`` lists groups of atoms of which at most one holds
    at a time. ``counting`` lists the runs of states that differ only in a count.
    ``judge`` is ``goal`` or ``limit``, and ``ending`` says what that means for this spec.

    ``boundaries`` says what counts at the edges: at the same step, at the first step, where play ends.

    ``memory`` lists the values of the trace so far that the atoms read.

    ``succeed`` is a trace that succeeds, and ``fail`` one that fails. They are None if there is no
    such trace, or if the search found none. Over finite traces and without ``memory``, both are as
    short as possible. Over finite traces, ``fail`` ends where success is no longer possible.
    """

    name: str
    doc: str
    formula: str
    english: str
    semantics: str
    level: str | None
    outline: Outline | None
    exclusive: tuple[tuple[str, ...], ...]
    boundaries: tuple[str, ...]
    memory: tuple[Remembered, ...]
    failures: tuple[TrapCondition, ...]
    judge: str
    ending: str
    limit_steps: int | None
    limit_s: float | None
    spec_size: int
    states: tuple[StateRow, ...]
    counting: tuple[CountingRun, ...]
    succeed: ExampleTrace | None
    fail: ExampleTrace | None


def explain(fspa: Fspa) -> Explanation:
    """Return the explanation of the spec that an automaton was built from."""
    formula = fspa.formula
    guards = _guards(fspa)
    moves = Moves(fspa)
    limit_s = None if None in (fspa.limit_steps, fspa.clock_s) else (fspa.limit_steps or 0) * (fspa.clock_s or 0.0)
    return Explanation(
        name=fspa.name,
        doc=fspa.doc,
        formula=str(fspa.formula),
        english=formula_text(fspa),
        semantics=fspa.semantics,
        level=fspa.level,
        outline=_outline(fspa, formula) if isinstance(formula, Formula) else None,
        exclusive=tuple(tuple(fspa.atoms[index].name for index in group) for group in fspa.exclusive),
        boundaries=boundaries(fspa),
        memory=_memory(fspa),
        failures=_failures(fspa, guards),
        judge=fspa.judge,
        ending=ending(fspa),
        limit_steps=fspa.limit_steps,
        limit_s=limit_s,
        spec_size=fspa.spec_size,
        states=_states(fspa, guards),
        counting=_counting_runs(fspa),
        succeed=_example_trace(fspa, _witness(moves, accept=True)),
        fail=_example_trace(fspa, _witness(moves, accept=False)),
    )


def _memory(fspa: Fspa) -> tuple[Remembered, ...]:
    """Return what the monitor remembers, without registers that only serve others or forget at once."""
    words = register_phrases(fspa)
    return tuple(
        Remembered(
            register.name,
            words[register.name],
            start_phrase(register),
            register.unit,
            register.high if register.kind in SATURATING else None,
        )
        for register in fspa.registers
        if register.kind not in ("last", "first", "breach", "begun")
    )


def _outline(fspa: Fspa, formula: Formula) -> Outline:
    formula, endless = spoken(formula, fspa), fspa.semantics == "infinite"
    if endless:
        from tltlc.automaton.infinite.readback import without_constants

        formula = without_constants(formula)
    return outline(formula, endless=endless, counts=times_of(fspa))


def _guards(fspa: Fspa) -> tuple[Formula, ...]:
    """Return the guard of each edge as a formula for people."""
    formulas = (_formula(fspa, edge.guard) for edge in fspa.edges)
    return tuple(map(Speaker(fspa).spoken, formulas) if fspa.registers else formulas)


def _formula(fspa: Fspa, guard: Guard) -> Formula:
    if isinstance(guard.formula, Text):
        return or_(*(_literals(fspa, prime) for prime in guard.primes))
    return guard.formula


def _literals(fspa: Fspa, implicant: Implicant) -> Formula:
    """Return the literals of an implicant as a conjunction; ``true`` if there are none."""
    literals = [(atom(fspa.atoms[index].name), holds) for index, holds in implicant]
    return and_(*(literal if holds else not_(literal) for literal, holds in literals))


def _condition_text(state: Formula) -> str:
    """Return a formula about a single step, such as the guard of an edge, in words."""
    return ANYTHING if state is TRUE else phrase(_positive_first(state))


def _positive_first(state: Formula) -> Formula:
    """Return a guard, or part of a guard, with atoms before negated atoms: ``b & !a`` for ``!a & b``."""
    if state.op not in ("and", "or"):
        return state
    parts = (_positive_first(part) for part in state.args)
    return rebuild(state, tuple(sorted(parts, key=lambda part: part.op == "not")))


def _states(fspa: Fspa, guards: tuple[Formula, ...]) -> tuple[StateRow, ...]:
    leads: dict[int, dict[NextStep, None]] = {}
    for index in edges_leading_on(fspa):
        edge = fspa.edges[index]
        leads.setdefault(edge.source, {})[NextStep(_condition_text(guards[index]), edge.target)] = None
    return tuple(
        StateRow(state.id, label_text(fspa, state.id), state.verdict, state.distance, tuple(leads.get(state.id, ())))
        for state in fspa.states
    )


def _counting_runs(fspa: Fspa) -> tuple[CountingRun, ...]:
    return tuple(
        CountingRun(tuple(state.id for state in run), label_range_text(fspa, run[0].id, run[-1].id))
        for run in fold_runs(fspa).folded.values()
    )


def _failures(fspa: Fspa, guards: tuple[Formula, ...]) -> tuple[TrapCondition, ...]:
    """Return the conditions that lead into a trap, one entry for each condition.

    ``guards`` has the guard of each edge as a formula. Conditions that lead into a trap from every
    state whose verdict is not final come first.
    """
    violated = {state.id for state in fspa.states if state.verdict == "violated"}
    undecided = {state.id for state in fspa.states if state.verdict in ("pending", "holding")}
    sources: dict[str, dict[int, None]] = {}
    for edge, guard in zip(fspa.edges, guards, strict=True):
        if edge.source not in violated and edge.target in violated:
            for reason in guard.args if guard.op == "or" else (guard,):
                sources.setdefault(_condition_text(reason), {})[edge.source] = None
    failures = [TrapCondition(when, tuple(states), set(states) == undecided) for when, states in sources.items()]
    return tuple(sorted(failures, key=lambda failure: (not failure.everywhere, failure.states)))


def _witness(moves: Moves, accept: bool) -> Witness | None:
    """Return a trace that succeeds if ``accept`` is true, else a trace that fails; None if none is found.

    A finite trace counts as a failure only if it ends in a violated state.
    """
    try:
        witness = accepting_trace(moves, _MOST_WORK) if accept else rejecting_trace(moves, _MOST_WORK)
    except OutOfWork:
        return None
    if witness is None or accept or witness.cycle is not None:
        return witness
    edge = moves.fspa.edges[witness.moves[-1].edge]
    return witness if moves.fspa.states[edge.target].verdict == "violated" else None


def _example_trace(fspa: Fspa, witness: Witness | None) -> ExampleTrace | None:
    """Describe the steps of a trace in words; return None if ``witness`` is None.

    Consecutive steps with the same condition are merged.
    """
    if witness is None:
        return None
    steps: list[TraceStep] = []
    cycle: int | None = None
    origins = _origins(fspa)
    for index, move in enumerate(witness.moves):
        literals = spoken(_literals(fspa, _shown(fspa, move, origins)), fspa)
        condition, state = _condition_text(literals), fspa.edges[move.edge].target
        # At the first step, the length counts for nothing.
        seconds = length_of(move.letter, fspa) if index or not fspa.clock_varies else 0.0
        if index == witness.cycle:
            cycle = len(steps)
        elif steps and steps[-1].what == condition:
            before = steps[-1].seconds
            total = None if seconds is None or before is None else before + seconds
            steps[-1] = TraceStep(steps[-1].times + 1, condition, state, total)
            continue
        steps.append(TraceStep(1, condition, state, seconds))
    return ExampleTrace(tuple(steps), cycle)


def _origins(fspa: Fspa) -> dict[str, tuple[str, ...]]:
    """Map the name of each atom that follows from others to the names of those."""
    derived = following_atoms(fspa.atoms, fspa.registers)
    return {item.name: sources(item.name, fspa.atoms, fspa.registers) for item in fspa.atoms if item.name in derived}


def _shown(fspa: Fspa, move: SampledEdge, origins: Mapping[str, Sequence[str]]) -> Implicant:
    """Return the literals of a step that a text shows: those that its edge needs.

    With registers, literals of the atoms from which an atom follows, its ``origins``, replace that atom. All
    atoms that hold and do not follow from others are shown.
    """
    if not fspa.registers:
        return move.prime
    names = {fspa.atoms[atom].name for atom, _ in move.prime}
    names.update(*(origins.get(name, ()) for name in tuple(names)))
    needed = {index for index, item in enumerate(fspa.atoms) if item.name in names}
    literals = ((atom, fspa.atoms[atom].name in move.letter) for atom in given_atoms(fspa))
    return tuple((atom, holds) for atom, holds in literals if holds or atom in needed)
