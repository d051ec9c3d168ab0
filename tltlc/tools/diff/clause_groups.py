"""Compare specs group by group: clauses that share no memory are unfolded apart from each other.

Two timers of 300 steps have 90,000 pairs of values, which is too much to unfold. But most edits change one
clause. So each spec is split into groups of clauses. A trace that one spec accepts is accepted by the
other if for each group of the other, some group of the one accepts no further trace. Otherwise, a trace
that one group accepts and another does not shows a difference, if the whole spec accepts it, too, and a
game can produce it: the atoms of the other groups may depend on the same signals.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Final, NamedTuple

from tltlc.automaton.compare import NamedLiterals, Trace
from tltlc.automaton.memory import given_atoms
from tltlc.automaton.work import OutOfWork
from tltlc.monitor import Monitor
from tltlc.tools.judge.clauses import Clauses, clauses_of
from tltlc.tools.witness.blocks import given_values

if TYPE_CHECKING:
    from tltlc.automaton.compare import Letter
    from tltlc.automaton.fspa import Fspa
    from tltlc.tools.diff.relation import Comparison

_MOST_GROUPS: Final = 8
"""The most groups of a spec."""

CompareGroups = Callable[["Fspa", "Fspa"], "Comparison"]
"""Compares a group of A with a group of B."""


class GroupwiseComparison(NamedTuple):
    """A trace that only A accepts, one that only B accepts, and the impossible literals of the comparisons."""

    only_a: Trace | None
    only_b: Trace | None
    impossible: tuple[NamedLiterals, ...]


class _Undecided(Exception):
    """Raised when the groups do not decide how two specs relate."""


def compare_groups(
    a: Fspa,
    b: Fspa,
    compare: CompareGroups,
    own_letters: tuple[Callable[[Letter], Letter], Callable[[Letter], Letter]],
    is_possible: Callable[[Trace], bool],
) -> GroupwiseComparison | None:
    """Compare two specs by their groups of clauses; None if that does not decide how they relate.

    ``own_letters`` has two functions, for A and B: they return the part of a letter that belongs to the
    spec, in its names. ``is_possible`` says whether a game can produce a trace over the atoms of both specs.
    """
    groups_a, groups_b = _groups(a), _groups(b)
    if max(len(groups_a), len(groups_b)) < 2 or not groups_a or not groups_b:
        return None
    known: dict[tuple[int, int], Comparison] = {}

    def compared(index_a: int, index_b: int) -> Comparison:
        key = index_a, index_b
        if key not in known:
            known[key] = compare(groups_a[index_a], groups_b[index_b])
            if known[key].method == "search":
                raise _Undecided
        return known[key]

    def is_of_a(trace: Trace) -> bool:
        return _accepts(a, trace, own_letters[0]) and is_possible(trace)

    def is_of_b(trace: Trace) -> bool:
        return _accepts(b, trace, own_letters[1]) and is_possible(trace)

    try:
        only_a = _difference(groups_a, groups_b, lambda i, j: compared(i, j).only_a, is_of_a)
        only_b = _difference(groups_b, groups_a, lambda j, i: compared(i, j).only_b, is_of_b)
    except (OutOfWork, _Undecided):
        return None
    impossible = dict.fromkeys(literals for comparison in known.values() for literals in comparison.impossible)
    return GroupwiseComparison(only_a, only_b, tuple(impossible))


def _difference(
    ones: Sequence[Fspa],
    others: Sequence[Fspa],
    difference: Callable[[int, int], Trace | None],
    is_accepted: Callable[[Trace], bool],
) -> Trace | None:
    """Return a trace that one spec accepts and another does not; None if there is none.

    ``ones`` and ``others`` are the groups of the specs. ``difference`` returns a trace that only one of
    two groups accepts, by their indices. ``is_accepted`` says whether the one spec accepts a trace, and a game
    can produce it.

    Raises:
        _Undecided: the groups do not decide it.
    """
    is_decided = True
    for index, other in enumerate(others):
        # Groups about the same atoms come first: the others hardly decide anything, and take longest.
        order = sorted(range(len(ones)), key=lambda number: -_common_atoms(ones[number], other))
        is_included = False
        for number in order:
            trace = difference(number, index)
            if trace is None:
                is_included = True
                break
            if is_accepted(trace):
                return trace
        is_decided &= is_included
    if not is_decided:
        raise _Undecided
    return None


def _common_atoms(one: Fspa, other: Fspa) -> int:
    return len({atom.name for atom in one.atoms} & {atom.name for atom in other.atoms})


def _accepts(fspa: Fspa, trace: Trace, own_letter: Callable[[Letter], Letter]) -> bool:
    monitor = Monitor(fspa)
    accepting = False
    for letter in trace.prefix:
        accepting = monitor.step_atoms(given_values(fspa, own_letter(letter))).accepting
    return accepting


def _groups(fspa: Fspa) -> list[Fspa]:
    """Return automata for groups of clauses; a trace is accepted by all of them if ``fspa`` accepts it, and only then.

    The clauses without memory are in each of them. The list is empty if it cannot be split.
    """
    clauses = clauses_of(fspa, None)
    if not clauses.are_all:
        return []
    free = [index for index, part in enumerate(clauses.parts) if not part.fspa.registers]
    automata = [clauses.together([*free, *group]) for group in _sharing(clauses)][: _MOST_GROUPS + 1]
    complete = [automaton for automaton in automata if automaton is not None]
    return complete if len(complete) == len(automata) <= _MOST_GROUPS else []


def _sharing(clauses: Clauses) -> Iterator[list[int]]:
    """Yield groups of the clauses with memory, by index.

    Two clauses are in one group if they share a register, or if one is about no other atoms than the
    other: the parts of a deadline are.
    """
    groups: list[tuple[list[int], set[str], set[str]]] = []
    for index, part in enumerate(clauses.parts):
        indices, registers = [index], {register.name for register in part.fspa.registers}
        atoms = {part.fspa.atoms[atom].name for atom in given_atoms(part.fspa)}
        if not registers:
            continue
        apart = []
        for group in groups:
            if registers & group[1] or atoms <= group[2] or group[2] <= atoms:
                indices, registers, atoms = indices + group[0], registers | group[1], atoms | group[2]
            else:
                apart.append(group)
        groups = [*apart, (sorted(indices), registers, atoms)]
    yield from (indices for indices, _, _ in groups)
