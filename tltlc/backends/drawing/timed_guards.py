"""Guards of automata with registers, in words, and the timers that run in a state.

An automaton takes the atoms of timers for free. A picture knows two laws of them, and leaves out what
they rule out: an answer is late only where it is due, and no answer is late at the first sample at
which it is due. On a clock that varies, an answer that is late stays late, even when it comes.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from typing import Final, NamedTuple

from tltlc.automaton.diagrams import OutOfSteps
from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.fspa import Fspa, Guard, Implicant, State, Text
from tltlc.automaton.guards import Guards, TooManyPrimes
from tltlc.automaton.memory_phrases import Speaker
from tltlc.automaton.remembered_formulas import Answer, names_read, waited_for
from tltlc.automaton.transitions import ACCEPT, REJECT, TransitionDiagrams
from tltlc.backends.drawing.folding import Drawing, DrawnEdge
from tltlc.backends.drawing.timers import Timer, timers_of, with_goal
from tltlc.core.record import EMPTY, record, replace
from tltlc.expression.tree import Const, Expression, Op, When
from tltlc.logic.formula import TRUE, Formula, atom
from tltlc.resolve.spec import Register

OTHERWISE: Final = "otherwise"
"""The guard of the longest arrow that leaves a state, in place of its text."""
ALWAYS: Final = "always"
_MOST_LITERALS: Final = 2
"""A guard with more literals may be written ``otherwise``."""


@record
class TimedDrawing:
    """A drawing whose guards are in words.

    ``timers`` has the timers that run in each state, by the number of the state and the name of the atom.
    If ``final_first``, the guards of other arrows leave out the conditions of arrows to final states.
    """

    drawing: Drawing
    timers: Mapping[int, Mapping[str, Timer]]
    final_first: bool


def timed_drawing(fspa: Fspa, drawing: Drawing) -> TimedDrawing:
    """Return the drawing with the guards of an automaton with registers in words.

    Each alternative of a guard is an edge of its own, so that it gets a line. If the guards take too
    much work, they are only put into words, and no timers are shown.
    """
    try:
        with recursion_room():
            return _TimedGuards(fspa).timed(drawing)
    except (OutOfSteps, TooManyPrimes):
        speaker = Speaker(fspa)
        edges = tuple(_in_words(edge, speaker) for edge in drawing.edges)
        return TimedDrawing(replace(drawing, edges=edges), EMPTY, False)


class _Response(NamedTuple):
    """The atoms of a response, by index: "the goal is due", and those that say that it is late."""

    due: int
    late: tuple[int, ...]


class _Leaving(NamedTuple):
    """What a picture shows of the edges that leave a state; the fields are as in :class:`TimedDrawing`."""

    edges: list[DrawnEdge]
    timers: Mapping[str, Timer]
    final_first: bool


class _Shown(NamedTuple):
    """An edge and the formula of its guard."""

    edge: DrawnEdge
    formula: Formula

    @property
    def size(self) -> tuple[int, int, bool]:
        """The number of literals, of negative ones, and whether the edge is a loop."""
        literals = [node for node in self.formula.walk() if node.op in ("atom", "not")]
        negative = sum(node.op == "not" for node in literals)
        return len(literals) - negative, negative, self.edge.source == self.edge.target


class _TimedGuards:
    """Computes the guards of the edges of one automaton. A function is a guard as a decision diagram."""

    def __init__(self, fspa: Fspa) -> None:
        self._fspa, self._speaker = fspa, Speaker(fspa)
        self._timers = timers_of(fspa, self._speaker)
        self._diagrams = TransitionDiagrams()
        self._names = [atom.name for atom in fspa.atoms]
        self._responses = _responses(fspa)
        self._laws = self._diagrams.allowed_letters(fspa.exclusive)
        for response in () if fspa.clock_varies else self._responses:
            for late in response.late:
                due_if_late = self._diagrams.disjoin(self._literal(late, False), self._literal(response.due, True))
                self._laws = self._diagrams.conjoin(self._laws, due_if_late)
        self._function = cache(self._uncached_function)
        self._guards = cache(lambda facts: Guards(self._diagrams, self._names, facts))
        self._entering: dict[int, list[Guard]] = {}
        for edge in fspa.edges:
            self._entering.setdefault(edge.target, []).append(edge.guard)

    def timed(self, drawing: Drawing) -> TimedDrawing:
        leaving: dict[int, list[DrawnEdge]] = {}
        for edge in drawing.edges:
            leaving.setdefault(edge.source, []).append(edge)
        shown = {state: self._leaving(state, edges) for state, edges in leaving.items()}
        return TimedDrawing(
            replace(drawing, edges=tuple(edge for drawn in shown.values() for edge in drawn.edges)),
            {state: drawn.timers for state, drawn in shown.items()},
            any(drawn.final_first for drawn in shown.values()),
        )

    def _leaving(self, state: int, edges: Sequence[DrawnEdge]) -> _Leaving:
        conjoin, states = self._diagrams.conjoin, self._fspa.states
        facts = self._facts(state)
        possible = [edge for edge in edges if conjoin(self._function(edge.label.guard.primes), facts) != REJECT]
        if len(possible) == 1:
            return _Leaving([_with_formula(possible[0], atom(ALWAYS))], {}, False)
        plain = [_Shown(edge, self._formula(edge, facts)) for edge in possible]
        final = [edge for edge in possible if edge.target != state and _is_final(states[edge.target])]
        rest = conjoin(facts, self._none_of(final))
        shown = [
            line if line.edge in final or line.size[0] <= 1 else _Shown(line.edge, self._formula(line.edge, rest))
            for line in plain
        ]
        others = [guarded for guarded in shown if guarded.edge not in final]
        longest = max(others, key=lambda guarded: guarded.size, default=None)
        if longest is not None and (longest.size[0] > _MOST_LITERALS or longest.formula is TRUE):
            shown[shown.index(longest)] = _Shown(longest.edge, atom(OTHERWISE))
        read = dict.fromkeys(name for guarded in plain for name in guarded.formula.atoms())
        label = states[state].label
        timers = {
            name: with_goal(timer, name, label, self._speaker) for name, timer in self._timers.items() if name in read
        }
        return _Leaving(
            [line for guarded in shown for line in self._lines(guarded)],
            timers,
            any(before.formula is not after.formula for before, after in zip(plain, shown, strict=True)),
        )

    def _lines(self, shown: _Shown) -> list[DrawnEdge]:
        """Return an edge for each alternative of a guard."""
        formula = shown.formula
        parts = formula.args if formula.op == "or" else (formula,)
        return [_with_formula(shown.edge, self._speaker.spoken(part)) for part in parts]

    def _facts(self, state: int) -> int:
        """Return the function of the letters that can occur in a state.

        Where a state is only entered while no goal is due or late, none is late at the next sample.
        """
        facts = self._laws
        entering = [self._function(guard.primes) for guard in self._entering.get(state, ())]
        for response in self._responses:
            for late in response.late:
                waits = self._diagrams.disjoin(self._literal(response.due, True), self._literal(late, True))
                waits = self._diagrams.conjoin(self._laws, waits)
                if all(self._diagrams.conjoin(function, waits) == REJECT for function in entering):
                    facts = self._diagrams.conjoin(facts, self._literal(late, False))
        return facts

    def _formula(self, edge: DrawnEdge, facts: int) -> Formula:
        """Return a short formula that agrees with the guard of an edge on the letters of ``facts``."""
        function = self._diagrams.conjoin(self._function(edge.label.guard.primes), facts)
        return self._guards(facts).formula(function)

    def _none_of(self, edges: Iterable[DrawnEdge]) -> int:
        function = REJECT
        for edge in edges:
            function = self._diagrams.disjoin(function, self._function(edge.label.guard.primes))
        return self._diagrams.map_leaves(lambda leaf: (1 - leaf[0], 1 - leaf[1]), function, {})

    def _uncached_function(self, primes: tuple[Implicant, ...]) -> int:
        function = REJECT
        for prime in primes:
            cube = ACCEPT
            for index, polarity in sorted(prime, reverse=True):
                cube = self._diagrams.node(index, *((REJECT, cube) if polarity else (cube, REJECT)))
            function = self._diagrams.disjoin(function, cube)
        return function

    def _literal(self, index: int, polarity: bool) -> int:
        return self._diagrams.node(index, *((REJECT, ACCEPT) if polarity else (ACCEPT, REJECT)))


def _is_final(state: State) -> bool:
    return state.verdict in ("satisfied", "violated")


def _in_words(edge: DrawnEdge, speaker: Speaker) -> DrawnEdge:
    formula = edge.label.guard.formula
    return edge if isinstance(formula, Text) else _with_formula(edge, speaker.spoken(formula))


def _with_formula(edge: DrawnEdge, formula: Formula) -> DrawnEdge:
    return replace(edge, label=edge.label._replace(guard=Guard(formula, edge.label.guard.primes)))


def _responses(fspa: Fspa) -> tuple[_Response, ...]:
    """Return the responses of the spec whose goal is never late at the first sample at which it is due."""
    registers = {register.name: register for register in fspa.registers}
    due: dict[Answer, int] = {}
    late: dict[Answer, list[int]] = {}
    for index, item in enumerate(fspa.atoms):
        read = [name for name in names_read(item) if name in registers]
        register = registers[read[0]] if len(read) == 1 else None
        answer = None if register is None else waited_for(register)
        if register is None or answer is None:
            continue
        if register.kind == "due":
            due[answer] = index
        elif _allows_first_wait(item.expression, register):
            late.setdefault(answer, []).append(index)
    return tuple(_Response(index, tuple(late.get(answer, ()))) for answer, index in due.items())


def _allows_first_wait(late: Expression, register: Register) -> bool:
    """Whether an atom is false where the wait of its register has just begun.

    The value of the atom is ``(wait - border) / border``, on a clock that varies at least -1.
    """
    wait = register.update.args[0] if isinstance(register.update, Op) else register.update
    first = wait.cases[-1][1] if isinstance(wait, When) else None
    margin = late.args[0] if isinstance(late, Op) and late.op == "max" else late
    border = margin.args[1] if isinstance(margin, Op) and margin.op == "/" else None
    return isinstance(first, Const) and isinstance(border, Const) and first.value < border.value
