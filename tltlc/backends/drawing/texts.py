"""The texts in pictures: labels and guards in the chosen notation, wrapped, without invisible characters."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from itertools import pairwise

from tltlc.automaton.fspa import Notation
from tltlc.automaton.text import guard_text
from tltlc.backends.drawing.folding import DrawnEdge

# Controls, invisible and direction-changing characters, and halves of surrogate pairs.
_unseen = re.compile(
    "[\x00-\x1f\x7f-\x9f\xad\u061c\u180e\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb"
    "\ud800-\udfff\ufffe\uffff\U000e0000-\U000e007f]"
)

BREAK_BEFORE = ("∧", "∨", "⇒", "⇔", "𝒰", "&", "|", "->", "<->", "and", "or", "implies", "iff", "U", "W", "R", "M")


_TIES = frozenset({"not", "<", ">", "<=", ">=", "≤", "≥", "+", "-", "*", "/", "^"})
# Matches text after which a line must not end: it would split a bound from its operand (`F[0,3] p`), the arguments of
# an atom (`near(a, b)`), or the mark of a Rabin pair (`[inf 0]`).
_tied_end = re.compile(r"\]$|\w\([^()]*,$|\[(?:fin|inf)$")


def guards_by_arrow(edges: Iterable[DrawnEdge], notation: Notation) -> Mapping[tuple[int, int], list[str]]:
    """Return the guards of all edges from one state to another as texts, by ``(source, target)``.

    A picture shows these guards on one arrow. Over infinite traces, a guard is followed by the sets
    of Rabin pairs that contain its edge: ``a & b [fin 0] [inf 1]``.
    """
    guards_of_arrow: dict[tuple[int, int], list[str]] = {}
    for edge in edges:
        marks = (f"[{kind} {pair}]" for pair, kind in edge.label.marks)
        text = " ".join([guard_text(edge.label.guard, notation), *marks])
        guards_of_arrow.setdefault((edge.source, edge.target), []).append(text)
    return guards_of_arrow


def escape_invisible(text: str) -> str:
    r"""Return the text with ``\uXXXX`` for characters that are invisible or change the direction of text."""
    return _unseen.sub(lambda match: f"\\u{ord(match.group()):04x}", text)


def wrap_text(text: str, width: int, most_lines: int = 8) -> list[str]:
    """Break a text at blanks into lines of about ``width`` characters.

    A line never ends with an infix operator. Words are not split. Comparisons and lists of
    arguments are not split if they have at most twice the width. Text after ``most_lines`` lines is
    replaced by an ellipsis.
    """
    pieces = _pieces(escape_invisible(" ".join(text.split())).split(" "), 2 * width)
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
    """Join words that must stay on one line, such as ``a``, ``<`` and ``b``, into pieces; return all pieces.

    A piece has up to ``longest`` characters. The word after an infix operator such as ``and`` is
    joined to the operator even if the piece becomes longer.
    """
    pieces = [words[0]]
    for before, word in pairwise(words):
        tied = word in _TIES or before in _TIES or _tied_end.search(pieces[-1]) is not None
        if before in BREAK_BEFORE or (tied and len(pieces[-1]) + 1 + len(word) <= longest):
            pieces[-1] += " " + word
        else:
            pieces.append(word)
    return pieces
