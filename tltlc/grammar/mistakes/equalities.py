"""Explain tests for equality in the syntax of other languages, and in English: `a = 3`, `phase is 3`, `a != true`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic, replacement_fix
from tltlc.grammar.lexer import Token
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.mistakes.one_reading import QUANTIFIERS, has_token
from tltlc.grammar.mistakes.parse_failure import (
    ARITHMETIC,
    BEFORE_ONE,
    CLOSING,
    COMPARISONS,
    INFIX,
    OPENING,
    ParseFailure,
    outer_indices,
    quote_token,
)
from tltlc.grammar.mistakes.rephrasing import (
    formula_start,
    formula_stop,
    operand_end,
    span_of,
    suggest_rewrite,
    text_of,
)

Range = tuple[int, int]
_VALUE: Final = {"NAME", "NUMBER", "UNIT", "TRUE", "FALSE", *ARITHMETIC} - COMPARISONS
_EQUAL_FORM, _UNEQUAL_FORM = "{a} >= {b} and {a} <= {b}", "{a} < {b} or {a} > {b}"
_EQUAL: Final = {"==": _EQUAL_FORM, "=": _EQUAL_FORM, "!=": _UNEQUAL_FORM, "<>": _UNEQUAL_FORM}


def equality(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if parsing failed at a test for equality in the syntax of other languages, else None.

    Examples are ``a == b``, ``a != true``, ``a <> 3`` and ``a = b``.
    """
    sign, at = failure.token.text, failure.stop.index
    is_expectation = failure.tokens[0].text == "expect"
    if sign not in _EQUAL or not (failure.token.type != "EQUAL" or failure.wants_operator or is_expectation):
        return None
    title = f"`{sign}` is not a comparison here" if failure.token.type != "EQUAL" else "`=` is not a comparison"
    if is_expectation:
        return failure.error("TLT0110", title, "compare with `<`, `<=`, `>` or `>=`")
    start, stop = value_end(failure.tokens, at, -1), value_end(failure.tokens, at, 1)
    a, b = text_of(failure, start, at), text_of(failure, at + 1, stop)
    is_unequal, boolean_text = _EQUAL[sign] == _UNEQUAL_FORM, ""
    typed = _typed_equality(failure, (start, at), (at + 1, stop), is_unequal, title, "TLT0110") if a and b else None
    if typed is not None:
        return typed
    if b.lower() in ("true", "false"):
        text, reason = (
            a if (b.lower() == "true") != is_unequal else f"not {a}",
            ": a `bool` signal is an atom by itself",
        )
    else:
        text, reason = _EQUAL[sign].format(a=a, b=b), ""
        is_part = (start, stop) != (formula_start(failure), formula_stop(failure))
        text = f"({text})" if is_part else text
        if b in ("0", "1"):
            boolean_text = a if (b == "1") != is_unequal else f"not {a}"
            reason = f", or `{boolean_text}` if its value is true or false"
        elif _is_atom(failure, start, at) and _is_atom(failure, at + 1, stop):
            boolean_text = f"({a} iff {b})" if is_part or is_unequal else f"{a} iff {b}"
            boolean_text = f"{'not ' * is_unequal}{boolean_text}"
            reason = f", or `{boolean_text}` if both values are true or false"
            choice = f"{a} is {'not ' * is_unequal}{b}"
            reason += f", or `{choice}` if `{b}` is a value of an enum" if b.isidentifier() else ""
    general = f"write `{_EQUAL[sign].format(a='a', b='b')}`; a `bool` signal is an atom by itself"
    diagnostic = suggest_rewrite(failure, start, stop, text, title, reason, "TLT0110") if a and b else None
    if diagnostic and diagnostic.fixes and boolean_text:
        # A predicate can be compared as a number or as a truth value.
        diagnostic = replace(
            diagnostic,
            fixes=(
                *diagnostic.fixes,
                replacement_fix(failure.source, span_of(failure.tokens[start:stop]), boolean_text),
            ),
        )
    return diagnostic or failure.error("TLT0110", title, general)


def _typed_equality(
    failure: ParseFailure, left: Range, right: Range, is_unequal: bool, title: str, code: str
) -> Diagnostic | None:
    """Return an error that shows how to compare an int, an enum or a bool; None if no side is declared as one.

    The sides are ranges of token indices.
    """
    for side, other in ((left, right), (right, left)):
        values = _enum_values(failure, side)
        if not values:
            continue
        value = _value_of(failure, other, values)
        if value is None:
            listed = ", ".join(f"`{name}`" for name in values)
            return failure.error(code, title, f"the values of `{text_of(failure, *side)}` are {listed}")
        text = f"{text_of(failure, *side)} is {'not ' * is_unequal}{value}"
        is_number = failure.tokens[other[0]].type == "NUMBER"
        reason = f": `{value}` is the value with the number {text_of(failure, *other)}" if is_number else ""
        return suggest_rewrite(failure, left[0], right[1], text, title, reason, code)
    if _declared_type(failure, left) == "bool":
        return _bool_error(failure, left, right, is_unequal, title, code)
    if not (_is_whole(failure, left) and _is_whole(failure, right)):
        return None
    text = f"{text_of(failure, *left)} {'!=' if is_unequal else '=='} {text_of(failure, *right)}"
    return suggest_rewrite(failure, left[0], right[1], text, title, code=code)


