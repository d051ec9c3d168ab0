"""Find the known word that a misspelt word is meant to be.

A word that resembles a known word may have its own meaning: `doorB` is not `doorA`, and `unlocked` is
not `locked`. So only these count as typos: one letter too many, one too few, two exchanged
neighbours, or one wrong letter that is neither the first nor the last. A known word of at most
three letters allows fewer kinds of typos. One of seven letters or more may have two typos.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Final

_SHORT: Final = 3
"""The greatest length of a short word.

Most short words are one letter away from another word. So only two exchanged neighbours, or a
doubled letter, count as a typo in a short word.
"""
_LONG: Final = 7
"""The fewest letters of a word that may have two typos."""
_MOST_COMPARED: Final = 2_000
_PARTS: Final = re.compile(r"[0-9]+|[A-Z]?[a-z]+|[A-Z]+(?![a-z])|[^\W\d_]+")
"""The parts of a name: numbers, words in camel case, capitals, and letters of other alphabets."""
_NEGATING: Final = ("no", "nt")
"""Endings that negate a word and are at most two letters long."""


def likely_name(name: str, known: Iterable[str]) -> str | None:
    """Return the known name that ``name`` equals or most likely misspells, or None.

    The result is the first of these that exists:

    - the first known name that differs at most in capital letters and underscores;
    - the first known name that ends with a dot and ``name``, such as ``st.near`` for ``near``;
    - the known name with the fewest typos, if no other name has as few. With more than 2,000 known
      names, this choice is left out.
    """
    names = tuple(dict.fromkeys(known))
    matches = [candidate for candidate in names if _plain(candidate) == _plain(name)]
    matches = matches or [candidate for candidate in names if candidate.endswith(f".{name}")]
    if matches or len(names) > _MOST_COMPARED:
        return matches[0] if matches else None
    by_count: dict[int, list[str]] = {}
    for candidate in names:
        count = _count_typos_in_parts(name, candidate)
        if count is not None:
            by_count.setdefault(count, []).append(candidate)
    closest = by_count[min(by_count)] if by_count else []
    return closest[0] if len(closest) == 1 else None


def count_typos(word: str, known: str) -> int | None:
    """Return how many typos turn ``known`` into ``word``: 0 if they are equal, None if they are different words.

    The docstring of this module says what counts as a typo.
    """
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


def _count_typos_in_parts(name: str, known: str) -> int | None:
    """Return how many typos turn ``known`` into ``name``, compared word by word.

    ``nearDoor`` and ``near_door`` have two words. Return None if a word is no misspelling of the word
    at the same place in the other name. Also return None if the two names differ in their digits,
    their number of words or their number of dots.
    """
    if name.count(".") != known.count("."):
        return None
    parts, known_parts = _PARTS.findall(name), _PARTS.findall(known)
    if len(parts) != len(known_parts):
        return None
    total = 0
    for part, known_part in zip(parts, known_parts, strict=True):
        if part.lower() == known_part.lower():
            continue
        count = None if part.isdigit() or known_part.isdigit() else count_typos(part.lower(), known_part.lower())
        if count is None:
            return None
        total += count
    return total


def _begin_alike(word: str, known: str) -> bool:
    """Whether both words have the same first letter, or begin with the same two letters in exchanged order.

    In the second case, the third letters must be the same, too.
    """
    return word[:1] == known[:1] or (word[:2] == known[1::-1] and word[2:3] == known[2:3])


def _ends_differ(word: str, known: str) -> bool:
    """Whether only the last letter differs, as in `keyb` for `keya`."""
    return len(word) == len(known) and word[:-1] == known[:-1] and word != known


def _is_exchanged(word: str, known: str) -> bool:
    """Whether the words differ by two neighbouring letters in exchanged order."""
    places = [at for at, (a, b) in enumerate(zip(word, known, strict=False)) if a != b]
    if len(word) != len(known) or len(places) != 2 or places[1] != places[0] + 1:
        return False
    first, second = places
    return word[first] == known[second] and word[second] == known[first]


def _is_doubled(word: str, known: str) -> bool:
    """Whether the word is the known word with one letter doubled."""
    return len(word) == len(known) + 1 and any(word == known[: at + 1] + known[at:] for at in range(len(known)))


def _is_negated(word: str, known: str) -> bool:
    """Whether one word is the other one with a negating ending, as in ``hasnt`` for ``has``.

    Negating prefixes need no check, because a word with another beginning is never a typo.
    """
    longer, shorter = (word, known) if len(word) > len(known) else (known, word)
    return longer.startswith(shorter) and longer[len(shorter) :] in _NEGATING


def _distance(word: str, known: str) -> int:
    """Return the number of letters that are wrong, missing, added or exchanged with a neighbour.

    This is the optimal string alignment distance.
    """
    before: list[int] = []
    row: list[int] = [*range(len(known) + 1)]
    for i, letter in enumerate(word, 1):
        earlier, before, row = before, row, [i]
        for j, known_letter in enumerate(known, 1):
            cost: int = min(before[j] + 1, row[j - 1] + 1, before[j - 1] + (letter != known_letter))
            if i > 1 and j > 1 and letter == known[j - 2] and word[i - 2] == known_letter:
                cost = min(cost, earlier[j - 2] + 1)
            row.append(cost)
    return row[-1]
