"""Read formulas in the notation of the reference corpus, and the corpus itself.

This reader shares no code with the grammar of the language. So tests and benchmarks can compare the
two.
"""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from tltlc.logic import formula as f
from tltlc.logic.formula import FALSE, TRUE, Formula

_ROOT = Path(__file__).resolve().parent.parent
_SIZES_JSON = _ROOT / "tests" / "corpus" / "sizes.json"
_SIZES_TSV = _ROOT.parent / "shared" / "reference" / "ltlf_sizes.tsv"

_TOKEN = re.compile(
    r"\s*(?:(?P<op><->|->|&&?|\|\|?|!|[FG]\[0,\d+\]|WX(?![\w.])|[XNFGUWRM](?![\w.])|[()])"
    r"|(?P<constant>true|false|[01])(?![\w.])"
    r"|(?P<atom>[A-Za-z_][\w.]*(?:\([\w., -]*\))?)"
    r"|(?P<end>$))"
)
_UNARY = {"!": f.not_, "X": f.next_, "WX": f.weak_next, "N": f.weak_next, "F": f.eventually, "G": f.always}
_NARY = {"&": f.and_, "|": f.or_}
_BINARY = {
    "U": f.until,
    "W": f.weak_until,
    "R": f.release,
    "M": f.strong_release,
    "->": f.implies,
    "<->": f.iff,
}
_STRENGTH = {"<->": 1, "->": 2, "|": 3, "&": 4, "U": 5, "W": 5, "R": 5, "M": 5, "!": 6, "X": 6, "WX": 6, "N": 6}
_STRENGTH |= {"F": 6, "G": 6, "(": 0}


class Entry(NamedTuple):
    """A formula of the corpus, with the sizes of its automaton.

    A size is None if the automaton is too large to check explicitly.
    """

    name: str
    family: str
    formula: Formula
    states: int | None
    transition_based_states: int | None


def read_formula(text: str) -> Formula:
    """Parse a formula.

    A formula has the operators ``! & | -> <-> X WX N F G U W R M F[0,2] G[0,2]``, the constants
    ``true false 1 0``, and names such as ``near(s1)``. Unary operators bind tightest, then ``U W R
    M``, ``&``, ``|``, ``->`` and ``<->``. Binary operators except ``&`` and ``|`` group to the
    right. The time is linear, and there is no recursion. Raises ValueError if the text is not a
    formula.
    """
    operands: list[Formula] = []
    operators: list[str] = []
    position = 0
    operand_next = True
    while True:
        match = _TOKEN.match(text, position)
        if match is None:
            raise ValueError(f"no formula: unexpected text at {position}: {text[position : position + 20]!r}")
        position = match.end()
        kind, token = match.lastgroup, match.group().strip()
        token = {"&&": "&", "||": "|"}.get(token, token)
        prefix = token in _UNARY or token.endswith("]") or token == "("
        if (kind in ("constant", "atom") or prefix) != operand_next:
            raise ValueError(f"no formula: {token or 'the end'} is out of place before {position}")
        if kind == "constant":
            operands.append(TRUE if token in ("true", "1") else FALSE)
            operand_next = False
        elif kind == "atom":
            operands.append(f.atom(token))
            operand_next = False
        elif prefix:
            operators.append(token)
        elif token == ")" or kind == "end":
            _reduce(operands, operators, 0)
            if kind == "end":
                if operators:
                    raise ValueError("no formula: a bracket is not closed")
                return operands[0]
            if not operators:
                raise ValueError(f"no formula: the bracket before {position} was never opened")
            operators.pop()
        else:
            _reduce(operands, operators, _STRENGTH[token])
            operators.append(token)
            operand_next = True


def _reduce(operands: list[Formula], operators: list[str], strength: int) -> None:
    """Apply the operators on the stack that bind tighter than ``strength``."""
    while operators and _STRENGTH.get(operators[-1], _STRENGTH["!"]) > strength:
        operator = operators.pop()
        if operator in _UNARY:
            operands.append(_UNARY[operator](operands.pop()))
        elif operator.endswith("]"):
            operands.append(_bounded(operator[0], int(operator[4:-1]), operands.pop()))
        elif operator in _BINARY:
            right = operands.pop()
            operands.append(_BINARY[operator](operands.pop(), right))
        else:
            count = 2
            while operators and operators[-1] == operator:
                operators.pop()
                count += 1
            operands[-count:] = [_NARY[operator](*operands[-count:])]


def _bounded(operator: str, last: int, body: Formula) -> Formula:
    """Return ``F[0,last] body`` or ``G[0,last] body``."""
    result = body
    for _ in range(last):
        result = f.or_(body, f.next_(result)) if operator == "F" else f.and_(body, f.weak_next(result))
    return result


def corpus() -> Iterator[Entry]:
    """Yield the entries of the reference corpus, in the order of its file.

    The corpus is in one of two files. Yield nothing if neither exists.
    """
    for row in _rows():
        states, transition_based = row.get("states"), row.get("transition_based_states")
        yield Entry(
            row["name"],
            row["family"],
            read_formula(row["formula"]),
            int(states) if states not in (None, "") else None,
            int(transition_based) if transition_based not in (None, "") else None,
        )


def _rows() -> list[dict[str, str]]:
    if _SIZES_JSON.exists():
        content = json.loads(_SIZES_JSON.read_text(encoding="utf-8"))
        rows: list[dict[str, str]] = content if isinstance(content, list) else content["formulas"]
        return rows
    if _SIZES_TSV.exists():
        with _SIZES_TSV.open(encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file, delimiter="\t"))
    return []
