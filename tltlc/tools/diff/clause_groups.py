"""Compare specs group by group: clauses that share no memory are unfolded apart from each other.

Two timers of 300 steps have 90,000 pairs of values, which is too much to unfold. But most edits change one
clause. So each spec is split into groups of clauses. A trace that one spec accepts is accepted by the
other if for each group of the other, some group of the one accepts no further trace. Otherwise, a trace
that one group accepts and another does not shows a difference, if the whole spec accepts it, too, and a
game can produce it: the atoms of the other groups may depend on the same signals.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import islice
from typing import TYPE_CHECKING, Final, NamedTuple

from tltlc.automaton.compare import NamedLiterals, Trace
from tltlc.automaton.memory import given_atoms
from tltlc.automaton.work import OutOfWork
from tltlc.monitor import Monitor
from tltlc.resolve.registers import SATURATING
from tltlc.tools.judge.clauses import Clauses, clauses_of
from tltlc.tools.witness.blocks import given_values
from tltlc.tools.witness.step_lengths import length_of

if TYPE_CHECKING:
    from tltlc.automaton.compare import Letter
    from tltlc.automaton.fspa import Fspa
    from tltlc.tools.diff.difference_search import DifferenceSearch
    from tltlc.tools.diff.relation import Comparison

_MOST_GROUPS: Final = 40
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
    search: DifferenceSearch,
) -> GroupwiseComparison | None:
    """Compare two specs by their groups of clauses; None if that does not decide how they relate.

    ``own_letters`` has two functions, for A and B: they return the part of a letter that belongs to the
    spec, in its names. ``is_possible`` says whether a game can produce a trace over the atoms of both specs.
    ``search`` goes on from a trace that distinguishes two groups to one that distinguishes the specs.
    """
    groups_a, groups_b = _groups(a), _groups(b)
    if max(len(groups_a), len(groups_b)) < 2 or not groups_a or not groups_b:
        return None
    known: dict[tuple[int, int], Comparison] = {}

    def compared(index_a: int, index_b: int) -> Comparison | None:
        if _are_same(groups_a[index_a], groups_b[index_b]):
            return None
        key = index_a, index_b
        if key not in known:
            known[key] = compare(groups_a[index_a], groups_b[index_b])
            if known[key].relation == "undecided":
                raise _Undecided
        return known[key]

    def of_a(trace: Trace) -> Trace | None:
        return trace if _accepts(a, trace, own_letters[0]) and is_possible(trace) else search.trace(0, trace)

    def of_b(trace: Trace) -> Trace | None:
        return trace if _accepts(b, trace, own_letters[1]) and is_possible(trace) else search.trace(1, trace)

    try:
        only_a = _difference(groups_a, groups_b, lambda i, j: _trace(compared(i, j), 0), of_a)
        only_b = _difference(groups_b, groups_a, lambda j, i: _trace(compared(i, j), 1), of_b)
    except (OutOfWork, _Undecided):
        return None
    impossible = dict.fromkeys(literals for comparison in known.values() for literals in comparison.impossible)
    return GroupwiseComparison(only_a, only_b, tuple(impossible))


def _difference(
    ones: Sequence[Fspa],
    others: Sequence[Fspa],
    difference: Callable[[int, int], Trace | None],
    of_whole: Callable[[Trace], Trace | None],
) -> Trace | None:
    """Return a trace that one spec accepts and another does not; None if there is none.

    ``ones`` and ``others`` are the groups of the specs. ``difference`` returns a trace that only one of
    two groups accepts, by their indices. ``of_whole`` returns such a trace of the whole specs that a game can
    produce, found from it, or None.

    Raises:
        _Undecided: the groups do not decide it.
    """
    is_decided = True
    for index, other in enumerate(others):
        # Groups about the same signals come first: the others hardly decide anything, and take longest.
        # Those about no common signal decide nothing, unless they accept no trace.
        common = [_common_signals(one, other) for one in ones]
        order = sorted(
            (number for number in range(len(ones)) if common[number] or not any(common)),
            key=lambda number: (not _are_same(ones[number], other), -common[number]),
        )
        is_included = False
        for number in order:
            trace = difference(number, index)
            if trace is None:
                is_included = True
                break
            of_specs = of_whole(trace)
            if of_specs is not None:
                return of_specs
        is_decided &= is_included
    if not is_decided:
        raise _Undecided
    return None


def _trace(comparison: Comparison | None, side: int) -> Trace | None:
    return None if comparison is None else (comparison.only_a, comparison.only_b)[side]


def _are_same(one: Fspa, other: Fspa) -> bool:
    """Whether two groups have the same formula, and all that its atoms mean and remember."""
    return (one.formula, one.atoms, one.registers, one.signals, one.params, one.exclusive) == (
        other.formula,
        other.atoms,
        other.registers,
        other.signals,
        other.params,
        other.exclusive,
    )


def _common_signals(one: Fspa, other: Fspa) -> int:
    return len({signal.name for signal in one.signals} & {signal.name for signal in other.signals})


def _accepts(fspa: Fspa, trace: Trace, own_letter: Callable[[Letter], Letter]) -> bool:
    monitor = Monitor(fspa)
    accepting = False
    for letter in trace.prefix:
        own = own_letter(letter)
        accepting = monitor.step_atoms(given_values(fspa, own), length_of(own, fspa)).accepting
    return accepting


def _groups(fspa: Fspa) -> list[Fspa]:
    """Return automata for groups of clauses; a trace is accepted by all of them if ``fspa`` accepts it, and only then.

    Clauses without memory are in each group with which they share a signal; the rest of them are a group.
    The list is empty if the spec cannot be split.
    """
    clauses = clauses_of(fspa, None)
    if not clauses.are_all:
        return []
    names = [{signal.name for signal in part.fspa.signals} for part in clauses.parts]
    free = [index for index, part in enumerate(clauses.parts) if not part.fspa.registers]
    groups = []
    for group in islice(_sharing(clauses), _MOST_GROUPS + 1):
        about = set[str]().union(*(names[index] for index in group))
        groups.append([*(index for index in free if names[index] & about), *group])
    rest = set(free).difference(*groups)
    automata = [clauses.together(group) for group in (*groups, sorted(rest)) if group]
    complete = [automaton for automaton in automata if automaton is not None]
    return complete if len(complete) == len(automata) <= _MOST_GROUPS else []


def _sharing(clauses: Clauses) -> Iterator[list[int]]:
    """Yield groups of the clauses with memory, by index.

    Two clauses are in one group if they share a count or a time, or if one is about no other atoms than
    the other: the parts of a deadline are. A clause for each of several entities is one clause for each,
    and flags that they share, such as whether an alarm rang at the sample before, are few states.
    """
    groups: list[tuple[list[int], set[str], set[str]]] = []
    for index, part in enumerate(clauses.parts):
        if not part.fspa.registers:
            continue
        indices = [index]
        registers = {register.name for register in part.fspa.registers if register.kind in SATURATING}
        atoms = {part.fspa.atoms[atom].name for atom in given_atoms(part.fspa)}
        apart = []
        for group in groups:
            if registers & group[1] or atoms <= group[2] or group[2] <= atoms:
                indices, registers, atoms = indices + group[0], registers | group[1], atoms | group[2]
            else:
                apart.append(group)
        groups = [*apart, (sorted(indices), registers, atoms)]
    yield from (indices for indices, _, _ in groups)