def _bool_error(
    failure: ParseFailure, left: Range, right: Range, is_unequal: bool, title: str, code: str
) -> Diagnostic | None:
    """Return an error for a bool that is compared with a number or another bool, else None."""
    a, b = text_of(failure, *left), text_of(failure, *right)
    if b in ("0", "1"):
        text, reason = f"{'' if (b == '1') != is_unequal else 'not '}{a}", ": a `bool` signal is an atom by itself"
    elif _declared_type(failure, right) == "bool":
        is_part = (left[0], right[1]) != (formula_start(failure), formula_stop(failure))
        text, reason = f"({a} iff {b})" if is_part or is_unequal else f"{a} iff {b}", ""
        text = f"{'not ' * is_unequal}{text}"
    else:
        return None
    return suggest_rewrite(failure, left[0], right[1], text, title, reason, code)


def _declared_type(failure: ParseFailure, side: Range) -> str:
    """Return the declared type of a name, perhaps with arguments; empty for other texts."""
    is_name = side[0] < side[1] and operand_end(failure.tokens, side[0]) == side[1]
    return declared_names(failure.source).type_of(failure.tokens[side[0]].text) if is_name else ""


def _enum_values(failure: ParseFailure, side: Range) -> tuple[str, ...]:
    """Return the values of an enum that a side is; empty if it is none."""
    is_enum = _declared_type(failure, side) == "enum"
    return declared_names(failure.source).names[failure.tokens[side[0]].text].values if is_enum else ()


def _value_of(failure: ParseFailure, side: Range, values: tuple[str, ...]) -> str | None:
    """Return the value of an enum that a side names, or whose number it is; else None."""
    text = text_of(failure, *side)
    if text.isdecimal() and len(text) < 4 and int(text) < len(values):
        return values[int(text)]
    return text if text in values else None


def _is_whole(failure: ParseFailure, side: Range) -> bool:
    """Whether a side is a name that the text declares as an int, a count, or a whole number."""
    return _declared_type(failure, side) == "int" or text_of(failure, *side).isdecimal()


def _is_atom(failure: ParseFailure, start: int, stop: int) -> bool:
    """Whether the tokens from index ``start`` up to ``stop`` are a name, perhaps with arguments."""
    kinds = [token.type for token in failure.tokens[start:stop]]
    rest = outer_indices(failure.tokens, start + 1, stop)
    return kinds[:1] == ["NAME"] and all(failure.tokens[index].type in ("LPAR", "RPAR") for index in rest)


def verb_is(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for the verb `is`, as in ``seen is true`` or ``seen is not true``, else None."""
    at, after = failure.stop.index, [token.text for token in failure.tokens[failure.stop.index + 1 :]]
    if (
        failure.token.text not in ("is", "are")
        or not failure.wants_operator
        or failure.previous_token is None
        or not after
    ):
        return None
    title = f"{quote_token(failure.token)} is not an operator"
    start = value_end(failure.tokens, at, -1)
    value = text_of(failure, start, at)
    words = {"true": "{}", "false": "not {}", "not": "not {}"}
    diagnostic: Diagnostic | None = None
    second = at + 1 + (after[0] == "not")
    stop = value_end(failure.tokens, second - 1, 1)
    if second + 1 < stop and failure.tokens[second].text in _enum_values(failure, (start, at)):
        unfit, choice = failure.tokens[second + 1], text_of(failure, start, second + 1)
        title = f"{quote_token(unfit)} is not an operator"
        return failure.error("TLT0101", title, f"put `{choice}` in brackets", span=unfit.span)
    typed = _typed_equality(failure, (start, at), (second, stop), after[0] == "not", title, "TLT0101")
    if typed is not None:
        return typed
    if failure.tokens[second].type == "NUMBER":
        form = _UNEQUAL_FORM if after[0] == "not" else _EQUAL_FORM
        text = form.format(a=value, b=text_of(failure, second, stop))
        is_part = (start, stop) != (formula_start(failure), formula_stop(failure))
        diagnostic = suggest_rewrite(failure, start, stop, f"({text})" if is_part else text, title)
    elif after[0] in words:
        stop = at + 2 + (after[0] == "not" and after[1:2] in (["true"], ["false"]))
        text = words[after[0]].format(value)
        # `a or b is false` and `always a is false` may mean all that stands before.
        is_clear = text == value or not has_token(
            failure, formula_start(failure), start, INFIX | BEFORE_ONE | QUANTIFIERS
        )
        if is_clear:
            diagnostic = suggest_rewrite(failure, start, stop, text, title, ": a `bool` signal is an atom by itself")
    help_ = (
        f"write `{value}` to say that it is true, `not {value}` to say that it is not; compare numbers with `<` or `>`"
    )
    return diagnostic or failure.error("TLT0101", title, help_)


def value_end(tokens: Sequence[Token], at: int, step: int) -> int:
    """Return where the value before or after the operator at index ``at`` begins or ends.

    If ``step`` is -1, return the index of the first token of the value before the operator. If ``step``
    is 1, return the index after the last token of the value after the operator.
    """
    index, depth = at + step, 0
    while 0 <= index < len(tokens):
        kind = tokens[index].type
        depth += step * ((kind in OPENING) - (kind in CLOSING))
        if depth < 0 or (depth == 0 and kind not in _VALUE and kind not in OPENING and kind not in CLOSING):
            break
        index += step
    return index + 1 if step < 0 else index
