"""Build candidate clauses with one or two atoms from templates: keep, avoid, invariants, until, precedence, response.

:mod:`tltlc.tools.mine.sequences` builds sequences of goals, :mod:`tltlc.tools.mine.single_times` and
:mod:`tltlc.tools.mine.pair_times` clauses about counts and times.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import Final

from tltlc.tools.mine.bits import Bits
from tltlc.tools.mine.clause import MinedClause
from tltlc.tools.witness.blocks import atom_operand

IN_TIME: Final = "reach in time"
GOAL_TIME: Final = "reach for some time"
BOUNDED: Final = "bounded response"
PAUSE: Final = "pause"
COUNT: Final = "count"
LONGEST: Final = "longest time"
SHORTEST: Final = "shortest time"
TIMED: Final = (IN_TIME, GOAL_TIME, BOUNDED, PAUSE, COUNT, LONGEST, SHORTEST)
"""The templates about counts and times."""
KINDS: Final = (
    *("reach", IN_TIME, GOAL_TIME, "keep", "avoid", "invariant", "precedence", "until", "response"),
    *(BOUNDED, PAUSE, COUNT, LONGEST, SHORTEST),
)
"""The templates. A spec lists its clauses in this order, which also breaks ties in the search."""


def clauses(forwards: Bits, backwards: Bits, events: Collection[str]) -> Iterator[list[MinedClause]]:
    """Yield, in small portions, the clauses of the templates that some trace satisfies.

    A clause is left out if all traces that satisfy it do so only because nothing triggers it.

    ``backwards`` has the same traces as ``forwards``, each in reverse order. Clauses about two atoms
    use only the atoms in ``events``. The work grows with the square of their number, so the caller
    must limit it.
    """
    for portion in _candidates(forwards, backwards, events):
        # A clause that is only vacuously true says nothing about the game.
        yield [instance for instance in portion if instance.not_vacuous & instance.accepts & forwards.traces]


def template_clause(kind: str, text: str, atoms: int, accepts: int, not_vacuous: int) -> MinedClause:
    """Return a clause of the template ``kind``. The other arguments are fields of :class:`MinedClause`."""
    return MinedClause(kind, KINDS.index(kind), text, atoms, accepts, not_vacuous)


def _candidates(forwards: Bits, backwards: Bits, events: Collection[str]) -> Iterator[list[MinedClause]]:
    """Yield all clauses of the templates, in portions: those of one atom, or of one pair of atoms."""
    occurs = {name: forwards.traces_with(samples) for name, samples in forwards.holds.items()}
    for name, samples in forwards.holds.items():
        every = forwards.all_traces
        keep = template_clause("keep", f"keep {name}", 1, forwards.traces_without(forwards.complement(samples)), every)
        yield [keep, template_clause("avoid", f"avoid {name}", 1, every & ~occurs[name], every)]
    for first in events:
        for second in events:
            if first != second:
                yield list(_pair(first, second, forwards, backwards, occurs))


def _pair(first: str, second: str, forwards: Bits, backwards: Bits, occurs: dict[str, int]) -> Iterator[MinedClause]:
    a, b = atom_operand(first), atom_operand(second)
    a_samples, b_samples = forwards.holds[first], forwards.holds[second]
    triggered = occurs[first]
    together = forwards.traces_without(a_samples & ~b_samples)
    yield template_clause("invariant", f"keep {a} implies {b}", 2, together, triggered)
    if first < second:
        never = forwards.traces_without(a_samples & b_samples)
        yield template_clause("invariant", f"avoid {a} and {b}", 2, never, triggered & occurs[second])
        either = forwards.traces_without(forwards.complement(a_samples | b_samples))
        yield template_clause("invariant", f"keep {a} or {b}", 2, either, forwards.all_traces)

    precedes = forwards.traces_without(b_samples & forwards.before_first(a_samples))
    yield template_clause("precedence", f"keep {b} implies once {a}", 2, precedes, occurs[second])
    yield template_clause("until", f"require (not {b}) until {a}", 2, precedes & occurs[first], occurs[first])
    keeps = forwards.traces_without(forwards.before_first(b_samples) & ~a_samples) & occurs[second]
    yield template_clause(
        "until", f"require {a} until {b}", 2, keeps, keeps & forwards.traces_with(forwards.before_first(b_samples))
    )

    # Backwards in time, the answer comes before the trigger.
    last = backwards.before_first(backwards.holds[second])
    answered = backwards.traces_without(backwards.holds[first] & last)
    yield template_clause("response", f"keep {a} implies eventually {b}", 2, answered, triggered)
