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
)
from tltlc.grammar.mistakes.rephrasing import (
    formula_start,
    formula_stop,
    operand_end,
    span_of,
    suggest_rewrite,
    text_of,
)
from tltlc.grammar.mistakes.sentences.words import NUMBER_WORDS
from tltlc.grammar.typos import likely_name

Range = tuple[int, int]
_VALUE: Final = {"NAME", "NUMBER", "UNIT", "TRUE", "FALSE", *ARITHMETIC} - COMPARISONS
_WHOLE_SIGNS: Final = {"PLUS", "MINUS", "TIMES_SIGN", "UNIT", "LPAR", "RPAR"}
"""The tokens beside names and numbers with which whole numbers stay whole."""
_FUNCTIONS: Final = ("previous", "initial", "highest", "lowest")
"""The functions whose value is that of a number at some step."""
VERBS: Final = ("is", "are", "equals", "equal")
_WORDS_OF_EQUALITY: Final = ("equal", "to", "exactly")
_EQUAL_FORM, _UNEQUAL_FORM = "{a} >= {b} and {a} <= {b}", "{a} < {b} or {a} > {b}"
_EQUAL: Final = {"==": _EQUAL_FORM, "=": _EQUAL_FORM, "!=": _UNEQUAL_FORM, "<>": _UNEQUAL_FORM, "≠": _UNEQUAL_FORM}


