"""The syntax tree of a HOA file. Its atoms are not resolved yet."""

from __future__ import annotations

from typing import Literal

from tltlc.core.record import record
from tltlc.core.source import SourceFile, Span


@record
class HoaExpression:
    """A Boolean expression over atoms, or an acceptance condition over sets of states and edges.

    ``value`` depends on ``op``: it is the index of an ``atom``, the name of an ``alias``, or the
    number of the set in a ``fin`` or ``inf``. ``outside`` is true for ``Fin(!0)`` and ``Inf(!0)``,
    which are about the edges that are not in the set.
    """

    op: Literal["true", "false", "not", "and", "or", "atom", "alias", "fin", "inf"]
    args: tuple[HoaExpression, ...] = ()
    value: int | str = 0
    outside: bool = False
    span: Span = Span(0, 0)


@record
class Sets:
    """The acceptance sets of a state or an edge."""

    numbers: tuple[int, ...] = ()
    span: Span = Span(0, 0)


@record
class Targets:
    """The targets of an edge, or initial states.

    An edge with several targets makes the automaton alternating.
    """

    states: tuple[int, ...]
    span: Span


@record
class HoaEdge:
    """An edge.

    If ``label`` is None, the label of its source state applies. If the state has no label either,
    the position of the edge among the edges of the state says for which letter it is.
    """

    label: HoaExpression | None
    targets: Targets
    sets: Sets


@record
class HoaState:
    """A state. ``span`` is where its number stands in the source."""

    number: int
    name: str | None
    label: HoaExpression | None
    sets: Sets
    edges: tuple[HoaEdge, ...]
    span: Span


@record
class HoaString:
    """A string without its quotes, with escapes resolved. ``span`` is the span between the quotes."""

    text: str
    span: Span


@record
class Alias:
    """A name for a Boolean expression over atoms and earlier aliases."""

    name: str
    term: HoaExpression
    span: Span


@record
class Header:
    """An item of the header that has no field in :class:`Hoa`. ``values`` have no quotes."""

    name: str
    values: tuple[str, ...]
    span: Span


@record
class Hoa:
    """A HOA file.

    ``count`` is the number of states that the file declares; None if it declares none. ``starts`` are
    the initial states, ``sets`` is the number of acceptance sets, and ``condition`` the acceptance
    condition. ``headers`` are the headers that have no other field here.
    """

    source: SourceFile
    count: int | None
    starts: tuple[Targets, ...]
    atoms: tuple[HoaString, ...]
    aliases: tuple[Alias, ...]
    sets: int
    condition: HoaExpression
    name: HoaString | None
    headers: tuple[Header, ...]
    states: tuple[HoaState, ...]
