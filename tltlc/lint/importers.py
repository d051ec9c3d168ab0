"""Which names of a file others may use: those that import it, directly or through others."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import PurePath
from typing import Final

from tltlc.record import record

_BETWEEN: Final = r"(?:\s|//[^\n]*\n)+"
_IMPORT: Final = re.compile(rf'\bimport{_BETWEEN}(?:"([^"\n]*)"|([\w.]+))')
_NAME: Final = re.compile(r"[A-Za-z_][\w.]*")


@record
class Words:
    """What a file imports, by the last part of the name without ``.tltl``, and every word that stands in it."""

    stem: str
    imports: frozenset[str]
    names: frozenset[str]


def words(path: str, text: str) -> Words:
    """The words of a file, which need not compile; of a name with dots every end as well, behind a prefix."""
    targets = [quoted or name.replace(".", "/") for quoted, name in _IMPORT.findall(text)]
    dotted = [name.split(".") for name in _NAME.findall(text)] if targets else []
    names = {".".join(parts[first:]) for parts in dotted for first in range(len(parts))}
    return Words(_stem(path), frozenset(map(_stem, targets)), frozenset(names))


def used_elsewhere(path: str, others: Iterable[Words]) -> frozenset[str]:
    """Every word of the files among the others that import this one.

    Files of one name in different folders are not told apart, so more may count as used than is.
    """
    left, reached = list(others), {_stem(path)}
    found: frozenset[str] = frozenset()
    while importing := [each for each in left if each.imports & reached]:
        left = [each for each in left if not each.imports & reached]
        reached |= {each.stem for each in importing}
        found = found.union(*(each.names for each in importing))
    return found


def _stem(path: str) -> str:
    return PurePath(path).name.removesuffix(".tltl")
