"""The texts in pictures: labels and guards in the notation asked for, wrapped, with nothing invisible in them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from itertools import pairwise

from tltlc.automaton.fspa import Edge, Fspa, Text
from tltlc.backends import Notation

_OPERATORS: dict[Notation, dict[str, str]] = {
    "unicode": {"!": "¬", "&": "∧", "|": "∨", "->": "⇒", "<->": "⇔", "true": "⊤", "false": "⊥"},
    "ascii": {},
    "english": {"!": "not ", "&": "and", "|": "or", "->": "implies", "<->": "iff"},
}

# Controls, invisible and direction-changing characters, and halves of surrogate pairs.
_unseen = re.compile(
    "[\x00-\x1f\x7f-\x9f\xad\u061c\u180e\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb"
    "\ud800-\udfff\ufffe\uffff\U000e0000-\U000e007f]"
)

BREAK_BEFORE = ("∧", "∨", "⇒", "⇔", "𝒰", "&", "|", "->", "<->", "and", "or", "implies", "iff", "U", "W", "R", "M")


_TIES = frozenset({"not", "<", ">", "<=", ">=", "≤", "≥", "+", "-", "*", "/", "^"})
# The end of a line that goes on inside a bound, `F[0,3] p`, between the arguments of an atom, `near(a, b)`, or inside
# the mark of a pair, `[inf 0]`.
_tied_end = re.compile(r"\]$|\w\([^()]*,$|\[(?:fin|inf)$")


def label(text: Text, notation: Notation) -> str:
    """A formula in the notation asked for."""
    return {"unicode": text.unicode, "ascii": text.ascii, "english": text.english}[notation]


class Guards:
    """Guards' texts in a notation; the names of an automaton's atoms are kept as they are."""

    def __init__(self, fspa: Fspa, notation: Notation) -> None:
        names = sorted((atom.name for atom in fspa.atoms), key=len, reverse=True)
        # Longer tokens first, so that no operator is found inside a name, nor `->` inside `<->`.
        tokens = [*map(re.escape, names), "<->", "->", "[!&|]", r"\b(?:true|false)\b"]
        self._tokens = re.compile("|".join(tokens))
        self._operators = _OPERATORS[notation]
        self._names = frozenset(names)

    def text(self, guard: str) -> str:
        """The guard, which is given in the ASCII notation of artefacts."""
        return self._tokens.sub(lambda match: self._token(match.group()), guard)

    def _token(self, token: str) -> str:
        return token if token in self._names else self._operators.get(token, token)


def arrows(fspa: Fspa, edges: Iterable[Edge], notation: Notation) -> Mapping[tuple[int, int], list[str]]:
    """Of each source and target the guards of the edges between them; several, which differ in their pairs, share
    one arrow over infinite traces.
    """
    guards = Guards(fspa, notation)
    found: dict[tuple[int, int], list[str]] = {}
    for edge in edges:
        found.setdefault((edge.source, edge.target), []).append(guards.text(edge.guard.text))
    return found


def visible(text: str) -> str:
    r"""The text with every character that would not be seen, or would reorder the others, spelt out as ``\uXXXX``."""
    return _unseen.sub(lambda match: f"\\u{ord(match.group()):04x}", text)


def wrapped(text: str, width: int, most_lines: int = 8) -> list[str]:
    """The text on lines of about ``width`` characters, broken at blanks and before infix operators.

    No word is split, and no comparison nor list of arguments of up to two widths.  What goes beyond ``most_lines`` is
    cut and marked by an ellipsis.
    """
    pieces = _pieces(visible(" ".join(text.split())).split(" "), 2 * width)
    lines = [pieces[0]]
    for word in pieces[1:]:
        if len(lines[-1]) + 1 + len(word) <= width:
            lines[-1] += " " + word
        else:
            lines.append(word)
    if len(lines) > most_lines:
        lines = [*lines[: most_lines - 1], lines[most_lines - 1] + " …"]
    return lines


def _pieces(words: list[str], longest: int) -> list[str]:
    """The words, those that belong on one line put together unless they get longer than ``longest``."""
    pieces = [words[0]]
    for before, word in pairwise(words):
        tied = word in _TIES or before in _TIES or _tied_end.search(pieces[-1]) is not None
        if before in BREAK_BEFORE or (tied and len(pieces[-1]) + 1 + len(word) <= longest):
            pieces[-1] += " " + word
        else:
            pieces.append(word)
    return pieces
