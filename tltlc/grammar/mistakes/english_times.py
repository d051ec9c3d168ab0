"""Explain times in plain English, after or before their formula: `a within 20 steps`, `for 20 steps a`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.keywords import OPERATORS, UNITS_ELSEWHERE
from tltlc.grammar.lexer import Token
from tltlc.grammar.mistakes.bracketings import time_before_joint, time_before_operator
from tltlc.grammar.mistakes.declared_names import declared_names
from tltlc.grammar.mistakes.english_forms import AFTER_TIME, FOR_TIME, HOLDING, IN_TIME, PAST_TIME, Forms
from tltlc.grammar.mistakes.english_rewrite import (
    FIXED_CLOCK,
    REAL_TIME,
    Parts,
    Time,
    clause_keyword,
    goal_starts,
    rewrite_error,
)
from tltlc.grammar.mistakes.one_reading import (
    QUANTIFIERS,
    TEMPORAL,
    UNCLEAR,
    has_always_before,
    has_token,
    is_clear_time_here,
    is_of_one_step,
)
from tltlc.grammar.mistakes.parse_failure import BEFORE_ONE, INFIX, ParseFailure, quote_token
from tltlc.grammar.mistakes.repeats import begun_again
from tltlc.grammar.mistakes.rephrasing import (
    formula_start,
    formula_stop,
    last_index_of,
    operand_end,
    operand_text,
    span_of,
    suggest_rewrite,
    text_of,
    without_brackets,
)
from tltlc.grammar.mistakes.shared_times import bracketed_time_error, shared_time_error

_UNARY: Final = BEFORE_ONE | {"ALL", "ANY"}


def time_error(failure: ParseFailure, forms: Forms) -> Diagnostic:
    """Return the error for a time after its formula, such as ``reach a within 20 steps``.

    ``forms`` are the ways to write the phrase in the language. The error has a fix if the phrase has
    only one possible meaning.
    """
    at, kind = failure.stop.index, clause_keyword(failure)
    goals, stop = goal_starts(failure, at), formula_stop(failure)
    begin = goals[-1]
    time, end, is_clear_unit = _read_time(failure, at + 1)
    written = time if is_clear_unit else None
    if forms is IN_TIME and kind != "reach" and has_token(failure, begin, at, {"THEN"}):
        return _sequence_error(failure, (begin, end), _shown_time(failure, time, written))
    if is_clear_unit and (error := time_before_operator(failure, at, end, time, forms)):
        return error
    is_last = forms is IN_TIME and is_clear_unit and end == stop
    if is_last and len(goals) == 1 and (error := shared_time_error(failure, at, (begin, at), time)):
        return error
    if is_last and len(goals) == 2 and kind == "reach":
        error = _arrival_error(failure, (goals[0], goals[1], at), time)
        if error is not None:
            return error
    if len(goals) > 1:
        before = operand_text(failure, goals[-2], begin - 1)
        is_clear = not has_token(failure, goals[-2], begin - 1, UNCLEAR | TEMPORAL)
        if len(goals) > 2 and forms is IN_TIME and kind == "reach" and is_clear_unit:
            # The time may be that of the last goal or of all of them.
            return _chain_error(failure, operand_text(failure, begin, at), time)
        form, start = forms["then"], goals[-2]
    elif kind in forms and kind:
        before, form, start, is_clear = "", forms[kind], begin, True
    else:
        # The time applies to the last operand only.
        last = last_index_of(failure, INFIX, begin)
        start = begin = begin if last is None else last + 1
        before, form, is_clear = "", forms[""], _is_clear_time(failure, begin, forms)
        is_clear = is_clear and failure.tokens[begin].type not in _UNARY
        is_clear = is_clear and not has_token(failure, formula_start(failure), at, TEMPORAL | QUANTIFIERS)
    if form == FOR_TIME["reach"] and time.is_real:
        form = HOLDING
    last = last_index_of(failure, INFIX, begin)
    operator = begin if last is None else last + 1
    past = PAST_TIME.get((failure.tokens[operator].type, failure.tokens[at].text))
    if past is not None:
        is_clear = is_clear_unit and end == stop and _is_clear_operand(failure, operator + 1, at)
        parts = Parts(operand_text(failure, operator + 1, at), time.text, "", time)
        return rewrite_error(failure, at, (operator, stop), past, parts if is_clear else None, written)
    if kind == "avoid" and forms is FOR_TIME:
        is_clear = end == stop and _is_clear_operand(failure, begin, at) and failure.tokens[begin].type not in _UNARY
        operand = operand_text(failure, begin, at) if is_clear else "a"
        return _avoided_error(failure, at, operand, _shown_time(failure, time, written))
    is_rule = last is not None and failure.tokens[last].type == "IMPLIES"
    if kind == "keep" and forms is FOR_TIME and not is_rule:
        is_clear = end == stop and _is_clear_operand(failure, begin, at)
        is_clear = is_clear and failure.tokens[begin].type not in _UNARY - {"NOT"}
        part = (begin, at) if is_clear else None
        return _kept_error(failure, at, part, _shown_time(failure, time, written))
    if kind == "keep" and forms is FOR_TIME and last is not None:
        is_clear = is_clear_unit and end == stop and _is_clear_operand(failure, operator, at)
        is_clear = is_clear and failure.tokens[operator].type not in _UNARY - {"NOT"}
        is_clear = is_clear and not has_token(failure, begin, last, UNCLEAR | TEMPORAL)
        return _lasting_error(failure, (operator, at), end, time, is_clear=is_clear)
    if kind != "keep":
        is_clear = is_clear and failure.tokens[begin].type not in _UNARY
    is_clear = is_clear and is_clear_unit and end == stop and _is_clear_operand(failure, begin, at)
    parts = Parts(operand_text(failure, begin, at), time.text, before, time)
    return rewrite_error(failure, at, (start, stop), form, parts if is_clear else None, written)


def prefix_time_error(failure: ParseFailure, at: int, forms: Forms) -> Diagnostic:
    """Return the error for a time before its formula, such as ``reach within 20 steps a``.

    ``at`` is the index of the word before the time, and ``forms`` are the ways to write the phrase in
    the language. The error has a fix if the phrase has only one possible meaning.
    """
    stop, kind, first = formula_stop(failure), clause_keyword(failure), formula_start(failure)
    time, second, is_clear_unit = _read_time(failure, at + 1)
    written = time if is_clear_unit else None
    before, start = "", at
    if failure.tokens[at - 1].type == "ONCE" and forms is IN_TIME and is_clear_unit:
        # The formula after the time may be compared with others.
        span, text = span_of(failure.tokens[at:second]), f"within {time.text}"
        operand = text_of(failure, second, operand_end(failure.tokens, second) or second)
        help_ = f"write `{f'once {text} {operand}'.strip()}`"
        return failure.error("TLT0101", failure.misplaced(failure.tokens[at]), help_, span=span, write=text)
    is_clear = is_clear_unit and _is_clear_operand(failure, second, stop)
    if at == first and kind == "avoid" and forms is FOR_TIME:
        is_clear = _is_clear_operand(failure, second, stop) and failure.tokens[second].type not in _UNARY
        operand = operand_text(failure, second, stop) if is_clear else "a"
        return _avoided_error(failure, at, operand, _shown_time(failure, time, written))
    if at == first and kind == "keep" and forms is FOR_TIME:
        is_clear = _is_clear_operand(failure, second, stop) and failure.tokens[second].type not in _UNARY - {"NOT"}
        part = (second, stop) if is_clear else None
        return _kept_error(failure, at, part, _shown_time(failure, time, written))
    if forms is IN_TIME and is_clear_unit:
        diagnostic = (
            shared_time_error(failure, at, (second, stop), time)
            if at == first and kind
            else bracketed_time_error(failure, at)
        )
        if diagnostic is not None:
            return diagnostic
    if is_clear_unit and (error := time_before_joint(failure, at, second, time, forms)):
        return error
    if at == first:
        form = forms.get(kind, forms[""])
        if form == FOR_TIME["reach"] and time.is_real:
            form = HOLDING
        has_own_form = form != forms[""]
        is_clear = is_clear and (
            has_own_form or (_is_clear_time(failure, at, forms) and not has_token(failure, second, stop, INFIX))
        )
    elif kind == "reach" and failure.tokens[at - 1].type == "THEN":
        start = goal_starts(failure, at)[-2]
        form, before = forms["then"], operand_text(failure, start, at - 1)
        is_clear = is_clear and not has_token(failure, start, at - 1, UNCLEAR | TEMPORAL)
    else:
        form = forms[""]
        is_clear = is_clear and _is_clear_time(failure, at, forms)
        is_clear = is_clear and not has_token(failure, first, stop, {*TEMPORAL, "AND", "OR"})
    parts = Parts(operand_text(failure, second, stop), time.text, before, time)
    return rewrite_error(failure, at, (start, stop), form, parts if is_clear else None, written)


def _chain_error(failure: ParseFailure, goal: str, time: Time) -> Diagnostic:
    """Return the error for a time behind three goals or more: `reach a then b then c within 5 s`."""
    title = failure.misplaced(failure.token)
    if failure.lacks_fixed_clock(time.text):
        return failure.error("TLT0101", title, FIXED_CLOCK)
    help_ = (
        f"write `then within {time.text} {goal}` if the time begins at the goal before, a clause `limit {time.text}` "
        "if it is the time for all of them"
    )
    return failure.error("TLT0101", title, help_)


def _arrival_error(failure: ParseFailure, part: tuple[int, int, int], time: Time) -> Diagnostic | None:
    """Return the error for `reach a then b within 5 s`, whose time may count from the first step with a.

    ``part`` are the indices where the two goals begin, and where the time does. Return None if the first
    goal holds at one step alone, or if a goal is unclear.
    """
    first, second, at = part
    goals = ((first, second - 1), (second, at))
    if failure.tokens[first].type in ("BEGINS", "ENDS") or not all(_is_clear_operand(failure, *goal) for goal in goals):
        return None
    before, goal = (operand_text(failure, *goal) for goal in goals)
    title, rest = failure.misplaced(failure.token), f"then within {time.text} {goal}"
    if failure.lacks_fixed_clock(time.text):
        return failure.error("TLT0101", title, FIXED_CLOCK)
    help_ = (
        f"write `reach begins {before} {rest}` if the time counts from where `{before}` begins, "
        f"`reach {before} {rest}` if from any step with it, such as the last"
    )
    return failure.error("TLT0101", title, help_, span=span_of(failure.tokens[:-1]))


def _kept_error(failure: ParseFailure, at: int, part: tuple[int, int] | None, time: Time) -> Diagnostic:
    """Return the error for `keep a for 3 s`, where ``at`` is the index of `for`, and ``part`` the range of ``a``.

    ``part`` is None if it is unclear what the time applies to.
    """
    parts = Parts(operand_text(failure, *part) if part else "a", time.text, time=time)
    once = parts.a if time.steps == 1 else parts.fill(FOR_TIME["reach"])
    if time.is_real:
        once = replace(parts, a=text_of(failure, *without_brackets(failure, *part)) if part else "a").fill(HOLDING)
    help_ = (
        f"write `reach {once}` if it must hold that long at some time, "
        f"`require {parts.fill(FOR_TIME[''])}` if it must hold from the first step until then"
    )
    if failure.lacks_fixed_clock(time.text):
        help_ = FIXED_CLOCK
    word = failure.tokens[at]
    span = span_of(failure.tokens[:-1]) if part else word.span
    return failure.error("TLT0101", failure.misplaced(word), help_, span=span)


def _lasting_error(failure: ParseFailure, part: tuple[int, int], end: int, time: Time, *, is_clear: bool) -> Diagnostic:
    """Return the error for a time for which something holds where a rule asks for it: `keep a implies b for 3 s`.

    ``part`` is the range of token indices of what holds. The time counts from the step of ``a`` on.
    """
    title, (begin, at) = failure.misplaced(failure.token), part
    if failure.lacks_fixed_clock(time.text):
        return failure.error("TLT0101", title, FIXED_CLOCK)
    operand, text = operand_text(failure, begin, at), f"always for {time.text}"
    help_ = f"write `{text} {operand}`, which counts from that step on"
    if not is_clear:
        return failure.error("TLT0101", title, help_)
    diagnostic = suggest_rewrite(failure, begin, end, f"{text} {operand}", title, ", which counts from that step on")
    return diagnostic or failure.error("TLT0101", title, help_)


def _sequence_error(failure: ParseFailure, part: tuple[int, int], time: Time) -> Diagnostic:
    """Return the error for a time behind a sequence outside `reach`: `avoid a then b within 2 s`.

    ``part`` is the range of token indices of the sequence and its time.
    """
    (begin, end), at, limit = part, failure.stop.index, f"within {time.text}"
    title = failure.misplaced(failure.token)
    if failure.lacks_fixed_clock(limit):
        return failure.error("TLT0101", title, FIXED_CLOCK)
    then = last_index_of(failure, {"THEN"}, begin)
    assert then is not None
    is_clear = failure.token.text in ("within", "in") and end == formula_stop(failure)
    is_clear = is_clear and not has_token(failure, begin, then, {"NOT", *INFIX})
    is_clear = is_clear and is_of_one_step(failure, begin, then) and _is_clear_operand(failure, then + 1, at)
    is_clear = is_clear and not has_token(failure, then + 1, at, {"NOT", *INFIX})
    first, second = (text_of(failure, begin, then), text_of(failure, then + 1, at)) if is_clear else ("a", "b")
    if is_clear and first == second and clause_keyword(failure) == "avoid":
        return suggest_rewrite(failure, 0, end, begun_again(first, time.text), title) or failure.error(
            "TLT0101", title, f"write `{begun_again(first, time.text)}`"
        )
    text = f"{first} then {limit} {second}"
    if failure.tokens[0].text == "keep" and failure.start == "clause":
        help_ = (
            f"write `keep {limit} of {first}, {second}` if `{second}` must answer each `{first}`, `reach {text}` if it "
            "must do so once"
        )
        return failure.error("TLT0101", title, help_)
    diagnostic = suggest_rewrite(failure, begin, end, text, title) if is_clear and clause_keyword(failure) else None
    return diagnostic or failure.error("TLT0101", title, f"write `a then {limit} b` for `a then b {limit}`")


def _is_clear_time(failure: ParseFailure, begin: int, forms: Forms) -> bool:
    """Whether a time, to be written as ``forms`` say, can apply only to the operand that begins at ``begin``."""
    clause = failure.tokens[0].text if failure.start == "clause" else ""
    previous = failure.tokens[begin - 1].type if begin > formula_start(failure) else None
    if clause in ("reach", "avoid"):
        return False
    is_kept = clause == "keep" or has_always_before(failure)
    # These forms require that some step exists. Inside `keep` or `always`, this would add a goal.
    if is_kept and (forms is AFTER_TIME or (previous is None and (clause == "keep" or forms is FOR_TIME))):
        return False
    may_be_negated = forms is IN_TIME
    return previous in (None, "IMPLIES") and is_clear_time_here(
        failure, may_be_negated=may_be_negated, may_be_kept=True
    )


def _is_clear_operand(failure: ParseFailure, start: int, stop: int) -> bool:
    """Whether the tokens from index ``start`` up to ``stop`` are a formula to which a time applies as a whole."""
    is_one = is_of_one_step(failure, start, stop) and not has_token(failure, start, stop, UNCLEAR)
    return is_one and failure.tokens[start].text not in OPERATORS


def time_at(tokens: Sequence[Token], at: int) -> tuple[Time, int] | None:
    """Return the time such as `5 s` or `20 frames` at an index, and the index after it, else None.

    The unit is one of a time, and that of the language: `5 seconds` gives `5 s`.
    """
    if at + 1 >= len(tokens) or tokens[at].type != "NUMBER":
        return None
    unit = UNITS_ELSEWHERE.get(tokens[at + 1].text.lower(), tokens[at + 1].text)
    return (Time(tokens[at].text, unit), at + 2) if unit in (*REAL_TIME, "step", "steps") else None


def until_time(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a time after `until`, as in ``hidden until 5 s``, else None."""
    tokens = failure.tokens
    at = next((index for index in (failure.stop.index, failure.stop.index - 1) if tokens[index].type == "NUMBER"), -1)
    written = time_at(tokens, at)
    if at < 2 or written is None or tokens[at - 1].type not in ("UNTIL", "WEAK_UNTIL"):
        return None
    time, end = written[0].text, written[1]
    if failure.lacks_fixed_clock(time):
        title = f"{quote_token(tokens[at - 1])} stands between two formulas, and `{time}` is a bound in steps"
        return failure.error("TLT0101", title, "write `always for 2 s a` for `a until 2 s`", span=tokens[at - 1].span)
    word, start, keyword = tokens[at - 1], formula_start(failure), clause_keyword(failure)
    title = f"{quote_token(word)} stands between two formulas, and `{time}` is a time"
    last = last_index_of(failure, INFIX - {word.type}, start)
    begin = start if last is None else last + 1
    operand = operand_text(failure, begin, at - 1)
    is_clear = begin == start or tokens[begin - 1].type == "IMPLIES"
    is_clear = is_clear and is_of_one_step(failure, begin, at - 1) and tokens[begin].type != "NOT"
    # `a until 3 s or b` may mean that b ends the time, too.
    is_clear = is_clear and end == formula_stop(failure)
    if not is_clear:
        return failure.error("TLT0101", title, f"write `always for {time} a` for `a until {time}`", span=word.span)
    if begin > start or not keyword:
        text, reason = f"always for {time} {operand}", ", which counts from that step on"
        return suggest_rewrite(failure, begin, end, text, title, reason)
    if keyword == "reach":
        help_ = (
            f"write `require always for {time} {operand}` if it must hold all that time, "
            f"`require eventually within {time} {operand}` if at some step of it"
        )
        return failure.error("TLT0101", title, help_, span=word.span)
    text = f"require always for {time} {'not ' * (keyword == 'avoid')}{operand}"
    return suggest_rewrite(failure, 0, end, text, title)


