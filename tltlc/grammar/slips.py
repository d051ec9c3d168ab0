"""Slips of the hand: the known word that a misspelt word stands for.

Similar words may mean different things: `doorB` is not `doorA`, and `unlocked` is not `locked`.  A slip is therefore
one letter too many, one letter too few, two neighbours exchanged, or one wrong letter inside a word.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Final

_SHORT: Final = 3
"""In words of at most this length, only an exchange and a doubled letter count: they are often one letter apart."""
_LONG: Final = 7
"""Words of at least this length may have two slips, all others one."""
_MOST_COMPARED: Final = 2_000
_PARTS: Final = re.compile(r"[0-9]+|[A-Z]?[a-z]+|[A-Z]+(?![a-z])|[^\W\d_]+")
"""The parts of a name: numbers, words in camel case, capitals, and letters of other alphabets."""
_NEGATING: Final = ("no", "nt")
"""Endings that negate a word and are no longer than two slips."""


def meant(name: str, known: Iterable[str]) -> str | None:
    """The known name that a misspelt name stands for; None if there is none, or if two are equally likely.

    A name that differs only in capital letters and underscores comes first, then one that ends with a dot and the name.
    Slips are searched for among at most 2,000 names.
    """
    names = tuple(dict.fromkeys(known))
    same = [candidate for candidate in names if _plain(candidate) == _plain(name)]
    same = same or [candidate for candidate in names if candidate.endswith(f".{name}")]
    if same or len(names) > _MOST_COMPARED:
        return same[0] if same else None
    by_count: dict[int, list[str]] = {}
    for candidate in names:
        count = _slips_in_parts(name, candidate)
        if count is not None:
            by_count.setdefault(count, []).append(candidate)
    closest = by_count[min(by_count)] if by_count else []
    return closest[0] if len(closest) == 1 else None


def slips(word: str, known: str) -> int | None:
    """How many slips make the word of the known one; None where it is another word."""
    most = 0 if len(known) < 2 else 2 if len(known) >= _LONG else 1
    if abs(len(word) - len(known)) > most or not _begin_alike(word, known):
        return None
    if len(known) <= _SHORT:
        return 1 if _is_exchanged(word, known) or _is_doubled(word, known) else None if word != known else 0
    if _ends_differ(word, known) or _is_negated(word, known):
        return None
    distance = _distance(word, known)
    return distance if distance <= most else None


def _plain(name: str) -> str:
    return name.replace("_", "").lower()


def _slips_in_parts(name: str, known: str) -> int | None:
    """The slips in all parts of a name, which has as many parts and dots, and the same numbers."""
    if name.count(".") != known.count("."):
        return None
    parts, others = _PARTS.findall(name), _PARTS.findall(known)
    if len(parts) != len(others):
        return None
    total = 0
    for part, other in zip(parts, others, strict=True):
        if part.lower() == other.lower():
            continue
        count = None if part.isdigit() or other.isdigit() else slips(part.lower(), other.lower())
        if count is None:
            return None
        total += count
    return total


def _begin_alike(word: str, known: str) -> bool:
    """Whether both have the same first letter, or the first two are exchanged."""
    return word[:1] == known[:1] or (word[:2] == known[1::-1] and word[2:3] == known[2:3])


def _ends_differ(word: str, known: str) -> bool:
    """Whether only the last letter differs, as in `keyb` for `keya`."""
    return len(word) == len(known) and word[:-1] == known[:-1] and word != known


def _is_exchanged(word: str, known: str) -> bool:
    places = [at for at, (a, b) in enumerate(zip(word, known, strict=False)) if a != b]
    if len(word) != len(known) or len(places) != 2 or places[1] != places[0] + 1:
        return False
    first, second = places
    return word[first] == known[second] and word[second] == known[first]


def _is_doubled(word: str, known: str) -> bool:
    return len(word) == len(known) + 1 and any(word == known[: at + 1] + known[at:] for at in range(len(known)))


def _is_negated(word: str, known: str) -> bool:
    """Whether one word is the other with a negating ending; other beginnings are no slips anyway."""
    longer, shorter = (word, known) if len(word) > len(known) else (known, word)
    return longer.startswith(shorter) and longer[len(shorter) :] in _NEGATING


def _distance(word: str, known: str) -> int:
    """How many letters are wrong, missing, too many, or exchanged with a neighbour (optimal string alignment)."""
    before: list[int] = []
    row: list[int] = [*range(len(known) + 1)]
    for i, letter in enumerate(word, 1):
        earlier, before, row = before, row, [i]
        for j, other in enumerate(known, 1):
            cost: int = min(before[j] + 1, row[j - 1] + 1, before[j - 1] + (letter != other))
            if i > 1 and j > 1 and letter == known[j - 2] and word[i - 2] == other:
                cost = min(cost, earlier[j - 2] + 1)
            row.append(cost)
    return row[-1]
