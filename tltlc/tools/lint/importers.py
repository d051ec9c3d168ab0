"""Find the names of a file that other files may use by importing it, directly or through others."""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Container, Iterable, Iterator
from pathlib import PurePath
from typing import Final

from tltlc.core.record import record

_PIECE: Final = re.compile(r'//[^\n]*|"(?P<text>[^"\n]*)"?|(?P<name>[A-Za-z_][\w.]*)')
"""A comment, a quoted text or a name.

Each match consumes all of its characters, so nothing is scanned twice.
"""


@record
class ImporterNames:
    """The imports of a file and every name outside its comments.

    An import is stored as the last part of its name, without ``.tltl``.
    """

    stem: str
    imports: frozenset[str]
    names: frozenset[str]


@record
class Used:
    """The names that files use, and every suffix of a dotted name: ``near`` of ``game.near``.

    ``backwards`` are the dotted names, each reversed, in sorted order. There are too many suffixes
    to list them all.
    """

    names: frozenset[str]
    backwards: tuple[str, ...]

    def __contains__(self, name: object) -> bool:
        if not isinstance(name, str) or name in self.names:
            return name in self.names
        reversed_suffix = f".{name}"[::-1]
        place = bisect_left(self.backwards, reversed_suffix)
        return place < len(self.backwards) and self.backwards[place].startswith(reversed_suffix)


def words(path: str, text: str) -> ImporterNames:
    """Return the words of a file, which need not compile.

    If the file imports nothing, its names do not matter and are left out.
    """
    targets: set[str] = set()
    names: set[str] = set()
    previous = ""
    for quoted, name in _pieces(text):
        if previous == "import":
            targets.add(_stem(quoted or name.replace(".", "/")))
        names.add(name)
        previous = name
    return ImporterNames(_stem(path), frozenset(targets), frozenset(names) if targets else frozenset())


def used_elsewhere(path: str, others: Iterable[ImporterNames]) -> Container[str]:
    """Return every name in those ``others`` that import this file.

    This includes files that import it through others. Files with the same name in different folders
    are not distinguished, so the result may have names that are not really used from this file.
    """
    remaining, reached = list(others), {_stem(path)}
    importers: list[ImporterNames] = []
    while importing := [file for file in remaining if file.imports & reached]:
        remaining = [file for file in remaining if not file.imports & reached]
        reached |= {file.stem for file in importing}
        importers += importing
    names = frozenset().union(*(file.names for file in importers))
    return Used(names, tuple(sorted(name[::-1] for name in names if "." in name)))


def _pieces(text: str) -> Iterator[tuple[str, str]]:
    """Yield the quoted texts and the names of a file, in order; one of each pair is empty."""
    for match in _PIECE.finditer(text):
        if match.lastgroup:
            yield match["text"] or "", match["name"] or ""


def _stem(path: str) -> str:
    return PurePath(path).name.removesuffix(".tltl")