def equality(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if parsing failed at a test for equality in the syntax of other languages, else None.

    Examples are ``a == b``, ``a != true``, ``a <> 3`` and ``a = b``.
    """
    sign, at = failure.token.text, failure.stop.index
    is_expectation = failure.tokens[0].text == "expect"
    if sign not in _EQUAL or not (failure.token.type != "EQUAL" or failure.wants_operator or is_expectation):
        return None
    is_known = sign in ("==", "!=")
    title = f"`{sign}` compares whole numbers only" if is_known else f"the language has no comparison `{sign}`"
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
        at_end = _sign_at_end(failure, (start, at), b, is_unequal)
        text, reason = f"{a} {at_end} {b}" if at_end else _EQUAL[sign].format(a=a, b=b), ""
        if at_end:
            reason = f": the range of `{a}` ends there"
        is_part = (start, stop) != (formula_start(failure), formula_stop(failure))
        text = f"({text})" if is_part and not at_end else text
        if at_end:
            boolean_text = ""
        elif b.isdecimal() and _may_be_int(failure, (start, at)):
            name = failure.tokens[start].text
            ends = ", ".join(declared_names(failure.source).names[name].ends)
            help_ = f"declare whole numbers as such: `signal {name}: int in [{ends}]`; then `{a} {sign} {b}` is right"
            span = span_of(failure.tokens[start:stop])
            return failure.error("TLT0110", title, help_, span=span)
        elif b in ("0", "1") and not _is_number_signal(failure, (start, at)):
            boolean_text = a if (b == "1") != is_unequal else f"not {a}"
            reason = f", or `{boolean_text}` if its value is true or false"
        elif _are_numbers(failure, (start, at), (at + 1, stop)):
            reason = ""  # neither true or false, nor a value
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
        return _rewrite(failure, left[0], right[1], text, title, reason, code)
    if _declared_type(failure, left) == "bool":
        return _bool_error(failure, left, right, is_unequal, title, code)
    if not (_is_whole(failure, left) and _is_whole(failure, right)):
        return None
    text = f"{text_of(failure, *left)} {'!=' if is_unequal else '=='} {text_of(failure, *right)}"
    return _rewrite(failure, left[0], right[1], text, title, "", code)


def _rewrite(failure: ParseFailure, start: int, stop: int, text: str, title: str, reason: str, code: str) -> Diagnostic:
    """Return an error with the fix ``text``, even if the clause has another mistake, such as a second `=`."""
    diagnostic = suggest_rewrite(failure, start, stop, text, title, reason, code)
    span = span_of(failure.tokens[start:stop])
    return diagnostic or failure.error(code, title, f"write `{text}`{reason}", span=span, write=text)


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


def _sign_at_end(failure: ParseFailure, side: Range, value: str, is_unequal: bool) -> str:
    """Return the sign that compares a number with an end of its range: ``x >= 3`` for `x == 3` in [0, 3]; else ""."""
    declared = declared_names(failure.source).names.get(failure.tokens[side[0]].text)
    if declared is None or len(declared.ends) != 2 or not _declared_type(failure, side):
        return ""
    low, high = (value in (end, end.split()[0]) for end in declared.ends)
    if low == high:
        return ""
    return {(True, False): "<=", (True, True): ">", (False, False): ">=", (False, True): "<"}[low, is_unequal]


def _is_number_signal(failure: ParseFailure, side: Range) -> bool:
    """Whether a side is a signal that is declared as a number."""
    declared = declared_names(failure.source).names.get(failure.tokens[side[0]].text)
    return declared is not None and declared.keyword == "signal" and declared.type not in ("bool", "")


def _are_numbers(failure: ParseFailure, *sides: Range) -> bool:
    """Whether sides are names that are declared as numbers, perhaps in `previous(…)` or another function."""
    return all(_is_declared_number(failure, side) for side in sides)


def _is_declared_number(failure: ParseFailure, side: Range) -> bool:
    start, stop = side
    is_call = stop == start + 4 and failure.tokens[start].text in _FUNCTIONS
    declared = declared_names(failure.source).names.get(failure.tokens[start + 2 * is_call].text)
    return declared is not None and declared.type not in ("bool", "enum", "")


def _may_be_int(failure: ParseFailure, side: Range) -> bool:
    """Whether a side is a signal without a type whose range has whole ends, so that it may be meant as an int."""
    declared = declared_names(failure.source).names.get(failure.tokens[side[0]].text)
    if declared is None or side[1] != side[0] + 1 or declared.keyword != "signal" or declared.type != "number":
        return False
    return len(declared.ends) == 2 and all(end.replace("- ", "").isdecimal() for end in declared.ends)


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


def _types(failure: ParseFailure, side: Range) -> set[str]:
    """Return the types of the names and numbers from which a side is computed: ``int``, ``number``, ``bool``, ….

    The type is empty for names without a known type, and for what is no part of a computation.
    """
    tokens, (index, stop) = failure.tokens, side
    types: set[str] = set()
    while index < stop:
        kind, end = tokens[index].type, operand_end(tokens, index)
        if kind == "NAME" and end is not None:
            types.add(declared_names(failure.source).type_of(tokens[index].text))
            index = end
            continue
        if kind == "NUMBER":
            types.add("int" if tokens[index].text.isdecimal() and tokens[index + 1].type != "UNIT" else "number")
        elif kind in ("DIVIDE", "POWER"):
            types.add("number")
        elif kind not in _WHOLE_SIGNS:
            types.add("")
        index += 1
    return types


def _is_whole(failure: ParseFailure, side: Range) -> bool:
    """Whether a side is computed from ints, counts and whole numbers alone."""
    return _types(failure, side) == {"int"}


def _is_number(failure: ParseFailure, side: Range) -> bool:
    """Whether a side is computed from numbers alone, as far as the text declares them."""
    types = _types(failure, side)
    return bool(types) and not types & {"", "bool", "enum"}


def _is_atom(failure: ParseFailure, start: int, stop: int) -> bool:
    """Whether the tokens from index ``start`` up to ``stop`` are a name, perhaps with arguments."""
    kinds = [token.type for token in failure.tokens[start:stop]]
    rest = outer_indices(failure.tokens, start + 1, stop)
    return kinds[:1] == ["NAME"] and all(failure.tokens[index].type in ("LPAR", "RPAR") for index in rest)


def verb_is(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a verb of equality, as in ``seen is true`` or ``lives is not 3``, else None."""
    tokens, at = failure.tokens, failure.stop.index
    is_after_value = failure.wants_operator or failure.allowed_terminals & COMPARISONS
    if failure.token.text not in VERBS or not is_after_value or failure.previous_token is None:
        return None
    is_unequal = tokens[at + 1].text == "not"
    second = at + 1 + is_unequal
    while tokens[second].text in _WORDS_OF_EQUALITY:
        second += 1
    start, stop = value_end(tokens, at, -1), value_end(tokens, second - 1, 1)
    title = failure.misplaced(failure.token)
    diagnostic = (
        _typed_equality(failure, (start, at), (second, stop), is_unequal, title, "TLT0101")
        or _equal_numbers(failure, (start, at), (second, stop), is_unequal, title)
        or _truth(failure, start, title)
        or _enum_error(failure, start, second, title)
    )
    if diagnostic is not None:
        return diagnostic
    number = NUMBER_WORDS.get(tokens[second].text, "") if stop == second + 1 else ""
    if number and _types(failure, (start, at)) == {"int"}:
        text = f"{text_of(failure, start, at)} {'!=' if is_unequal else '=='} {number}"
        return suggest_rewrite(failure, start, stop, text, title)
    if _is_number(failure, (start, at)):
        return failure.error("TLT0101", title, "compare numbers with `<`, `<=`, `>` or `>=`, whole ones also with `==`")
    value = text_of(failure, start, at)
    help_ = (
        f"write `{value}` to say that it is true, `not {value}` to say that it is not; compare numbers with `<` or `>`"
    )
    return failure.error("TLT0101", title, help_)


def _equal_numbers(failure: ParseFailure, left: Range, right: Range, is_unequal: bool, title: str) -> Diagnostic | None:
    """Return an error for ``health is 3``, which shows the two comparisons that mean the same; else None."""
    has_name = any(token.type == "NAME" for token in failure.tokens[right[0] : right[1]])
    is_computed = _is_number(failure, left) or not (has_name or _types(failure, left) & {"bool", "enum"})
    if not is_computed or not _is_number(failure, right):
        return None
    form = _UNEQUAL_FORM if is_unequal else _EQUAL_FORM
    text = form.format(a=text_of(failure, *left), b=text_of(failure, *right))
    is_part = (left[0], right[1]) != (formula_start(failure), formula_stop(failure))
    return suggest_rewrite(failure, left[0], right[1], f"({text})" if is_part else text, title)


def _truth(failure: ParseFailure, start: int, title: str) -> Diagnostic | None:
    """Return an error for ``seen is true`` or ``seen is not true``, else None; ``start`` is the index of the value."""
    tokens, at = failure.tokens, failure.stop.index
    is_negated = tokens[at + 1].text == "not"
    word = tokens[at + 1 + is_negated].text
    is_word = word in ("true", "false")
    stop = at + 1 + is_negated + is_word
    # What follows, as in `x is not -3`, would become a part of the value.
    if stop == at + 1 or tokens[stop].type in _VALUE:
        return None
    value = text_of(failure, start, at)
    text = f"not {value}" if is_negated != (word == "false") else value
    # `a or b is false` and `always a is false` may mean all that stands before.
    is_clear = text == value or not has_token(failure, formula_start(failure), start, INFIX | BEFORE_ONE | QUANTIFIERS)
    reason = ": a `bool` signal is an atom by itself"
    return suggest_rewrite(failure, start, stop, text, title, reason) if is_clear else None


def _enum_error(failure: ParseFailure, start: int, second: int, title: str) -> Diagnostic | None:
    """Return an error for a test of a misspelt enum, as in ``Mode is alert``, or of `previous`, else None.

    ``start`` is the index of the first token, and ``second`` that of the value.
    """
    tokens, at = failure.tokens, failure.stop.index
    declared, word = declared_names(failure.source), tokens[start].text
    value = tokens[second].text
    enums = {name: known.values for name, known in declared.names.items() if value in known.values}
    is_previous = word == "previous" and word not in declared.names and at == start + 4
    if is_previous and tokens[start + 2].text in enums:
        test = f"{tokens[start + 2].text} {text_of(failure, at, second + 1)}"
        return failure.error("TLT0101", title, f"write `previously ({test})`, which is false at the first step")
    name = likely_name(word, enums) if at == start + 1 and word not in declared.names else None
    if name is None:
        return None
    return failure.error(
        "TLT0101", f"`{word}` is not declared", None, f"did you mean `{name}`?", tokens[start].span, write=name
    )


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
