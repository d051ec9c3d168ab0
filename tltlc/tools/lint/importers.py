"""Which names of a file others may use: those that import it, directly or through others."""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Container, Iterable, Iterator
from pathlib import PurePath
from typing import Final

from tltlc.core.record import record

_PIECE: Final = re.compile(r'//[^\n]*|"(?P<text>[^"\n]*)"?|(?P<name>[A-Za-z_][\w.]*)')
"""A comment, a text or a name: each takes all of its characters, so that none is looked at twice."""


@record
class Words:
    """What a file imports, by the last part of the name without ``.tltl``, and every name outside its comments."""

    stem: str
    imports: frozenset[str]
    names: frozenset[str]


@record
class Used:
    """The names that files use. It contains every end of a name with dots as well: ``near`` of ``game.near``.

    ``backwards`` are the names with dots in sorted order, each from its last character to its first: there are too
    many ends to list them all.
    """

    names: frozenset[str]
    backwards: tuple[str, ...]

    def __contains__(self, name: object) -> bool:
        if not isinstance(name, str) or name in self.names:
            return name in self.names
        beginning = f".{name}"[::-1]
        place = bisect_left(self.backwards, beginning)
        return place < len(self.backwards) and self.backwards[place].startswith(beginning)


def words(path: str, text: str) -> Words:
    """The words of a file, which need not compile; where it imports nothing, its names do not matter."""
    targets: set[str] = set()
    names: set[str] = set()
    before = ""
    for quoted, name in _pieces(text):
        if before == "import":
            targets.add(_stem(quoted or name.replace(".", "/")))
        names.add(name)
        before = name
    return Words(_stem(path), frozenset(targets), frozenset(names) if targets else frozenset())


def used_elsewhere(path: str, others: Iterable[Words]) -> Container[str]:
    """Every name in those files among the others that import this one.

    Files of one name in different folders are not told apart, so more may count as used than is.
    """
    left, reached = list(others), {_stem(path)}
    found: list[Words] = []
    while importing := [each for each in left if each.imports & reached]:
        left = [each for each in left if not each.imports & reached]
        reached |= {each.stem for each in importing}
        found += importing
    names = frozenset().union(*(each.names for each in found))
    return Used(names, tuple(sorted(name[::-1] for name in names if "." in name)))


def _pieces(text: str) -> Iterator[tuple[str, str]]:
    """The texts in quotes and the names of a file, in order: one of each pair is empty."""
    for found in _PIECE.finditer(text):
        if found.lastgroup:
            yield found["text"] or "", found["name"] or ""


def _stem(path: str) -> str:
    return PurePath(path).name.removesuffix(".tltl")
