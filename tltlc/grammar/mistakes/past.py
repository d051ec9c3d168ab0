"""Explain English about the trace so far: `was seen`, `seen at most 3 times`, `seen in the last 5 s`."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.keywords import UNITS_ELSEWHERE
from tltlc.grammar.lexer import END, Token
from tltlc.grammar.mistakes.english_rewrite import clause_keyword
from tltlc.grammar.mistakes.parse_failure import ARITHMETIC, CLOSING, OPENING, ParseFailure, quote_token
from tltlc.grammar.mistakes.rephrasing import formula_start, span_of, suggest_rewrite, text_of

_LETTERS: Final = {"Y": "previously", "O": "once", "H": "historically"}
"""The letters of past operators in the literature."""
_HAS_HELD: Final = ("was", "were", "had", "has", "have", "been", "ever", "already")
_AUXILIARIES: Final = ("had", "has", "have")
"""Words that mean `once` only before `been`: a predicate may be called `has`."""
_TIME_UNITS: Final = ("s", "ms", "min", "h")
_STEPS: Final = ("step", "steps")
_COUNTS: Final = {
    ("at", "most"): "<=",
    ("at", "least"): ">=",
    ("more", "than"): ">",
    **dict.fromkeys((("less", "than"), ("fewer", "than")), "<"),
}
_NUMBERS: Final = {"once": "1", "twice": "2", "thrice": "3"}
_COUNTED: Final = {
    ("keep", "<="): "keep times({p}) <= {n}",
    ("keep", "<"): "keep times({p}) < {n}",
    ("keep", ">="): "reach times({p}) >= {n}",
    ("avoid", ">"): "avoid times({p}) > {n}",
    ("avoid", ">="): "avoid times({p}) >= {n}",
    ("reach", ">="): "reach times({p}) >= {n}",
    ("reach", ">"): "reach times({p}) > {n}",
    ("reach", "<="): "keep times({p}) <= {n}",
    ("never", ">"): "avoid times({p}) > {n}",
    ("never", ">="): "avoid times({p}) >= {n}",
}
"""Clauses for counts in English, by the keyword of the clause and the comparison.

`keep … at least` would have to hold at the first step, too, and `reach … at most` always holds there:
for these, the other clause is meant.
"""


def past_in_english(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for an English phrase about the trace so far, else None."""
    if not failure.wants_operator or failure.previous_token is None or failure.tokens[0].type == "PREDICATE":
        return None
    return _count(failure) or _recent(failure) or _prefix(failure) or _postfix(failure)


