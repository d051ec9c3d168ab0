"""Slips of the hand: which word was meant where another one is written.

A word that is like another one may as well mean something else: `doorB` is not `doorA`, `unlocked` not `locked`.  So a
slip is one letter too many, too few or exchanged with its neighbour, or one wrong letter inside of a word that is
long enough; a word of seven letters or more may have two of them.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Final

_SHORT: Final = 3
"""Of so few letters, most words are one letter away from other words, so that only two kinds of slips count."""
_LONG: Final = 7
"""A word of so many letters may have two slips."""
_MOST_COMPARED: Final = 2_000
_PARTS: Final = re.compile(r"[0-9]+|[A-Z]?[a-z]+|[A-Z]+(?![a-z])|[^\W\d_]+")
"""The parts of a name: numbers, words in camel case, capitals, and letters of other alphabets."""
_NEGATING: Final = frozenset(
    ("no", "non", "not", "nt", "never", "dont", "cant", "isnt", "less", "un", "in", "im", "il")
)


def meant(name: str, known: Iterable[str]) -> str | None:
    """The known name that a name is a slip of, where there is one, and no other is as likely.

    A name that differs in capital letters and underscores alone comes first, then one that is it behind a dot.  Among
    more than 2,000 names, no others are looked for.
    """
    names = tuple(dict.fromkeys(known))
    same = [each for each in names if _plain(each) == _plain(name)]
    same = same or [each for each in names if each.endswith(f".{name}")]
    if same or len(names) > _MOST_COMPARED:
        return same[0] if same else None
    slips: dict[int, list[str]] = {}
    for each in names:
        count = _slips_in_parts(name, each)
        if count is not None:
            slips.setdefault(count, []).append(each)
    closest = slips[min(slips)] if slips else []
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
    found = _distance(word, known)
    return found if found <= most else None


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
        found = None if part.isdigit() or other.isdigit() else slips(part.lower(), other.lower())
        if found is None:
            return None
        total += found
    return total


def _begin_alike(word: str, known: str) -> bool:
    """Whether both have the same first letter, or the first two are exchanged."""
    return word[:1] == known[:1] or (word[:2] == known[1::-1] and word[2:3] == known[2:3])


def _ends_differ(word: str, known: str) -> bool:
    """Whether the last letter of all is another one, as in `keyb` for `keya`."""
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
    """Whether one is the other with a syllable that makes the opposite of it, in front or behind."""
    longer, shorter = (word, known) if len(word) > len(known) else (known, word)
    if longer.startswith(shorter):
        return longer[len(shorter) :] in _NEGATING
    return longer.endswith(shorter) and longer[: -len(shorter)] in _NEGATING


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
