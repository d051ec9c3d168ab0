"""The complete explanation of a spec in words.

All outputs of ``tltlc explain`` are built from it.
"""

from __future__ import annotations

from typing import Final

from tltlc.automaton.fspa import Fspa, Guard, Implicant, Text
from tltlc.automaton.text import formula_text, label_text
from tltlc.automaton.work import OutOfWork
from tltlc.backends.drawing.folding import folded
from tltlc.core.record import record
from tltlc.logic.formula import TRUE, Formula, and_, atom, not_, or_, rebuild
from tltlc.logic.text.outline import Outline, outline
from tltlc.logic.text.phrases import phrase
from tltlc.tools.explain.ending import ending
from tltlc.tools.explain.next_steps import leading_on
from tltlc.tools.witness.traces import Witness, accepting, rejecting
from tltlc.tools.witness.transitions import Moves

ANYTHING: Final = "anything"
"""The text for a step at which all samples lead to the same state."""
_MOST_WORK: Final = 2_000_000
"""The most steps that the search for an infinite trace may take here."""


@record
class Lead:
    """An edge that leads on from a state: its condition in words, and the number of its target."""

    when: str
    state: int


@record
class StateRow:
    """A state: what remains to be satisfied, its verdict, its distance, and the edges that lead on.

    The distance is None in a trap.
    """

    id: int
    remains: str
    verdict: str
    distance: int | None
    leads: tuple[Lead, ...]


@record
class TrapCondition:
    """A condition that breaks the spec for good, and the states in which it does.

    ``everywhere`` is true if it does so in every state that is not decided yet.
    """

    when: str
    states: tuple[int, ...]
    everywhere: bool


@record
class WayStep:
    """Consecutive steps with the same condition, and the state that the last of them leads to."""

    times: int
    what: str
    state: int


@record
class ExampleTrace:
    """A trace to success or failure.

    Over infinite traces, ``cycle`` is the index of the first step that repeats for ever.
    """

    steps: tuple[WayStep, ...]
    cycle: int | None


@record
class Explanation:
    """A spec in words. The fields are those of the JSON of ``tltlc explain --format json``.

    ``outline`` is None if another tool gave the automaton a name and no formula. ``exclusive`` lists
    atoms of which at most one holds at a time. ``counting`` lists runs of states, each leading to the next, that differ
    only in a count. ``judge`` is ``goal`` or ``limit``, and ``ending`` says what that means for
    this spec.

    ``succeed`` and ``fail`` are None if there is no such trace, or if none was found. Over finite
    traces both are shortest, and ``fail`` ends where success is no longer possible.
    """

    name: str
    doc: str
    formula: str
    english: str
    semantics: str
    level: str | None
    outline: Outline | None
    exclusive: tuple[tuple[str, ...], ...]
    failures: tuple[TrapCondition, ...]
    judge: str
    ending: str
    limit_steps: int | None
    limit_s: float | None
    spec_size: int
    states: tuple[StateRow, ...]
    counting: tuple[tuple[int, ...], ...]
    succeed: ExampleTrace | None
    fail: ExampleTrace | None


def explain(fspa: Fspa) -> Explanation:
    """Return the explanation of an automaton."""
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
        outline=_outline(formula, endless=fspa.semantics == "infinite") if isinstance(formula, Formula) else None,
        exclusive=tuple(tuple(fspa.atoms[index].name for index in group) for group in fspa.exclusive),
        failures=_failures(fspa, guards),
        judge=fspa.judge,
        ending=ending(fspa),
        limit_steps=fspa.limit_steps,
        limit_s=limit_s,
        spec_size=fspa.spec_size,
        states=_states(fspa, guards),
        counting=tuple(tuple(state.id for state in run) for run in folded(fspa).folded.values()),
        succeed=_way(fspa, _found(moves, accept=True)),
        fail=_way(fspa, _found(moves, accept=False)),
    )


def _outline(formula: Formula, *, endless: bool) -> Outline:
    if endless:
        from tltlc.automaton.infinite.readback import without_constants

        formula = without_constants(formula)
    return outline(formula, endless=endless)


def _guards(fspa: Fspa) -> tuple[Formula, ...]:
    """Return the guard of each edge as a formula."""
    return tuple(_formula(fspa, edge.guard) for edge in fspa.edges)


def _formula(fspa: Fspa, guard: Guard) -> Formula:
    if isinstance(guard.formula, Text):
        return or_(*(_literals(fspa, prime) for prime in guard.primes))
    return guard.formula


def _literals(fspa: Fspa, implicant: Implicant) -> Formula:
    """Return the conjunction of literals; ``true`` if there are none."""
    named = [(atom(fspa.atoms[index].name), holds) for index, holds in implicant]
    return and_(*(literal if holds else not_(literal) for literal, holds in named))


def _words(state: Formula) -> str:
    return ANYTHING if state is TRUE else phrase(_positive_first(state))


def _positive_first(state: Formula) -> Formula:
    """Return a guard, or part of one, with atoms before negated atoms: ``b and not a``."""
    if state.op not in ("and", "or"):
        return state
    parts = (_positive_first(part) for part in state.args)
    return rebuild(state, tuple(sorted(parts, key=lambda part: part.op == "not")))


def _states(fspa: Fspa, guards: tuple[Formula, ...]) -> tuple[StateRow, ...]:
    leads: dict[int, dict[Lead, None]] = {}
    for index in leading_on(fspa):
        edge = fspa.edges[index]
        leads.setdefault(edge.source, {})[Lead(_words(guards[index]), edge.target)] = None
    return tuple(
        StateRow(state.id, label_text(fspa, state.id), state.verdict, state.distance, tuple(leads.get(state.id, ())))
        for state in fspa.states
    )


def _failures(fspa: Fspa, guards: tuple[Formula, ...]) -> tuple[TrapCondition, ...]:
    """Return what leads into a trap, one entry for each reason.

    Reasons that apply in every undecided state come first.
    """
    broken = {state.id for state in fspa.states if state.verdict == "violated"}
    open_ = {state.id for state in fspa.states if state.verdict in ("pending", "holding")}
    sources: dict[str, dict[int, None]] = {}
    for edge, guard in zip(fspa.edges, guards, strict=True):
        if edge.source not in broken and edge.target in broken:
            for reason in guard.args if guard.op == "or" else (guard,):
                sources.setdefault(_words(reason), {})[edge.source] = None
    failures = [TrapCondition(when, tuple(states), set(states) == open_) for when, states in sources.items()]
    return tuple(sorted(failures, key=lambda failure: (not failure.everywhere, failure.states)))


def _found(moves: Moves, accept: bool) -> Witness | None:
    try:
        witness = accepting(moves, _MOST_WORK) if accept else rejecting(moves, _MOST_WORK)
    except OutOfWork:
        return None
    if witness is None or accept or witness.cycle is not None:
        return witness
    edge = moves.fspa.edges[witness.moves[-1].edge]
    return witness if moves.fspa.states[edge.target].verdict == "violated" else None


def _way(fspa: Fspa, witness: Witness | None) -> ExampleTrace | None:
    """Return the witness in words; consecutive steps with the same text are one step."""
    if witness is None:
        return None
    steps: list[WayStep] = []
    cycle: int | None = None
    for index, move in enumerate(witness.moves):
        condition, state = _words(_literals(fspa, move.prime)), fspa.edges[move.edge].target
        if index == witness.cycle:
            cycle = len(steps)
        elif steps and steps[-1].what == condition:
            steps[-1] = WayStep(steps[-1].times + 1, condition, state)
            continue
        steps.append(WayStep(1, condition, state))
    return ExampleTrace(tuple(steps), cycle)
