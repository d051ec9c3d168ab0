"""Compare the settings, atoms, signals and params of two automata A and B.

:mod:`tltlc.tools.diff.relation` compares the traces that they accept.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from typing import TYPE_CHECKING, Final, Literal, Union

from tltlc.core.record import record
from tltlc.resolve.spec import Atom, Param, Signal
from tltlc.tools.diff.values import ValueDifference, meaning, value_difference

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa

DifferenceKind = Literal["semantics", "judge", "limit", "level", "clock", "exclusive", "atom", "signal", "param"]
DifferingValue = Union[Signal, Param, Atom, tuple[str, ...], str, int, float, None]

_SETTINGS: Final[tuple[tuple[DifferenceKind, str], ...]] = (
    ("semantics", "semantics"),
    ("judge", "judge"),
    ("limit", "limit_steps"),
    ("level", "level"),
    ("clock", "clock"),
)
"""The settings of a whole spec, each with the field of :class:`Fspa` that holds it."""


@record
class Difference:
    """One difference between two automata A and B.

    ``name`` is the name of the signal, param or atom, and empty for other kinds. ``a`` and ``b`` are
    what differs, in A and in B: the record of a signal, param or atom, the names of the atoms of an
    ``exclusive`` group, or the value of a setting. One of them is None if A or B lacks it. For an
    atom, ``value_difference`` is a sample at which its values in A and B differ, or None if no such
    sample was found. For other kinds, it is None.
    """

    kind: DifferenceKind
    name: str
    a: DifferingValue
    b: DifferingValue
    value_difference: ValueDifference | None = None


def differences(a: Fspa, b: Fspa) -> tuple[Difference, ...]:
    """Return all differences between two automata other than the traces that they accept.

    They are about the settings of the spec, such as its limit, about ``exclusive`` groups, about the
    values of atoms with the same name, and about signals and params.
    """
    return tuple(_differences(a, b))


def new_param_names(all_differences: Iterable[Difference]) -> dict[str, str]:
    """Return the new names of renamed params, by their old names.

    A removed param counts as renamed if an added param has the same type, range and value.
    """
    params = [difference for difference in all_differences if difference.kind == "param"]
    names: dict[str, str] = {}
    for removed in params:
        for added in params:
            is_alike = removed.b is None and added.a is None and type_and_range(removed.a) == type_and_range(added.b)
            if is_alike and removed.name not in names and added.name not in names.values():
                names[removed.name] = added.name
    return names


def declared_differences(
    kind: DifferenceKind, in_a: Iterable[Signal] | Iterable[Param], in_b: Iterable[Signal] | Iterable[Param]
) -> Iterator[Difference]:
    """Yield the differences between two lists of signals or params, which are matched by name.

    Two of them differ if their types, ranges or values do, or if one of them is missing.
    """
    by_name_a, by_name_b = ({value.name: value for value in values} for values in (in_a, in_b))
    for name in dict.fromkeys((*by_name_a, *by_name_b)):
        a, b = by_name_a.get(name), by_name_b.get(name)
        if type_and_range(a) != type_and_range(b):
            yield Difference(kind, name, a, b)


def are_exclusive(names: Collection[str], groups: Iterable[Collection[str]]) -> bool:
    """Whether ``exclusive`` groups imply that no two of these atoms hold together.

    They do if each pair of the atoms is inside one of the groups.
    """
    atoms = frozenset(names)
    common_groups: dict[str, set[frozenset[str]]] = {name: set() for name in atoms}
    for group in groups:
        common = atoms.intersection(group)
        for name in common:
            common_groups[name].add(common)
    return all(atoms == frozenset((name,)).union(*common) for name, common in common_groups.items())


def type_and_range(value: DifferingValue) -> object:
    """Return the type, range and param value or enum values of a signal or param; None for anything else."""
    if not isinstance(value, (Signal, Param)):
        return None
    return (value.type, value.low, value.high, value.value if isinstance(value, Param) else value.values)


def _differences(a: Fspa, b: Fspa) -> Iterator[Difference]:
    for kind, field in _SETTINGS:
        value_a, value_b = getattr(a, field), getattr(b, field)
        if value_a != value_b:
            yield Difference(kind, "", value_a, value_b)
    groups_a, groups_b = _groups(a), _groups(b)
    yield from (Difference("exclusive", "", names, None) for names in groups_a if not are_exclusive(names, groups_b))
    yield from (Difference("exclusive", "", None, names) for names in groups_b if not are_exclusive(names, groups_a))
    places = {atom.name: index for index, atom in enumerate(b.atoms)}
    for index, atom in enumerate(a.atoms):
        if atom.name in places:
            place = places[atom.name]
            difference = value_difference(meaning(a, index), meaning(b, place))
            if difference is not None or atom.expression != b.atoms[place].expression:
                yield Difference("atom", atom.name, atom, b.atoms[place], difference)
    yield from declared_differences("signal", a.signals, b.signals)
    yield from declared_differences("param", a.params, b.params)


def _groups(fspa: Fspa) -> list[tuple[str, ...]]:
    """Return the ``exclusive`` groups of an automaton as names, without duplicates."""
    names = [tuple(fspa.atoms[atom].name for atom in group) for group in fspa.exclusive]
    return list({frozenset(group): group for group in names}.values())
