"""What there is to say of a spec, complete and in words: what the outputs of ``tltlc explain`` are written from."""

from __future__ import annotations

from typing import Final

from tltlc.automaton.fspa import Fspa
from tltlc.automaton.infinite.work import OutOfWork
from tltlc.backends.drawing.folding import folded
from tltlc.core.record import record
from tltlc.logic.formula import TRUE, Formula, rebuild
from tltlc.logic.text.outline import Outline, outline
from tltlc.logic.text.phrases import phrase
from tltlc.tools.explain.formulas import formula_of, guard_reader, literals
from tltlc.tools.explain.judgement import ending
from tltlc.tools.explain.next_steps import leading_on
from tltlc.tools.witness.traces import Witness, accepting, rejecting
from tltlc.tools.witness.transitions import Moves

ANYTHING: Final = "anything"
"""What is said of a step at which all samples do the same."""
_MOST_WORK: Final = 2_000_000
"""Steps that the search for an infinite trace may take here."""


@record
class Lead:
    """What leads from a state to another one: when, in words, and the number of that state."""

    when: str
    state: int


@record
class StateRow:
    """A state: what remains, its verdict, its distance (None in a trap), what leads on from it."""

    id: int
    remains: str
    verdict: str
    distance: int | None
    leads: tuple[Lead, ...]


@record
class Failure:
    """What breaks the spec for good, and in which states; ``everywhere`` where these are all that can be left."""

    when: str
    states: tuple[int, ...]
    everywhere: bool


@record
class WayStep:
    """Steps in a row at which the same is done, and the state that the last of them leads to."""

    times: int
    what: str
    state: int


@record
class Way:
    """A way to the end: its steps, and over infinite traces the index of the first of those that repeat for ever."""

    steps: tuple[WayStep, ...]
    cycle: int | None


@record
class Explanation:
    """A spec in words; the fields are those of the JSON that ``tltlc explain --format json`` writes.

    ``outline`` is None where the formula cannot be read.  ``exclusive`` lists atoms of which at most one holds at a
    time.  ``counting`` lists rows of states, each leading to the next, that differ in a count alone.  ``judge`` is
    ``goal`` or ``limit``, ``ending`` says what that means here.  ``succeed`` and ``fail`` are None where there is no
    such way, or none was found; over finite traces a way to fail ends where nothing can succeed any more, and both
    are shortest.
    """

    name: str
    doc: str
    formula: str
    english: str
    semantics: str
    level: str | None
    outline: Outline | None
    exclusive: tuple[tuple[str, ...], ...]
    failures: tuple[Failure, ...]
    judge: str
    ending: str
    limit_steps: int | None
    limit_s: float | None
    spec_size: int
    states: tuple[StateRow, ...]
    counting: tuple[tuple[int, ...], ...]
    succeed: Way | None
    fail: Way | None


def explain(fspa: Fspa, formula: Formula | None = None) -> Explanation:
    """What there is to say of an automaton; ``formula`` is that of its spec, read from its text where it is missing."""
    formula = formula or formula_of(fspa)
    guards = _guards(fspa)
    moves = Moves(fspa)
    limit_s = None if None in (fspa.limit_steps, fspa.clock_s) else (fspa.limit_steps or 0) * (fspa.clock_s or 0.0)
    return Explanation(
        name=fspa.name,
        doc=fspa.doc,
        formula=fspa.formula.ascii,
        english=fspa.formula.english,
        semantics=fspa.semantics,
        level=fspa.level,
        outline=None if formula is None else _outline(formula, endless=fspa.semantics == "infinite"),
        exclusive=tuple(tuple(fspa.atoms[each].name for each in group) for group in fspa.exclusive),
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
    """The guard of each edge."""
    read = guard_reader(fspa)
    known = {edge.guard.text: edge.guard for edge in fspa.edges}
    formulas = {text: read(guard) for text, guard in known.items()}
    return tuple(formulas[edge.guard.text] for edge in fspa.edges)


def _words(state: Formula) -> str:
    return ANYTHING if state is TRUE else phrase(_with_what_holds_first(state))


def _with_what_holds_first(state: Formula) -> Formula:
    """The guard, or part of one, with atoms before their negations in each row: ``b and not a``."""
    if state.op not in ("and", "or"):
        return state
    parts = (_with_what_holds_first(part) for part in state.args)
    return rebuild(state, tuple(sorted(parts, key=lambda part: part.op == "not")))


def _states(fspa: Fspa, guards: tuple[Formula, ...]) -> tuple[StateRow, ...]:
    leads: dict[int, dict[Lead, None]] = {}
    for index in leading_on(fspa):
        edge = fspa.edges[index]
        leads.setdefault(edge.source, {})[Lead(_words(guards[index]), edge.target)] = None
    return tuple(
        StateRow(state.id, state.label.english, state.verdict, state.distance, tuple(leads.get(state.id, ())))
        for state in fspa.states
    )


def _failures(fspa: Fspa, guards: tuple[Formula, ...]) -> tuple[Failure, ...]:
    """What leads into a trap, each of several reasons by itself; what does so everywhere first."""
    broken = {state.id for state in fspa.states if state.verdict == "violated"}
    open_ = {state.id for state in fspa.states if state.verdict in ("pending", "holding")}
    found: dict[str, dict[int, None]] = {}
    for edge, guard in zip(fspa.edges, guards, strict=True):
        if edge.source not in broken and edge.target in broken:
            for reason in guard.args if guard.op == "or" else (guard,):
                found.setdefault(_words(reason), {})[edge.source] = None
    failures = [Failure(when, tuple(states), set(states) == open_) for when, states in found.items()]
    return tuple(sorted(failures, key=lambda failure: (not failure.everywhere, failure.states)))


def _found(moves: Moves, accept: bool) -> Witness | None:
    try:
        found = accepting(moves, _MOST_WORK) if accept else rejecting(moves, _MOST_WORK)
    except OutOfWork:
        return None
    if found is None or accept or found.cycle is not None:
        return found
    edge = moves.fspa.edges[found.moves[-1].edge]
    return found if moves.fspa.states[edge.target].verdict == "violated" else None


def _way(fspa: Fspa, witness: Witness | None) -> Way | None:
    """The witness in words, with steps in a row that say the same as one."""
    if witness is None:
        return None
    steps: list[WayStep] = []
    cycle: int | None = None
    for index, move in enumerate(witness.moves):
        what, state = _words(literals(fspa, move.prime)), fspa.edges[move.edge].target
        if index == witness.cycle:
            cycle = len(steps)
        elif steps and steps[-1].what == what:
            steps[-1] = WayStep(steps[-1].times + 1, what, state)
            continue
        steps.append(WayStep(1, what, state))
    return Way(tuple(steps), cycle)
