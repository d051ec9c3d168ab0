"""Traces that tell two specs apart: what each says of them, in words and as ``test`` blocks."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import groupby
from typing import TYPE_CHECKING

from tltlc.automaton.compare import Letter, Trace
from tltlc.core.record import record
from tltlc.monitor.guards import holds
from tltlc.monitor.tables import tables
from tltlc.tools.diff.relation import OF_A, OF_B
from tltlc.tools.witness.blocks import test_block, values

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa, State
    from tltlc.tools.diff.pairs import Pair


@record
class Told:
    """A trace that one spec alone accepts, and the state in which each is after it, the cycle taken once."""

    trace: Trace
    a: State
    b: State


def told(pair: Pair, trace: Trace) -> Told:
    """What the two specs of a pair say of a trace over the atoms of both."""
    letters = (*trace.prefix, *trace.cycle)
    split = pair.comparison.split
    a = _state(pair.a, [own_letter(letter, split, pair.a, OF_A) for letter in letters])
    return Told(trace, a, _state(pair.b, [own_letter(letter, split, pair.b, OF_B) for letter in letters]))


def block(pair: Pair, found: Told, title: str) -> tuple[str, str] | None:
    """A ``test`` block of what one of the two says of a trace, and which one: B, or A where it alone has all atoms.

    None where no test can tell the two apart: their verdicts are the same, or an atom is another one by its expression
    alone.  An infinite trace is taken as far as the end of its first cycle.
    """
    letters = (*found.trace.prefix, *found.trace.cycle)
    named = frozenset[str]().union(*letters)
    atoms_a, atoms_b = ({atom.name for atom in fspa.atoms} for fspa in (pair.a, pair.b))
    side, fspa, state = "B", pair.b, found.b
    if not atoms_b or (named <= atoms_a and not named <= atoms_b):
        side, fspa, state = "A", pair.a, found.a
    if found.a.verdict == found.b.verdict or not fspa.atoms or not named <= atoms_a | atoms_b:
        return None
    return side, test_block(title, fspa, letters, {len(letters): (state.verdict,)})


def own_letter(letter: Letter, split: Iterable[str], fspa: Fspa, ending: str) -> Letter:
    """The names of the atoms of one of the specs that hold, as it calls them."""
    of_both = {name + ending: name for name in split}
    known = {atom.name for atom in fspa.atoms} - set(split)
    return frozenset(of_both.get(name, name) for name in letter if name in known or name in of_both)


def step_lines(pair: Pair, letters: Sequence[Letter]) -> list[str]:
    """What holds at each step, equal ones in a row on one line: ``step 1: alive``, ``steps 2 to 9: nothing holds``."""
    lines = []
    for letter, run in groupby(enumerate(letters, start=1), lambda step: step[1]):
        numbers = [number for number, _ in run]
        steps = f"step {numbers[0]}" if len(numbers) == 1 else f"steps {numbers[0]} to {numbers[-1]}"
        lines.append(f"{steps}: {', '.join(in_order(pair, letter)) or 'nothing holds'}")
    return lines


def in_order(pair: Pair, letter: Letter) -> list[str]:
    """The atoms of a letter, those of A first, in their order there."""
    split = pair.comparison.split
    names = [atom.name + (OF_A if atom.name in split else "") for atom in pair.a.atoms]
    names += [atom.name + (OF_B if atom.name in split else "") for atom in pair.b.atoms]
    return [name for name in dict.fromkeys(names) if name in letter]


def _state(fspa: Fspa, letters: Iterable[Letter]) -> State:
    """The state after a trace that no ``exclusive`` rules out."""
    leaving = tables(fspa).edges
    state = 0
    for letter in letters:
        given = values(fspa, letter)
        state = next(edge.target for edge in leaving[state] if holds(edge.guard, given))
    return fspa.states[state]
