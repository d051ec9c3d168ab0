"""Find the differences between two automata other than the traces that they accept."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from typing import TYPE_CHECKING, Final, Literal, Union

from tltlc.core.record import record
from tltlc.resolve.spec import Atom, Param, Signal
from tltlc.tools.diff.values import Apart, apart, meaning

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa

What = Literal["semantics", "judge", "limit", "level", "clock", "exclusive", "atom", "signal", "param"]
Value = Union[Signal, Param, Atom, tuple[str, ...], str, int, float, None]

_SETTINGS: Final[tuple[tuple[What, str], ...]] = (
    ("semantics", "semantics"),
    ("judge", "judge"),
    ("limit", "limit_steps"),
    ("level", "level"),
    ("clock", "clock_s"),
)
"""The settings of a whole spec, each with its field."""


@record
class Difference:
    """One difference between two automata: what differs, and the values in A and B.

    ``name`` is empty if there is only one such thing. A value is None if that side has none. ``a``
    and ``b`` are records for signals, params and atoms, the names of the atoms for an ``exclusive``
    group, and plain values otherwise. ``apart`` is set only for atoms.
    """

    what: What
    name: str
    a: Value
    b: Value
    apart: Apart | None = None


def differences(a: Fspa, b: Fspa) -> tuple[Difference, ...]:
    """Return all differences other than the traces.

    They concern how a spec is judged, what its atoms mean, and what it reads.
    """
    return tuple(_all(a, b))


def renamed_params(all_differences: Iterable[Difference]) -> dict[str, str]:
    """Return the new names of params that are gone.

    A gone param was renamed if a new one differs from it only in name and documentation.
    """
    params = [difference for difference in all_differences if difference.what == "param"]
    names: dict[str, str] = {}
    for gone in params:
        for added in params:
            alike = gone.b is None and added.a is None and plain(gone.a) == plain(added.b)
            if alike and gone.name not in names and added.name not in names.values():
                names[gone.name] = added.name
    return names


def named(
    what: What, ours: Iterable[Signal] | Iterable[Param], theirs: Iterable[Signal] | Iterable[Param]
) -> Iterator[Difference]:
    """Yield the differences between two lists of signals or params, matched by name."""
    one, other = ({value.name: value for value in values} for values in (ours, theirs))
    for name in dict.fromkeys((*one, *other)):
        before, after = one.get(name), other.get(name)
        if plain(before) != plain(after):
            yield Difference(what, name, before, after)


def are_exclusive(names: Collection[str], groups: Iterable[Collection[str]]) -> bool:
    """Whether ``exclusive`` groups imply that no two of these atoms hold together.

    Each two atoms must share a group.
    """
    wanted = frozenset(names)
    of_name: dict[str, set[frozenset[str]]] = {name: set() for name in wanted}
    for group in groups:
        shared = wanted.intersection(group)
        for name in shared:
            of_name[name].add(shared)
    return all(wanted == frozenset((name,)).union(*shared) for name, shared in of_name.items())


def plain(value: Value) -> object:
    """Return a signal or param as a tuple without its name and documentation."""
    if not isinstance(value, (Signal, Param)):
        return None
    return (value.type, value.low, value.high, value.value if isinstance(value, Param) else None)


def _all(a: Fspa, b: Fspa) -> Iterator[Difference]:
    for what, field in _SETTINGS:
        one, other = getattr(a, field), getattr(b, field)
        if one != other:
            yield Difference(what, "", one, other)
    groups, others = _groups(a), _groups(b)
    yield from (Difference("exclusive", "", names, None) for names in groups if not are_exclusive(names, others))
    yield from (Difference("exclusive", "", None, names) for names in others if not are_exclusive(names, groups))
    places = {atom.name: index for index, atom in enumerate(b.atoms)}
    for index, atom in enumerate(a.atoms):
        if atom.name in places:
            place = places[atom.name]
            sample = apart(meaning(a, index), meaning(b, place))
            if sample is not None or atom.expression != b.atoms[place].expression:
                yield Difference("atom", atom.name, atom, b.atoms[place], sample)
    yield from named("signal", a.signals, b.signals)
    yield from named("param", a.params, b.params)


def _groups(fspa: Fspa) -> list[tuple[str, ...]]:
    """Return the ``exclusive`` groups without duplicates, as names in order."""
    names = [tuple(fspa.atoms[atom].name for atom in group) for group in fspa.exclusive]
    return list({frozenset(group): group for group in names}.values())
