"""Confirm that two specs with registers differ: find a trace that a game can produce and only one of them accepts.

The automata of such specs treat atoms that follow from others, such as ``times(seen) > 3``, as atoms
that may hold at any step. So a trace over all atoms that tells the automata apart may be none that a
game can produce.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

from tltlc.automaton.compare import Letter, Trace
from tltlc.automaton.memory import given_atoms, registers_from_atoms
from tltlc.core.record import replace
from tltlc.expression.tree import AtomValue, Before, Op, SignalValue, nodes
from tltlc.resolve.registers import SATURATING, following_atoms
from tltlc.resolve.sources import names_read
from tltlc.tools.diff.expression_shapes import ExpressionLeaf, replace_leaves
from tltlc.tools.diff.feasible_letters import joint_automaton
from tltlc.tools.witness.candidate_samples import (
    MOST_FREE,
    all_literals,
    candidates,
    with_signals_for_registers,
    without_registers,
)
from tltlc.tools.witness.memory_search import MemorySearch
from tltlc.tools.witness.samples import SampleFinder

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.expression.tree import Expression
    from tltlc.resolve.spec import Register, Signal, Vocabulary
    from tltlc.tools.witness.memory_search import TraceInput


class Confirmed(NamedTuple):
    """What remains of traces that only A or only B accepts.

    ``only_a`` and ``only_b`` are traces that a game can produce. ``is_decided`` is false if the search
    found no such trace for one of the two, although there may be one.
    """

    only_a: Trace | None
    only_b: Trace | None
    is_decided: bool


def confirm(
    automata: tuple[Fspa, Fspa],
    named: tuple[Fspa, Fspa],
    only: tuple[Trace | None, Trace | None],
    exclusive: Sequence[Collection[str]],
    known: tuple[Trace | None, Trace | None] = (None, None),
    *,
    by_name: bool,
) -> Confirmed:
    """Replace traces over all atoms of A and B by traces that a game can produce.

    ``named`` are the two automata with the names that atoms have in traces. ``only`` are a trace that
    only A accepts and one that only B accepts; where it is None, there is no such trace. ``known`` are those
    that are known already. No two atoms
    of a group in ``exclusive`` hold together. With ``by_name``, atoms that do not follow from others
    may hold in any combination.
    """
    if automata[0].semantics == "infinite" or (by_name and follows_in_one(named)):
        return Confirmed(None, None, False)
    inputs, are_all = _letters(named, only) if by_name else _samples(named)
    names = [[atom.name for atom in fspa.atoms] for fspa in named]
    search = MemorySearch(automata, inputs, names, exclusive)
    found = {side: trace for side, trace in enumerate(known) if trace is not None and only[side] is not None}
    missing = {side for side in (0, 1) if only[side] is not None and side not in found}
    for position in search.positions() if missing else ():
        accepts = [
            fspa.states[state].accepting for fspa, state in zip(automata, position.configuration.states, strict=True)
        ]
        side = 0 if accepts[0] else 1
        if accepts[0] != accepts[1] and side in missing:
            missing.remove(side)
            found[side] = Trace(search.letters(position))
        if not missing:
            break
    is_decided = not missing or (are_all and search.tried_all)
    return Confirmed(found.get(0), found.get(1), is_decided)


def is_possible_without_numbers(named: tuple[Fspa, Fspa], trace: Trace) -> bool:
    """Whether samples are found for a trace over the atoms of A and B that do not follow from others.

    ``named`` are the two automata with the names that atoms have in traces. The result is False if one of
    them remembers numbers: then samples depend on those before.
    """
    if any(len(registers_from_atoms(fspa)) < len(fspa.registers) for fspa in named):
        return False
    view = joint_automaton(*map(without_registers, named))
    if view is None:
        return False
    finder = SampleFinder(view)
    return all(not finder.obstacles(letter) for letter in dict.fromkeys((*trace.prefix, *trace.cycle)))


def follows_in_one(named: tuple[Fspa, Fspa]) -> bool:
    """Whether a common atom follows from others in one automaton only, so that no letter can give it."""
    following = [following_atoms(fspa.atoms, fspa.registers) for fspa in named]
    common = {atom.name for atom in named[0].atoms}.intersection(atom.name for atom in named[1].atoms)
    return any((name in following[0]) != (name in following[1]) for name in common)


def _letters(named: tuple[Fspa, Fspa], only: tuple[Trace | None, Trace | None]) -> tuple[list[TraceInput], bool]:
    """Return letters over the atoms of both automata that do not follow from others, and whether these are all."""
    given = list(dict.fromkeys(fspa.atoms[atom].name for fspa in named for atom in given_atoms(fspa)))
    if len(given) <= MOST_FREE:
        truths = (dict(literals) for literals in all_literals(len(given)))
        return [frozenset(name for index, name in enumerate(given) if truth[index]) for truth in truths], True
    chosen: dict[Letter, None] = dict.fromkeys(letter.intersection(given) for letter in _letters_of(only))
    chosen |= dict.fromkeys((frozenset(), *(frozenset((name,)) for name in given), frozenset(given)))
    return list(chosen), False


def _letters_of(traces: tuple[Trace | None, ...]) -> Iterator[Letter]:
    for trace in traces:
        if trace is not None:
            yield from (*trace.prefix, *trace.cycle)


def _samples(named: tuple[Fspa, Fspa]) -> tuple[Sequence[TraceInput], bool]:
    """Return samples of the signals of both automata, and whether these give all letters."""
    a, b = named
    signals: dict[str, Signal] = {signal.name: signal for signal in (*b.signals, *a.signals)}
    view = joint_automaton(without_registers(a), without_registers(b))
    if view is None:
        return (), False
    chosen = candidates(view, signals.values(), (*a.registers, *b.registers))
    return chosen.samples, chosen.are_all


def with_derived(names: Collection[str], a: Fspa | Vocabulary, b: Fspa | Vocabulary) -> tuple[str, ...]:
    """Return ``names``, and the further common atoms that mean something else because of what they remember.

    ``names`` are atoms that mean something else in ``b`` than in ``a``. The result has the order of
    ``a``.
    """
    in_b, own = {atom.name for atom in b.atoms}, own_registers(names, a, b)
    return tuple(
        atom.name
        for atom in a.atoms
        if atom.name in in_b and (atom.name in names or not own.isdisjoint(names_read(atom.expression)))
    )


def own_registers(names: Collection[str], a: Fspa | Vocabulary, b: Fspa | Vocabulary) -> frozenset[str]:
    """Return the common names of registers that have other values in ``b`` than in ``a``.

    ``names`` are atoms that mean something else. A register has other values if it is updated in
    another way, or if it reads one of these atoms, another such register, or a signal with another
    range. Where a count or time stops does not matter.
    """
    registers_a, registers_b = ({register.name: register for register in each.registers} for each in (a, b))
    ranges_a, ranges_b = ({signal.name: (signal.low, signal.high) for signal in each.signals} for each in (a, b))
    expressions = {atom.name: atom.expression for atom in a.atoms}
    own = {
        name for name in registers_a if name in registers_b and _update(registers_a[name]) != _update(registers_b[name])
    }
    while True:
        changed = set(own)
        for name in (registers_a.keys() & registers_b.keys()) - own:
            pending: list[Expression] = [registers_a[name].update]
            while pending:
                for node in nodes(pending.pop()):
                    if isinstance(node, AtomValue):
                        pending.append(expressions[node.name])
                        changed |= {name} if node.name in names else set()
                    elif isinstance(node, (SignalValue, Before)) and (
                        node.name in own or ranges_a.get(node.name) != ranges_b.get(node.name)
                    ):
                        changed.add(name)
        if changed == own:
            return frozenset(own)
        own = changed


def with_register_signals(fspa: Fspa, own: Collection[str], suffix: str) -> Fspa:
    """Return an automaton in which signals replace the registers, those in ``own`` with ``suffix`` after their name."""

    def rename(leaf: ExpressionLeaf) -> ExpressionLeaf:
        return SignalValue(leaf.name + suffix) if isinstance(leaf, SignalValue) and leaf.name in own else leaf

    renamed = replace(
        fspa,
        atoms=tuple(replace(atom, expression=replace_leaves(atom.expression, rename)) for atom in fspa.atoms),
        registers=tuple(
            replace(register, name=register.name + (suffix if register.name in own else ""))
            for register in fspa.registers
        ),
    )
    return with_signals_for_registers(renamed)


def _update(register: Register) -> Expression:
    """Return the update of a register, without the maximum of a count or time: each atom reads up to its own."""
    if register.kind in SATURATING and isinstance(register.update, Op):
        return register.update.args[0]
    return register.update
