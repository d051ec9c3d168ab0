"""The leaves of a normalised formula as small deterministic automata, each of which marks the letters that matter."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any, Protocol

from tltlc.automaton.diagrams import FALSE, TRUE
from tltlc.automaton.infinite.after_automaton import After
from tltlc.automaton.infinite.infinite import substituted_below
from tltlc.automaton.infinite.mark_conditions import Kind
from tltlc.logic import formula as build
from tltlc.logic.formula import Formula

Memory = tuple[Any, ...]
"""Obligations, and numbers.  No truth values: in a table of leaves they would be taken for the numbers 1 and 0."""


class Part(Protocol):
    """A deterministic automaton with memories as states; its marks must come infinitely (``inf``) or finitely often."""

    kind: Kind
    initial: Memory

    def step(self, memory: Memory) -> int:
        """From the letter to the memory after it and whether it is marked."""

    def settled(self, memory: Memory) -> bool | None:
        """Whether the part is met, where nothing that comes can change that; else None."""


class Breakpoint:
    """A Pi-2 formula (``inf``) or a Sigma-2 one (``fin``): what remains of it, and what of that is still owed.

    Of a Pi-2 formula that is what remains without its ``W``: when it is met, the letter is marked, and what remains
    then is owed.  The formula holds where infinitely many letters are marked, and what remains never becomes false.
    Sigma-2 is dual: a letter is marked when all tries have failed, and it holds where finitely many are.
    """

    def __init__(self, after: After, formula: Formula, kind: Kind) -> None:
        self.kind = kind
        self._after = after
        self._weakened: dict[int, int] = {}
        self.initial: Memory = self._begun(after.obligation(formula))
        self._memo: dict[tuple[int, int], int] = {}
        self._steps: dict[Memory, int] = {}

    def _begun(self, rest: int) -> Memory:
        return (rest,) if rest in (TRUE, FALSE) else (rest, self._restarted(rest))

    def _restarted(self, rest: int) -> int:
        return self._after.replaced(rest, self._weak, self._weakened)

    def _weak(self, formula: Formula) -> int:
        return self._after.obligation(_without(formula, "W" if self.kind == "inf" else "U"))

    def step(self, memory: Memory) -> int:
        """From the letter to the memory after it and whether it is marked."""
        found = self._steps.get(memory)
        if found is None:
            letters = self._after.letters
            if self.settled(memory) is not None:
                found = letters.leaf((memory, False))
            else:
                rest, owed = map(self._after.after, memory)
                found = letters.combined(self._stepped, rest, owed, self._memo)
            self._steps[memory] = found
        return found

    def _stepped(self, rest: int, owed: int) -> tuple[Memory, bool]:
        if rest in (TRUE, FALSE):
            return (rest,), False
        if owed == (TRUE if self.kind == "inf" else FALSE):
            return (rest, self._restarted(rest)), True
        return (rest, owed), False

    def settled(self, memory: Memory) -> bool | None:
        """Whether nothing remains of the formula, or no way to meet it; else None."""
        return memory[0] == TRUE if len(memory) == 1 else None


@lru_cache(maxsize=16384)
def _without(formula: Formula, op: str) -> Formula:
    """The formula with the outermost ``W`` replaced by true, or ``U`` by false."""
    if formula.op == op:
        return build.TRUE if op == "W" else build.FALSE
    if formula.op in ("and", "or", "X"):
        return substituted_below(formula, {each: _without(each, op) for each in formula.args})
    return formula


class Recurrence:
    """``G F p`` of a Sigma-1 p (``inf``), or ``F G p`` of a Pi-1 one (``fin``), by the attempts that are under way.

    The memory is the attempts that began and are not over: each letter begins another.  One that succeeds (of
    ``F G p``: fails) marks the letter.
    """

    def __init__(self, after: After, formula: Formula, kind: Kind, *, keep: bool) -> None:
        self.kind = kind
        self._after = after
        self._keep = keep
        self._first = after.of_formula(formula)
        self.initial: Memory = ()
        self._steps: dict[Memory, int] = {}
        self._memo: dict[tuple[int, int], int] = {}
        self._last: dict[int, int] = {}

    def step(self, memory: Memory) -> int:
        """From the letter to the memory after it and whether it is marked."""
        found = self._steps.get(memory)
        if found is None:
            letters = self._after.letters
            found = letters.mapped(lambda each: (each,), self._first, self._last)
            for attempt in memory:
                found = letters.combined(lambda all_, one: (*all_, one), found, self._after.after(attempt), {})
            found = letters.mapped(self._stepped, found, {})
            self._steps[memory] = found
        return found

    def _stepped(self, attempts: tuple[int, ...]) -> tuple[Memory, bool]:
        over, out = (TRUE, FALSE) if self.kind == "inf" else (FALSE, TRUE)
        marked = over in attempts
        if marked and not self._keep:
            return (), True
        left = {each for each in attempts if each not in (over, out)}
        combine: Callable[[int, int], int]
        combine = self._after.diagrams.either if self.kind == "inf" else self._after.diagrams.both
        # What succeeds only where another one does need not be remembered.
        needed = [each for each in left if not any(other != each and combine(each, other) == other for other in left)]
        return tuple(sorted(needed)), marked

    def settled(self, memory: Memory) -> None:
        """What comes decides, always."""


class RoundRobin:
    """Several ``G F p`` that are all asked for (of ``F G p``: of which one is), by one of them at a time.

    The memory is which one is looked at, and its attempts; a letter that marks it passes on to the next one, and is
    marked when the round is over.  So memories add up, where otherwise they multiply.
    """

    def __init__(self, after: After, parts: Sequence[Recurrence]) -> None:
        self.kind = parts[0].kind
        self._letters = after.letters
        self._parts = parts
        self.initial: Memory = (0, ())
        self._steps: dict[Memory, int] = {}

    def step(self, memory: Memory) -> int:
        """From the letter to the memory after it and whether it is marked."""
        found = self._steps.get(memory)
        if found is None:
            letters, count = self._letters, len(self._parts)
            at, inner = memory
            found = letters.mapped(lambda one: (one,), self._parts[at].step(inner), {})
            for further in range(1, count):
                other = self._parts[(at + further) % count].step(())
                found = letters.combined(lambda all_, one: (*all_, one), found, other, {})

            def stepped(each: Sequence[tuple[Memory, bool]]) -> tuple[Memory, bool]:
                over = False
                for further, (left, marked) in enumerate(each):
                    here = (at + further) % count
                    if not marked:
                        return (here, left), over
                    over = over or here == count - 1
                return (at, each[0][0]), True

            found = letters.mapped(stepped, found, {})
            self._steps[memory] = found
        return found

    def settled(self, memory: Memory) -> None:
        """What comes decides, always."""
