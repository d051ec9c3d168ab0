"""An automaton as a HOA file has it, before anything is known of its atoms."""

from __future__ import annotations

from typing import Literal

from tltlc.core.record import record
from tltlc.core.source import SourceFile, Span


@record
class Term:
    """A Boolean expression over atoms, or an acceptance condition over sets.

    ``value`` is the index of an ``atom``, the name of an ``alias``, or the number of the set of a ``fin`` or ``inf``,
    which is then of the edges that are in it, or ``outside``.
    """

    op: Literal["true", "false", "not", "and", "or", "atom", "alias", "fin", "inf"]
    args: tuple[Term, ...] = ()
    value: int | str = 0
    outside: bool = False
    span: Span = Span(0, 0)


@record
class Sets:
    """The acceptance sets that a state or an edge is in."""

    numbers: tuple[int, ...] = ()
    span: Span = Span(0, 0)


@record
class Targets:
    """Where an edge leads; several states at once make an automaton alternating."""

    states: tuple[int, ...]
    span: Span


@record
class Edge:
    """An edge; without a label it is that of its place among the letters, or has that of its state."""

    label: Term | None
    targets: Targets
    sets: Sets


@record
class State:
    """A state; ``span`` is that of its number."""

    number: int
    name: str | None
    label: Term | None
    sets: Sets
    edges: tuple[Edge, ...]
    span: Span


@record
class Name:
    """A text in quotes, without them and with its escapes resolved; ``span`` is what stands between the quotes."""

    text: str
    span: Span


@record
class Alias:
    """A name for a Boolean expression over atoms and earlier aliases."""

    name: str
    term: Term
    span: Span


@record
class Header:
    """A line of the header that has no field of its own; texts among its values are without quotes."""

    name: str
    values: tuple[str, ...]
    span: Span


@record
class Hoa:
    """The whole file; ``count`` is None where it does not say how many states there are."""

    source: SourceFile
    count: int | None
    starts: tuple[Targets, ...]
    atoms: tuple[Name, ...]
    aliases: tuple[Alias, ...]
    sets: int
    condition: Term
    name: Name | None
    headers: tuple[Header, ...]
    states: tuple[State, ...]