def never_for_time(failure: ParseFailure) -> Diagnostic | None:
    """Return an error for a clause such as ``never seen for 3 s`` or ``never seen within 3 s``, else None."""
    tokens, stop = failure.tokens, len(failure.tokens) - 1
    if failure.start != "clause" or tokens[0].text.lower() != "never":
        return None
    at = next((i for i in range(2, stop) if tokens[i].text in ("for", "within", "in")), 0)
    written = time_at(tokens, at + 1)
    if not at or written is None or written[1] != stop or not _is_clear_operand(failure, 1, at):
        return None
    if has_token(failure, 1, at, {*INFIX, *QUANTIFIERS, "NOT"}):
        return None
    time, operand, title = written[0], operand_text(failure, 1, at), "a clause cannot begin with `never`"
    if failure.lacks_fixed_clock(time.text):
        return failure.error("TLT0107", title, FIXED_CLOCK, span=tokens[0].span)
    if tokens[at].text != "for":
        text = f"require not eventually within {time.text} {operand}"
        return suggest_rewrite(failure, 0, stop, text, title, code="TLT0107")
    return failure.error("TLT0107", title, _readings_of_avoided(operand, time), span=tokens[0].span)


def _avoided_error(failure: ParseFailure, at: int, operand: str, time: Time) -> Diagnostic:
    """Return the error for `avoid a for 3 s`, where ``at`` is the index of `for`."""
    help_ = FIXED_CLOCK if failure.lacks_fixed_clock(time.text) else _readings_of_avoided(operand, time)
    word = failure.tokens[at]
    return failure.error("TLT0101", failure.misplaced(word), help_, span=word.span)


