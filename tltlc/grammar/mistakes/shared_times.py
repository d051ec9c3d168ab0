"""Explain a time that two formulas share: `avoid a and b within 1 s`, `reach (a then b) within 1 s`."""

from __future__ import annotations

from functools import reduce
from itertools import pairwise

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.mistakes.english_rewrite import FIXED_CLOCK, Time, clause_keyword
from tltlc.grammar.mistakes.one_reading import QUANTIFIERS, has_token, is_of_one_step
from tltlc.grammar.mistakes.parse_failure import CLOSING, INFIX, OPENING, ParseFailure, outer_indices
from tltlc.grammar.mistakes.repeats import TokenRange, begun_again
from tltlc.grammar.mistakes.rephrasing import operand_text, suggest_rewrite, text_of, without_brackets


def shared_time_error(failure: ParseFailure, at: int, operand: TokenRange, time: Time) -> Diagnostic | None:
    """Return an error if a time can be that between two formulas, or that from the first step on, else None.

    ``at`` is the index of the English word, such as `within`, and ``operand`` what it applies to.
    """
    keyword, begin, end = clause_keyword(failure), *without_brackets(failure, *operand)
    joints = [index for index in outer_indices(failure.tokens, begin, end) if failure.tokens[index].type in INFIX]
    kinds = {failure.tokens[index].type for index in joints}
    sides = [(first + 1, last) for first, last in pairwise((begin - 1, *joints, end))]
    if len(kinds) != 1 or has_token(failure, begin, end, QUANTIFIERS):
        return None
    if not all(first < last and is_of_one_step(failure, first, last) for first, last in sides):
        return None
    texts, word, t = [operand_text(failure, *side) for side in sides], failure.tokens[at], time.text
    if keyword == "avoid" and kinds == {"AND"} and word.text in ("within", "in"):
        together = " and ".join(f"(once within {t} {text})" for text in texts)
        help_ = (
            f"write `avoid {together}` if they must not come within {t} of each other, "
            f"`require not eventually within {t} ({' and '.join(texts)})` for the first {t} alone"
        )
        if len(set(texts)) == 1:
            help_ = f"write `{begun_again(texts[0], t)}`"
    elif keyword == "reach" and kinds == {"THEN"}:
        at_the_end = reduce(lambda before, text: f"{text} and previously once {_in_brackets(before)}", texts)
        help_ = (
            f"write `reach {f' then within {t} '.join(texts)}` if the time counts from the goal before, "
            f"`require eventually within {t} ({at_the_end})` if it counts from the first step on"
        )
    elif keyword == "reach" and kinds == {"UNTIL"} and len(texts) == 2:
        help_ = f"write `require ({' until '.join(texts)}) and eventually within {t} {texts[1]}`"
    else:
        return None
    title = failure.misplaced(word)
    return failure.error(
        "TLT0101", title, FIXED_CLOCK if failure.lacks_fixed_clock(time.text) else help_, span=word.span
    )


def _in_brackets(text: str) -> str:
    return f"({text})" if " and previously once " in text else text


def bracketed_time_error(failure: ParseFailure, at: int) -> Diagnostic | None:
    """Return an error for a time in brackets after `then`, as in ``reach a then (within 1 s b)``, else None."""
    tokens = failure.tokens
    if failure.start != "clause" or len(failure.open_brackets) != 1 or not _opens_time(failure, at - 1):
        return None
    stop = len(tokens) - 1
    texts, begin = [], 0
    for opening in [index for index in outer_indices(tokens, 0, stop) if _opens_time(failure, index)]:
        closing = next((index for index in range(opening, stop) if _is_closed(failure, opening, index)), None)
        if closing is None or tokens[opening + 2].type != "NUMBER":
            return None
        second = opening + 3 + (tokens[opening + 3].type in ("UNIT", "NAME"))
        texts += [text_of(failure, begin, opening), text_of(failure, opening + 1, second)]
        texts.append(operand_text(failure, second, closing))
        begin = closing + 1
    text = " ".join((*texts, text_of(failure, begin, stop))).strip()
    return suggest_rewrite(failure, 0, stop, text, "a time after `then` stands without brackets")


def _opens_time(failure: ParseFailure, at: int) -> bool:
    tokens = failure.tokens
    is_opening = at > 0 and tokens[at].type == "LPAR" and tokens[at - 1].type == "THEN"
    return is_opening and tokens[at + 1].text == "within"


def _is_closed(failure: ParseFailure, opening: int, closing: int) -> bool:
    """Whether the bracket at one index is the partner of the bracket at another."""
    inside = [token.type for token in failure.tokens[opening : closing + 1]]
    return inside[-1] in CLOSING and sum((kind in OPENING) - (kind in CLOSING) for kind in inside) == 0
