"""The templates of one and two atoms: keep, avoid, until, precedence, response.

Sequences are in :mod:`tltlc.tools.mine.sequences`.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import Final

from tltlc.tools.mine.bits import Bits, Verdicts, count
from tltlc.tools.mine.clause import MinedClause
from tltlc.tools.witness.blocks import atom_operand

BOUNDED: Final = "bounded response"
KINDS: Final = ("reach", "keep", "avoid", "invariant", "precedence", "until", "response", BOUNDED)
"""The templates, in the order that breaks ties and in which a spec lists its clauses."""

LONGEST_BOUND: Final = 30
"""The most steps of a bounded response, because its automaton counts them."""
_LEAST_ASKED: Final = 3
"""The least number of traces in which a response must be triggered before its delay is meaningful."""


def clauses(forwards: Bits, backwards: Bits, events: Collection[str], least: int) -> Iterator[list[MinedClause]]:
    """Yield every instance over the atoms, in small portions, except those vacuous in all traces.

    Two atoms are related only if both are ``events``: an atom that holds throughout is covered by
    `keep` and causes nothing. The work grows with the square of ``events``, so the caller limits
    them. A bound is the smallest one that ``least`` of the traces keep to.
    """
    for portion in _candidates(forwards, backwards, events, least):
        # A clause that is only vacuously true says nothing about the game.
        yield [instance for instance in portion if instance.asked & instance.accepts & forwards.traces]


def clause(kind: str, text: str, atoms: int, accepts: int, asked: int) -> MinedClause:
    """Return a clause of a template."""
    return MinedClause(kind, KINDS.index(kind), text, atoms, accepts, asked)


def _candidates(forwards: Bits, backwards: Bits, events: Collection[str], least: int) -> Iterator[list[MinedClause]]:
    """Yield the instances, in portions of one atom or one pair."""
    occurs = {name: forwards.some(samples) for name, samples in forwards.holds.items()}
    for name, samples in forwards.holds.items():
        every = forwards.everything
        keep = clause("keep", f"keep {name}", 1, forwards.none(forwards.complement(samples)), every)
        yield [keep, clause("avoid", f"avoid {name}", 1, every & ~occurs[name], every)]
    for first in events:
        for second in events:
            if first != second:
                related = _pair(first, second, forwards, backwards, occurs)
                yield [*related, *_bounded(first, second, forwards, least)]


def _pair(first: str, second: str, forwards: Bits, backwards: Bits, occurs: dict[str, int]) -> Iterator[MinedClause]:
    a, b = atom_operand(first), atom_operand(second)
    here, there = forwards.holds[first], forwards.holds[second]
    asked = occurs[first]
    together = forwards.none(here & ~there)
    yield clause("invariant", f"keep {a} implies {b}", 2, together, asked)
    if first < second:
        never = forwards.none(here & there)
        yield clause("invariant", f"avoid {a} and {b}", 2, never, asked & occurs[second])
        either = forwards.none(forwards.complement(here | there))
        yield clause("invariant", f"keep {a} or {b}", 2, either, forwards.everything)

    precedes = forwards.none(there & forwards.before_first(here))
    yield clause("precedence", f"require (not {b}) weak_until {a}", 2, precedes, occurs[second])
    yield clause("until", f"require (not {b}) until {a}", 2, precedes & occurs[first], occurs[first])
    keeps = forwards.none(forwards.before_first(there) & ~here) & occurs[second]
    yield clause("until", f"require {a} until {b}", 2, keeps, keeps & forwards.some(forwards.before_first(there)))

    # Backwards in time, the answer comes before the trigger.
    last = backwards.before_first(backwards.holds[second])
    answered = backwards.none(backwards.holds[first] & last)
    yield clause("response", f"require always ({a} implies eventually {b})", 2, answered, asked)


def _bounded(first: str, second: str, bits: Bits, least: int) -> Iterator[MinedClause]:
    """Yield a response within the smallest bound that enough of the traces keep to.

    Yields nothing if that bound is 0 or above LONGEST_BOUND, or if too few traces trigger the
    response.
    """
    here, there = bits.holds[first], bits.holds[second]

    def answered(steps: int) -> Verdicts:
        return bits.none(here & ~bits.within(there, steps))

    def is_enough(steps: int) -> bool:
        return count(answered(steps) & bits.traces) >= least

    low, high = 0, LONGEST_BOUND
    if count(bits.some(here) & bits.traces) < _LEAST_ASKED or not is_enough(high):
        return
    while low < high:
        middle = (low + high) // 2
        low, high = (low, middle) if is_enough(middle) else (middle + 1, high)
    if low:
        steps = f"{low} step{'s' * (low > 1)}"
        text = f"require always ({atom_operand(first)} implies eventually within {steps} {atom_operand(second)})"
        yield clause(BOUNDED, text, 3, answered(low), bits.some(here))
