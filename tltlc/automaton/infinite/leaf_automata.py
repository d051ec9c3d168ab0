"""Small deterministic automata for the parts of a normalised formula.

Each automaton marks some of the letters that it reads. Whether it accepts depends on whether it
marks infinitely many.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any, Protocol

from tltlc.automaton.infinite.after_automaton import ObligationAutomaton
from tltlc.automaton.infinite.mark_conditions import MarkKind
from tltlc.automaton.infinite.normal_form import substitute_operands
from tltlc.automaton.transitions import FALSE, TRUE
from tltlc.logic import formula as build
from tltlc.logic.formula import Formula

Memory = tuple[Any, ...]
"""The state of a small automaton: obligations and other ints.

It has no truth values, because in a table of leaves True would be equal to 1, and False to 0.
"""


class LeafAutomaton(Protocol):
    """A deterministic automaton for a part of a formula, which marks some of the letters that it reads.

    Its states are called memories. If ``kind`` is ``inf``, a run is accepted if infinitely many
    letters are marked; if ``kind`` is ``fin``, if only finitely many letters are marked.
    """

    kind: MarkKind
    initial: Memory

    def step(self, memory: Memory) -> int:
        """Return a decision diagram that maps each letter to the next memory and to whether the letter is marked."""

    def final_value(self, memory: Memory) -> bool | None:
        """Return True if the part of the formula holds whatever follows, False if it fails whatever follows.

        Returns None if later letters decide.
        """


class Breakpoint:
    """A breakpoint automaton for a Pi-2 formula (``inf``) or a Sigma-2 formula (``fin``).

    A Pi-2 formula has no ``W`` inside a ``U``, a Sigma-2 formula has no ``U`` inside a ``W``. The
    memory is two obligations: what remains of the formula, and a second obligation. The second
    obligation follows the letters too, and has these rules:

    - Pi-2: the second obligation starts as what remains, with each outermost ``W`` replaced by
      true. When it becomes true, the letter is marked, and the second obligation starts again from
      what remains at that letter. The formula holds if infinitely many letters are marked and what
      remains never becomes false.
    - Sigma-2: the second obligation starts as what remains, with each outermost ``U`` replaced by
      false. When it becomes false, the letter is marked, and the second obligation starts again.
      The formula holds if only finitely many letters are marked.
    """

    def __init__(self, after: ObligationAutomaton, formula: Formula, kind: MarkKind) -> None:
        self.kind = kind
        self._after = after
        self._weakened: dict[int, int] = {}
        self.initial: Memory = self._initial_memory(after.obligation(formula))
        self._memo: dict[tuple[int, int], int] = {}
        self._steps: dict[Memory, int] = {}

    def _initial_memory(self, rest: int) -> Memory:
        return (rest,) if rest in (TRUE, FALSE) else (rest, self._restart(rest))

    def _restart(self, rest: int) -> int:
        return self._after.replace_temporal(rest, self._weaken, self._weakened)

    def _weaken(self, formula: Formula) -> int:
        return self._after.obligation(_replace_outermost(formula, "W" if self.kind == "inf" else "U"))

    def step(self, memory: Memory) -> int:
        """Return a decision diagram that maps each letter to the next memory and to whether the letter is marked."""
        step = self._steps.get(memory)
        if step is None:
            letters = self._after.letters
            if self.final_value(memory) is not None:
                step = letters.leaf((memory, False))
            else:
                rest, owed = map(self._after.after, memory)
                step = letters.apply(self._next_memory, rest, owed, self._memo)
            self._steps[memory] = step
        return step

    def _next_memory(self, rest: int, owed: int) -> tuple[Memory, bool]:
        if rest in (TRUE, FALSE):
            return (rest,), False
        if owed == (TRUE if self.kind == "inf" else FALSE):
            return (rest, self._restart(rest)), True
        return (rest, owed), False

    def final_value(self, memory: Memory) -> bool | None:
        """Return True if nothing remains of the formula, False if it cannot hold any more, None otherwise."""
        return memory[0] == TRUE if len(memory) == 1 else None


@lru_cache(maxsize=16384)
def _replace_outermost(formula: Formula, op: str) -> Formula:
    """Return the formula with each outermost ``p W q`` replaced by true, or each outermost ``p U q`` by false.

    ``op`` is ``W`` or ``U``.
    """
    if formula.op == op:
        return build.TRUE if op == "W" else build.FALSE
    if formula.op in ("and", "or", "X"):
        return substitute_operands(formula, {argument: _replace_outermost(argument, op) for argument in formula.args})
    return formula


class Recurrence:
    """An automaton for ``G F p`` (``kind`` is ``inf``) or ``F G p`` (``kind`` is ``fin``).

    ``formula`` is p. For ``G F p`` it must contain no ``W``, for ``F G p`` no ``U``. At each
    letter, an attempt to satisfy p starts. The memory has what remains of p for each attempt that
    has not succeeded or failed yet. A letter is marked if an attempt succeeds (for ``F G p``:
    fails). The other attempts are then dropped, unless ``keep`` is true.
    """

    def __init__(self, after: ObligationAutomaton, formula: Formula, kind: MarkKind, *, keep: bool) -> None:
        self.kind = kind
        self._after = after
        self._keep = keep
        self._first = after.of_formula(formula)
        self.initial: Memory = ()
        self._steps: dict[Memory, int] = {}
        self._memo: dict[tuple[int, int], int] = {}
        self._last: dict[int, int] = {}

    def step(self, memory: Memory) -> int:
        """Return a decision diagram that maps each letter to the next memory and to whether the letter is marked."""
        step = self._steps.get(memory)
        if step is None:
            letters = self._after.letters
            step = letters.map_leaves(lambda first: (first,), self._first, self._last)
            for attempt in memory:
                step = letters.apply(lambda all_, one: (*all_, one), step, self._after.after(attempt), {})
            step = letters.map_leaves(self._next_memory, step, {})
            self._steps[memory] = step
        return step

    def _next_memory(self, attempts: tuple[int, ...]) -> tuple[Memory, bool]:
        over, out = (TRUE, FALSE) if self.kind == "inf" else (FALSE, TRUE)
        marked = over in attempts
        if marked and not self._keep:
            return (), True
        undecided = {attempt for attempt in attempts if attempt not in (over, out)}
        combine: Callable[[int, int], int]
        combine = self._after.obligations.either if self.kind == "inf" else self._after.obligations.both
        # Drop an attempt that can succeed (for F G p: fail) only if another attempt does, too.
        needed = [
            attempt
            for attempt in undecided
            if not any(other != attempt and combine(attempt, other) == other for other in undecided)
        ]
        return tuple(sorted(needed)), marked

    def final_value(self, memory: Memory) -> None:
        """Return None, because later letters always decide whether the formula holds."""


class RoundRobin:
    """An automaton for a conjunction of ``G F p``, or a disjunction of ``F G p``, that observes one operand at a time.

    ``parts`` are automata for the operands. The memory is the index of the current operand, and the
    memory of this operand's automaton. When the automaton of the current operand marks a letter,
    the next operand becomes the current one. The letter is marked if all operands have had their
    turn. So the number of memories is the sum of the numbers for the operands. If the automaton
    observed all operands at the same time, the number would be the product.
    """

    def __init__(self, after: ObligationAutomaton, parts: Sequence[Recurrence]) -> None:
        self.kind = parts[0].kind
        self._letters = after.letters
        self._parts = parts
        self.initial: Memory = (0, ())
        self._steps: dict[Memory, int] = {}

    def step(self, memory: Memory) -> int:
        """Return a decision diagram that maps each letter to the next memory and to whether the letter is marked."""
        step = self._steps.get(memory)
        if step is None:
            letters, count = self._letters, len(self._parts)
            at, inner = memory
            step = letters.map_leaves(lambda leaf: (leaf,), self._parts[at].step(inner), {})
            for offset in range(1, count):
                other = self._parts[(at + offset) % count].step(())
                step = letters.apply(lambda all_, one: (*all_, one), step, other, {})

            def next_leaf(leaves: Sequence[tuple[Memory, bool]]) -> tuple[Memory, bool]:
                over = False
                for offset, (left, marked) in enumerate(leaves):
                    here = (at + offset) % count
                    if not marked:
                        return (here, left), over
                    over = over or here == count - 1
                return (at, leaves[0][0]), True

            step = letters.map_leaves(next_leaf, step, {})
            self._steps[memory] = step
        return step

    def final_value(self, memory: Memory) -> None:
        """Return None, because later letters always decide whether the formula holds."""
