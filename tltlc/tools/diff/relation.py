"""Compare the traces that two specs accept, and find shortest traces that distinguish them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from itertools import combinations, islice
from typing import TYPE_CHECKING, Final, Literal

from tltlc.automaton.compare import Letter, NamedLiterals, Trace, separating
from tltlc.automaton.work import DEFAULT_WORK, OutOfWork, Work
from tltlc.core.record import record, replace
from tltlc.tools.diff.values import meaning, value_difference
from tltlc.tools.witness.step_lengths import length_names

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa
    from tltlc.resolve.spec import Vocabulary

Relation = Literal["equivalent", "stricter", "looser", "incomparable", "undecided"]
Method = Literal["automata", "unfolded", "clauses", "search"]

_STEPS_OF_A_PAIR: Final = 100
"""A comparison counts at least this many steps of work for each pair of exclusive atoms."""

_QUICK: Final = 10
"""An unfolding is quick if it takes this share of the work, one tenth."""

OF_A: Final = " of A"
OF_B: Final = " of B"
"""Suffixes that tell apart two different atoms with the same name."""


@record
class ExclusiveGroup:
    """The names of atoms of which at most one holds at a time, and whether A and B declare this."""

    names: tuple[str, ...]
    in_a: bool
    in_b: bool


@record
class Comparison:
    """How spec B relates to spec A: the result of :func:`compare`.

    ``stricter`` means that A accepts every trace that B accepts, but not vice versa; ``looser`` is
    the opposite. ``incomparable`` means that each accepts a trace that the other does not.
    ``undecided`` is possible only if ``method`` is ``search``: then no trace was found that shows a
    difference in one direction, but there may be one.
    ``only_a`` is a trace that only A accepts, and ``only_b`` a trace that only B accepts; over
    finite traces they are shortest, unless ``method`` is ``clauses`` or ``search``.

    ``method`` says how the comparison was made. ``automata``: on the automata as they are, which is
    exact. ``unfolded``: registers were unfolded into states first, which is exact, too.
    ``unfolded_states`` is then the number of states of A and B. ``clauses``: groups of clauses were
    unfolded and compared with each other, which is exact as well. ``search``: registers have too many
    values, or remember numbers, and traces were searched with a bounded number of steps.

    For each name in ``split_names``, A and B have different atoms with this name; traces call them
    ``NAME of A`` and ``NAME of B``. ``impossible`` has conjunctions of literals for which no sample
    was found. The comparison leaves out traces in which one of these occurs, and traces in which two
    atoms of an ``exclusive`` group hold together.

    ``relation`` is None if one spec is over finite traces and the other over infinite traces. Then
    ``beginnings`` compares finite beginnings of traces instead: those after which A can still be
    met with those after which B can still be met.
    """

    relation: Relation | None
    only_a: Trace | None = None
    only_b: Trace | None = None
    split_names: tuple[str, ...] = ()
    impossible: tuple[NamedLiterals, ...] = ()
    exclusive: tuple[ExclusiveGroup, ...] = ()
    beginnings: Comparison | None = None
    method: Method = "automata"
    unfolded_states: tuple[int, int] | None = None


def compare(
    a: Fspa,
    b: Fspa,
    *,
    by_name: bool = False,
    feasible_only: bool = False,
    work: int = DEFAULT_WORK,
    exclusive: Iterable[ExclusiveGroup] = (),
) -> Comparison:
    """Compare the traces that B accepts with the traces that A accepts.

    Traces are over the atoms of both automata. Two atoms with the same name count as one atom if
    their expressions are equal, and if a search finds no sample at which only one of them holds.
    With ``by_name``, two atoms with the same name always count as one.

    With ``feasible_only``, a trace counts only if samples of its signals can be found. For example,
    no sample makes ``fuel > 30`` true and ``fuel > 20`` false. ``exclusive`` has further groups of
    exclusive atoms, in addition to those of the automata.

    Raises:
        OutOfWork: the comparison takes more than ``work`` steps in one direction.
    """
    if a.semantics != b.semantics:
        unbroken_a, unbroken_b = _unbroken_prefixes(a), _unbroken_prefixes(b)
        beginnings = compare(
            unbroken_a, unbroken_b, by_name=by_name, feasible_only=feasible_only, work=work, exclusive=exclusive
        )
        return replace(beginnings, relation=None, only_a=None, only_b=None, beginnings=beginnings)
    split_names = () if by_name else different_atoms(a, b)
    exclusive, originals = tuple(exclusive), (a, b)
    a, b = _with_suffix(a, split_names, OF_A), _with_suffix(b, split_names, OF_B)
    own_groups = _own_groups(a, b)
    groups = _merge((*own_groups, *exclusive), {atom.name for fspa in (a, b) for atom in fspa.atoms})
    never = tuple(islice(_exclusive_pairs(groups, own_groups), work // _STEPS_OF_A_PAIR + 1))
    if len(never) > work // _STEPS_OF_A_PAIR:
        raise OutOfWork
    if a.registers or b.registers:
        from tltlc.tools.diff.broken_rules import conflicts
        from tltlc.tools.diff.timer_order import timer_conflicts

        sides = zip(originals, (OF_A, OF_B), strict=True)
        never += tuple(conflict for fspa, suffix in sides for conflict in conflicts(fspa, split_names, suffix))
        never += tuple(timer_conflicts(originals, split_names, (OF_A, OF_B)))
    only_a, only_b = separating(a, b, work, never), separating(b, a, work, never)
    if (a.registers or b.registers) and (only_a or only_b):
        # The automata take atoms that follow from others for free. So they may differ where the specs do not.
        unfolding = _Unfolding(originals, by_name, feasible_only, work, exclusive)
        exact = unfolding.quick()
        if exact is not None:
            return exact
        found = _search_guided(originals, (a, b), (only_a, only_b), groups, by_name=by_name)
        if all((trace is None) == (only is None) for trace, only in zip(found, (only_a, only_b), strict=True)):
            return Comparison(_relation(*found), *found, split_names, (), groups, method="search")
        exact = unfolding.complete()
        if exact is not None:
            return exact
    impossible: dict[NamedLiterals, None] = {}
    if feasible_only and (only_a or only_b):
        from tltlc.tools.diff.feasible_letters import FeasibleLetters
        from tltlc.tools.diff.real_traces import own_registers, with_register_signals

        view_a, view_b = a, b
        if a.registers or b.registers:
            own = own_registers(split_names, *originals)
            view_a, view_b = with_register_signals(a, own, OF_A), with_register_signals(b, own, OF_B)
        letters = FeasibleLetters(view_a, view_b, never)
        only_a, only_b = letters.feasible_trace(only_a, a, b, work), letters.feasible_trace(only_b, b, a, work)
        impossible = letters.impossible
    method: Method = "automata"
    if (a.registers or b.registers) and (only_a or only_b):
        from tltlc.tools.diff.real_traces import confirm

        exclusive_names = [group.names for group in groups]
        only_a, only_b, is_decided = confirm(
            originals, (a, b), (only_a, only_b), exclusive_names, found, by_name=by_name
        )
        method = "search"
        if not is_decided:
            return Comparison("undecided", only_a, only_b, split_names, tuple(impossible), groups, method=method)
    return Comparison(_relation(only_a, only_b), only_a, only_b, split_names, tuple(impossible), groups, method=method)


def _search_guided(
    originals: tuple[Fspa, Fspa],
    named: tuple[Fspa, Fspa],
    only: tuple[Trace | None, Trace | None],
    groups: Iterable[ExclusiveGroup],
    *,
    by_name: bool,
) -> tuple[Trace | None, Trace | None]:
    """Return traces of monitors that only A and only B accept, in place of traces of the automata in ``only``."""
    from tltlc.tools.diff.difference_search import DifferenceSearch
    from tltlc.tools.diff.real_traces import follows_in_one

    if originals[0].semantics == "infinite" or (by_name and follows_in_one(named)):
        return None, None
    search = DifferenceSearch(originals, named, [group.names for group in groups], by_name=by_name)
    only_a, only_b = (None if trace is None else search.trace(side, trace) for side, trace in enumerate(only))
    return only_a, only_b


class _Unfolding:
    """Compares two specs with registers unfolded into states."""

    def __init__(
        self,
        automata: tuple[Fspa, Fspa],
        by_name: bool,
        feasible_only: bool,
        work: int,
        exclusive: tuple[ExclusiveGroup, ...],
    ) -> None:
        from tltlc.tools.diff.real_traces import follows_in_one

        self._automata, self._work = automata, work
        self._by_name, self._feasible_only, self._exclusive = by_name, feasible_only, exclusive
        # With `by_name`, no letter gives an atom that follows from others in one of the two specs only.
        self._is_possible = not (by_name and follows_in_one(automata))

    def quick(self) -> Comparison | None:
        """Compare the whole specs if that is quick, else group by group; None if that does not decide."""
        # A small unfolding of the whole specs gives shortest traces. A large one takes longer than one of each clause.
        whole = self._whole(self._work // _QUICK)
        return whole or (self._clauses() if self._is_possible and self._automata[0].semantics == "finite" else None)

    def complete(self) -> Comparison | None:
        """Compare the whole specs; None if that is not possible, or takes too much work."""
        return self._whole(self._work)

    def _whole(self, work: int) -> Comparison | None:
        unfolded = unfolded_pair(*self._automata, work) if self._is_possible else None
        if unfolded is None:
            return None
        states = len(unfolded[0].states), len(unfolded[1].states)
        return replace(self._compared(*unfolded), method="unfolded", unfolded_states=states)

    def _compared(self, one: Fspa, other: Fspa) -> Comparison:
        return compare(
            one,
            other,
            by_name=self._by_name,
            feasible_only=self._feasible_only,
            work=self._work,
            exclusive=self._exclusive,
        )

    def _clauses(self) -> Comparison | None:
        """Compare two specs by groups of their clauses; None if that does not decide how they relate."""
        from tltlc.tools.diff.clause_groups import compare_groups
        from tltlc.tools.diff.difference_search import DifferenceSearch

        a, b = self._automata
        split_names = () if self._by_name else different_atoms(a, b)

        def own_part(fspa: Fspa, suffix: str) -> Callable[[Letter], Letter]:
            return lambda letter: own_letter(letter, split_names, fspa, suffix)

        named = _with_suffix(a, split_names, OF_A), _with_suffix(b, split_names, OF_B)

        def is_possible(trace: Trace) -> bool:
            from tltlc.tools.diff.real_traces import is_possible_without_numbers

            return not self._feasible_only or is_possible_without_numbers(named, trace)

        names = {atom.name for fspa in (a, b) for atom in fspa.atoms}
        groups = _merge((*_own_groups(a, b), *self._exclusive), names)
        search = DifferenceSearch((a, b), named, [group.names for group in groups], by_name=self._by_name)
        result = compare_groups(a, b, self._compared, (own_part(a, OF_A), own_part(b, OF_B)), is_possible, search)
        if result is None:
            return None
        only = result.only_a, result.only_b
        return Comparison(_relation(*only), *only, split_names, result.impossible, groups, method="clauses")


def _relation(only_a: Trace | None, only_b: Trace | None) -> Relation:
    """Return how B relates to A, by the traces that only one of them accepts."""
    if only_a is None:
        return "equivalent" if only_b is None else "looser"
    return "stricter" if only_b is None else "incomparable"


def unfolded_pair(a: Fspa, b: Fspa, work: int) -> tuple[Fspa, Fspa] | None:
    """Return both automata with registers unfolded into states.

    The result is None if a register remembers a number, or if the unfolding takes more than ``work`` steps.
    """
    from tltlc.monitor.unfolding import unfolded

    steps = Work(work)
    try:
        one, other = unfolded(a, steps), unfolded(b, steps)
    except OutOfWork:
        return None
    return None if one is None or other is None else (one, other)


def _unbroken_prefixes(fspa: Fspa) -> Fspa:
    """Return an automaton that accepts the finite traces that do not violate ``fspa`` for good."""
    states = tuple(replace(state, accepting=state.verdict != "violated") for state in fspa.states)
    return replace(fspa, semantics="finite", acceptance=(), states=states)


def _own_groups(a: Fspa, b: Fspa) -> list[ExclusiveGroup]:
    """Return the exclusive groups of both automata."""
    return [
        ExclusiveGroup(tuple(fspa.atoms[atom].name for atom in group), fspa is a, fspa is b)
        for fspa in (a, b)
        for group in fspa.exclusive
    ]


def _merge(groups: Iterable[ExclusiveGroup], atoms: set[str]) -> tuple[ExclusiveGroup, ...]:
    """Remove all atoms but ``atoms`` from the groups, and leave out duplicates and groups of one atom.

    A group in the result counts as declared in A if A declares a group that contains it, and as
    declared in B if B does.
    """
    restricted = [replace(group, names=tuple(name for name in group.names if name in atoms)) for group in groups]
    merged: dict[frozenset[str], ExclusiveGroup] = {}
    for group in restricted:
        wider = [wide for wide in restricted if set(group.names) <= set(wide.names)]
        in_a, in_b = any(wide.in_a for wide in wider), any(wide.in_b for wide in wider)
        if len(group.names) > 1:
            merged.setdefault(frozenset(group.names), ExclusiveGroup(group.names, in_a, in_b))
    return tuple(merged.values())


def _exclusive_pairs(groups: Iterable[ExclusiveGroup], own_groups: Iterable[ExclusiveGroup]) -> Iterator[NamedLiterals]:
    """Yield each pair of exclusive atoms, as two literals that cannot both be true.

    Groups inside a group of ``own_groups`` are left out, because the automata already have them.
    """
    own = [set(group.names) for group in own_groups]
    for group in groups:
        if not any(own_group.issuperset(group.names) for own_group in own):
            yield from (((first, True), (second, True)) for first, second in combinations(group.names, 2))


def different_atoms(a: Fspa | Vocabulary, b: Fspa | Vocabulary) -> tuple[str, ...]:
    """Return the names of atoms that ``a`` and ``b`` both have, but with different meanings, in the order of ``a``.

    Meanings differ if the expressions do, or if the search finds a sample at which only one holds.
    """
    places = {atom.name: index for index, atom in enumerate(b.atoms)}
    names = []
    for index, atom in enumerate(a.atoms):
        if atom.name not in places:
            continue
        meaning_a, meaning_b = meaning(a, index), meaning(b, places[atom.name])
        if meaning_a.expression != meaning_b.expression or (
            (difference := value_difference(meaning_a, meaning_b)) and difference.differs_in_truth
        ):
            names.append(atom.name)
    if a.registers or b.registers:
        from tltlc.tools.diff.real_traces import with_derived

        return with_derived(names, a, b)
    return tuple(names)


def own_letter(letter: Letter, split_names: Iterable[str], fspa: Fspa, suffix: str) -> Letter:
    """Return the atoms of a letter that belong to the spec ``fspa``, as that spec names them.

    The letter is over the atoms of two specs. For each name in ``split_names``, the specs have
    different atoms with this name. The letter tells them apart by a suffix, and ``suffix`` is the one
    of this spec: with the suffix `` of A``, the name ``seen of A`` becomes ``seen``.
    """
    own_names = {name + suffix: name for name in split_names}
    common = {atom.name for atom in fspa.atoms} - set(split_names)
    own = frozenset(own_names.get(name, name) for name in letter if name in common or name in own_names)
    return own | length_names(letter)


def _with_suffix(fspa: Fspa, names: tuple[str, ...], suffix: str) -> Fspa:
    """Return the automaton with ``suffix`` added to the names of the atoms in ``names``."""
    if not names:
        return fspa
    atoms = [
        replace(atom, base=atom.name + suffix, arguments=()) if atom.name in names else atom for atom in fspa.atoms
    ]
    return replace(fspa, atoms=tuple(atoms))
