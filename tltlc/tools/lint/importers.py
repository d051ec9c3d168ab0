"""Find the names of a file that other files may use, because they import it directly or indirectly."""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Container, Iterable, Iterator
from pathlib import PurePath
from typing import Final

from tltlc.core.record import record

_TOKEN: Final = re.compile(r'//[^\n]*|"(?P<text>[^"\n]*)"?|(?P<name>[A-Za-z_][\w.]*)')
"""Matches a comment, a quoted text or a name.

Each match consumes all of its characters, so the scan takes linear time. The lexer of the compiler
takes four times as long, and stops at a limit on tokens. Names after this limit in a large file
would be missed, so declarations of these names would be removed as unused.
"""


@record
class ImporterNames:
    """What a file imports, and which names it mentions.

    ``stem`` is the name of the file without folder and ``.tltl``. ``imports`` has the stems of the
    files that it imports. ``names`` has every name outside its comments; it is empty if the file
    imports nothing.
    """

    stem: str
    imports: frozenset[str]
    names: frozenset[str]


@record
class UsedNames:
    """A container of names and of the suffixes of dotted names: with ``game.near``, also of ``near``.

    ``names`` has the whole names. ``reversed_names`` has each dotted name spelt backwards, in sorted
    order, so that a binary search finds a suffix. The suffixes themselves are not stored, because
    there may be very many.
    """

    names: frozenset[str]
    reversed_names: tuple[str, ...]

    def __contains__(self, name: object) -> bool:
        if not isinstance(name, str) or name in self.names:
            return name in self.names
        reversed_suffix = f".{name}"[::-1]
        place = bisect_left(self.reversed_names, reversed_suffix)
        return place < len(self.reversed_names) and self.reversed_names[place].startswith(reversed_suffix)


def importer_names(path: str, text: str) -> ImporterNames:
    """Return the imports and the names in ``text``, the content of the file at ``path``.

    The text may contain errors.
    """
    targets: set[str] = set()
    names: set[str] = set()
    previous = ""
    for quoted, name in _tokens(text):
        if previous == "import":
            targets.add(_stem(quoted or name.replace(".", "/")))
        names.add(name)
        previous = name
    return ImporterNames(_stem(path), frozenset(targets), frozenset(names) if targets else frozenset())


def names_used_elsewhere(path: str, files: Iterable[ImporterNames]) -> Container[str]:
    """Return a container of all names in those of ``files`` that import the file at ``path``.

    Files that import it through other files count, too. Only the names of files are compared, not
    their folders. So the result may contain names that do not come from the file at ``path``.
    """
    remaining, reached = list(files), {_stem(path)}
    importers: list[ImporterNames] = []
    while importing := [file for file in remaining if file.imports & reached]:
        remaining = [file for file in remaining if not file.imports & reached]
        reached |= {file.stem for file in importing}
        importers += importing
    names = frozenset().union(*(file.names for file in importers))
    return UsedNames(names, tuple(sorted(name[::-1] for name in names if "." in name)))


def _tokens(text: str) -> Iterator[tuple[str, str]]:
    """Yield the quoted texts and the names in a source text, in order, without comments.

    A quoted text comes as ``(text, "")``, and a name as ``("", name)``.
    """
    for match in _TOKEN.finditer(text):
        if match.lastgroup:
            yield match["text"] or "", match["name"] or ""


def _stem(path: str) -> str:
    return PurePath(path).name.removesuffix(".tltl")