def _shown_time(failure: ParseFailure, time: Time, written: Time | None) -> Time:
    """Return a time if its unit is certain and a bound can have it, else another one, as an example."""
    if written is not None and float(time.number) and (time.is_real or time.steps):
        return time
    declared = declared_names(failure.source)
    return Time("2", "s") if declared.has_clock or declared.clock_varies else Time("20", "steps")


def _readings_of_avoided(operand: str, time: Time) -> str:
    """Return the help for a time for which something must not hold: `avoid a for 3 s`, `never a for 3 s`."""
    parts = Parts(operand, time.text, time=time)
    form = HOLDING if time.is_real else FOR_TIME["reach"]
    on_end = operand if time.steps == 1 else parts.fill(form)
    return (
        f"write `{parts.fill(FOR_TIME['avoid'])}` if it must not hold from the first step until then, "
        f"`avoid {on_end}` if it must never hold that long"
    )


def _read_time(failure: ParseFailure, at: int) -> tuple[Time, int, bool]:
    """Return the time that begins at index ``at``, the index after the time, and whether its unit is certain.

    A time without a known unit counts in steps. This is certain unless the file declares a clock, or one that varies.
    """
    unit = failure.tokens[at + 1]
    known = UNITS_ELSEWHERE.get(unit.text.lower(), unit.text if unit.type == "UNIT" else "")
    declared = declared_names(failure.source)
    is_clear = bool(known) or not (declared.has_clock or declared.clock_varies)
    return Time(failure.tokens[at].text, known or "steps"), at + 1 + bool(known), is_clear