def never_counted(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a clause such as ``never seen more than 3 times``, else None."""
    tokens = failure.tokens
    if failure.start != "clause" or tokens[0].text.lower() != "never":
        return None
    end = _operand_end(tokens, 1)
    return None if end is None else _counted(failure, "never", 1, end)


# --- counts -----------------------------------------------------------------------------------------


def _count(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a formula such as ``seen at most 3 times``, else None."""
    first, at = formula_start(failure), failure.stop.index
    keyword, tokens = clause_keyword(failure), failure.tokens
    if tokens[first].text == "never" and keyword in ("keep", "require") and at in (first + 1, first + 2):
        keyword, first = "never", first + 1
        at = _operand_end(tokens, first) or at
    start = _operand_start(tokens, at)
    return None if start is None else _counted(failure, keyword if start == first else "", start, at)


def _counted(failure: ParseFailure, keyword: str, start: int, end: int) -> Diagnostic | None:
    """Return an error for the operand from ``start`` to ``end`` if a count follows, else None.

    ``keyword`` is that of the clause if the operand begins it, else empty.
    """
    tokens = failure.tokens
    sign = _COUNTS.get((tokens[end].text, tokens[end + 1].text)) if end + 1 < len(tokens) else None
    number = _number(tokens, end + 2 if sign else end)
    if number is None or (sign is None and tokens[end].text == "once"):
        return None
    text, stop = number
    operand, span = text_of(failure, start, end), span_of(tokens[end:stop])
    title = f"{quote_token(tokens[end])} is not an operator" if sign else "a count is a comparison"
    is_whole = tokens[stop].type == END
    if text == "1" and (sign or ">=") == ">=" and keyword in ("keep", "reach") and is_whole:
        return failure.error("TLT0101", title, f"write `reach {operand}`", span=span)
    if (form := _COUNTED.get((keyword, sign or (">=" if keyword == "reach" else "")))) and is_whole:
        return failure.error("TLT0101", title, f"write `{form.format(p=operand, n=text)}`", span=span)
    if sign and not keyword:
        return suggest_rewrite(failure, start, stop, f"times({operand}) {sign} {text}", title)
    help_ = f"`times({operand})` is how often it has begun: compare it, as in `times({operand}) >= {text}`"
    return failure.error("TLT0101", title, help_, span=span)


def _number(tokens: Sequence[Token], at: int) -> tuple[str, int] | None:
    """Return the number of `3 times` or `twice` at an index, as digits, and the index after it.

    Return None if there is no such number.
    """
    if at < len(tokens) and tokens[at].text in _NUMBERS:
        return _NUMBERS[tokens[at].text], at + 1
    if at + 1 < len(tokens) and tokens[at].type == "NUMBER" and tokens[at + 1].text in ("times", "time", "x"):
        return tokens[at].text, at + 2
    return None


# --- times ------------------------------------------------------------------------------------------


def _recent(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a formula such as ``seen in the last 5 s``, else None."""
    at, tokens = failure.stop.index, failure.tokens
    words = [token.text for token in tokens[at : at + 3]]
    if words[:1] not in (["in"], ["within"], ["during"], ["for"]) or words[1:] not in (
        ["the", "last"],
        ["the", "past"],
    ):
        return None
    if at + 4 >= len(tokens) or tokens[at + 3].type != "NUMBER":
        return None
    unit = UNITS_ELSEWHERE.get(tokens[at + 4].text.lower(), tokens[at + 4].text)
    start = _operand_start(tokens, at)
    if unit not in (*_TIME_UNITS, *_STEPS) or start is None:
        return None
    operand, time = text_of(failure, start, at), f"{tokens[at + 3].text} {unit}"
    text = f"once within {time} {operand}"
    if words[0] == "for":
        text = f"time_holding({operand}) >= {time}" if unit in _TIME_UNITS else f"historically for {time} {operand}"
    title, before = f"{quote_token(failure.token)} is not an operator", tokens[start - 1].type
    # After `and`, the time may be that of both; `not a for …` may be that of `not a`.
    if start == formula_start(failure) or before == "IMPLIES" or (before == "NOT" and words[0] != "for"):
        return suggest_rewrite(failure, start, at + 5, text, title)
    return failure.error("TLT0101", title, f"if the time is that of `{operand}` alone, write `{text}`")


# --- words ------------------------------------------------------------------------------------------


def _prefix(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a word before its formula, such as ``was seen`` and ``Y seen``, else None."""
    at, tokens = failure.stop.index - 1, failure.tokens
    word = tokens[at].text
    end = _operand_end(tokens, at + 1)
    if tokens[at].type != "NAME" or end is None or at + 1 != failure.stop.index or _is_declared(word, failure):
        return None
    operand, title = text_of(failure, at + 1, end), f"{quote_token(tokens[at])} is not an operator"
    if word in _LETTERS and not _imports(failure):
        return suggest_rewrite(failure, at, end, f"{_LETTERS[word]} {operand}", title)
    if word == "previous":
        around = {tokens[end].type, tokens[at - 1].type if at else ""}
        text = f"previous({operand})" if around & ARITHMETIC else f"previously {operand}"
        return suggest_rewrite(failure, at, end, text, "`previous` takes brackets" if around & ARITHMETIC else title)
    if word in _HAS_HELD and (word not in _AUXILIARIES or tokens[at + 1].text == "been"):
        first = next(index for index in range(at, len(tokens)) if tokens[index].text not in _HAS_HELD)
        if (end := _operand_end(tokens, first)) is not None:
            return failure.error("TLT0101", title, _once_help(text_of(failure, first, end)), span=tokens[at].span)
    return None


def _once_help(operand: str) -> str:
    return f"write `once {operand}`, which is true from the first step with `{operand}` on"


def _postfix(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a word after its formula, such as ``seen S alarm``, ``seen begins`` and ``seen before``."""
    at, tokens = failure.stop.index, failure.tokens
    start, word = _operand_start(tokens, at), failure.token.text
    if start is None:
        return None
    title = f"{quote_token(failure.token)} is not an operator"
    if (
        word == "S"
        and not (_is_declared(word, failure) or _imports(failure))
        and (end := _operand_end(tokens, at + 1)) is not None
    ):
        text = f"{text_of(failure, start, at)} since {text_of(failure, at + 1, end)}"
        return suggest_rewrite(failure, start, end, text, title)
    if word in ("begins", "ends") and _operand_end(tokens, at + 1) is None:
        title = f"{quote_token(failure.token)} stands before its formula"
        return suggest_rewrite(failure, start, at + 1, f"{word} {text_of(failure, start, at)}", title)
    if word == "already":
        return failure.error("TLT0101", title, _once_help(text_of(failure, start, at)))
    return None


def _operand_end(tokens: Sequence[Token], start: int) -> int | None:
    """Return the index after the name or call that begins at an index, perhaps after `not`; None if there is none."""
    if start < len(tokens) and tokens[start].type == "NOT":
        start += 1
    if start >= len(tokens) or tokens[start].type != "NAME":
        return None
    if start + 1 >= len(tokens) or tokens[start + 1].type != "LPAR":
        return start + 1
    depth = 0
    for index in range(start + 1, len(tokens)):
        depth += (tokens[index].type in OPENING) - (tokens[index].type in CLOSING)
        if depth == 0:
            return index + 1
    return None


def _operand_start(tokens: Sequence[Token], stop: int) -> int | None:
    """Return the index of the first token of the name or call that ends before an index; None if there is none."""
    index, depth = stop - 1, 0
    while (index >= 0 and tokens[index].type in CLOSING | set(OPENING)) or depth:
        depth += (tokens[index].type in CLOSING) - (tokens[index].type in OPENING)
        index -= 1
        if depth == 0:
            break
    return index if index >= 0 and tokens[index].type == "NAME" else None


def _is_declared(name: str, failure: ParseFailure) -> bool:
    """Whether the file seems to declare a name."""
    return re.search(rf"\b(?:signal|predicate|let|param|entity)\b[^\n]*\b{name}\b", failure.source.text) is not None


def _imports(failure: ParseFailure) -> bool:
    """Whether the file imports names, among which a single letter may be."""
    return re.search(r"^\s*import\b", failure.source.text, re.MULTILINE) is not None
