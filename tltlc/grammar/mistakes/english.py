"""Explain plain English where the language has another form: `if`, `while`, `before`, a bound after its formula."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Final

from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.keywords import CASES, CLAUSES, CONDITIONS, OPERATORS, UNITS_ELSEWHERE
from tltlc.grammar.lexer import Token
from tltlc.grammar.mistakes.one_reading import (
    QUANTIFIERS,
    TEMPORAL,
    UNCLEAR,
    effective_clause,
    has_always_before,
    has_token,
    is_clear_here,
    is_clear_time_here,
    is_clear_word,
    is_of_one_step,
)
from tltlc.grammar.mistakes.place import BEFORE_ONE, INFIX, ParseFailure, declares_clock, outer_indices, quote_token
from tltlc.grammar.mistakes.rephrasing import (
    formula_start,
    formula_stop,
    last_index_of,
    operand_text,
    span_of,
    suggest_rewrite,
)

_FILLERS: Final = frozenset(("the", "an", "to", "be", "being", "either", "both", "first"))
_JOINED: Final[dict[str, Collection[str]]] = {"either": {"OR"}, "both": {"AND"}, "first": {"THEN"}, "to": (), "be": ()}
"""Fillers that can have a meaning of their own, as in `next to` and `not either`.

Each is mapped to the terminals of the operators beside which it adds nothing: `either` adds nothing
to `or`.
"""
_COMPARISONS: Final = {
    ("at", "least"): ">=",
    ("at", "most"): "<=",
    **dict.fromkeys((("more", "than"), ("greater", "than"), ("above",), ("over",), ("exceeds",)), ">"),
    **dict.fromkeys((("less", "than"), ("below",), ("under",)), "<"),
}

Forms = Mapping[str, str]
"""Maps the keyword of a clause to the text by which an English phrase is written in this clause.

The key "" is for all other clauses. ``{a}``, ``{b}`` and ``{c}`` are parts of the phrase. A text
that begins with a keyword replaces the whole clause.
"""

_CONDITION: Final = {"reach": "{a} and {b}", "avoid": "{a} and {b}", "": "{b} implies {a}"}
_SEQUENCE: Final = {"": "{a} then {b}"}
_FORMS: Final[dict[str, Forms]] = {
    **dict.fromkeys((*CONDITIONS, "during"), _CONDITION),
    # Use the weak operators: a `keep` or `avoid` must not turn into a goal.
    "before": {
        "keep": "require {a} weak_until {b}",
        "avoid": "require (not {a}) weak_until {b}",
        **_SEQUENCE,
    },
    "after": {
        "keep": "{b} implies always {a}",
        "avoid": "require always ({b} implies always not {a})",
        "": "{b} then {a}",
    },
    "followed": {"keep": "{a} implies next eventually {b}", **_SEQUENCE},
    "unless": {"reach": "{a} or {b}", "keep": "{a} or {b}", "avoid": "{a} and not {b}", "": "{a} weak_until {b}"},
    "without": {"": "{a} and not {b}"},
    "but": {"": "{a} and {b}"},
    "xor": {"": "not ({a} iff {b})"},
    "xnor": {"": "{a} iff {b}"},
    "nor": {"": "not ({a} or {b})"},
    "nand": {"": "not ({a} and {b})"},
}
"""Maps an English WORD to the ways to write `a WORD b` in the language."""

_IN_TIME: Final = {
    "reach": "require eventually within {b} {a}",
    "avoid": "require not eventually within {b} {a}",
    "then": "{c} and F[1,{end}] {a}",
    "": "eventually within {b} {a}",
}
_FOR_TIME: Final = {
    # After the end of a trace, `always for` requires nothing: one step would satisfy it.
    "reach": "(always for {b} {a}) and next after {less} {a}",
    "keep": "require always for {b} {a}",
    "avoid": "require always for {b} not {a}",
    "then": "{c} then (always for {b} {a}) and next after {less} {a}",
    "": "always for {b} {a}",
}
_AFTER_TIME: Final = {
    "reach": "require next after {b} eventually {a}",
    "keep": "require weak_next after {b} always {a}",
    "avoid": "require weak_next after {b} always not {a}",
    "then": "{c} and next after {b} eventually {a}",
    "": "next after {b} {a}",
}
_TIMES: Final[dict[str, Forms]] = {
    **dict.fromkeys(("within", "in", "before", "by"), _IN_TIME),
    "for": _FOR_TIME,
    "after": _AFTER_TIME,
}
"""Maps an English WORD to the ways to write `a WORD TIME` and `WORD TIME a` in the language.

``{b}`` is the time, ``{end}`` the time as the end of a bound in brackets, and ``{less}`` the time
less one step. The key `then` is for `c then a WORD TIME`. If its text joins ``{c}`` by `and`, the
time begins at the step that reaches ``c``.
"""
_TIMED: Final = {form for forms in _TIMES.values() for form in forms.values()}

_PREFIX: Final = {"reach": "{b} and {a}", "avoid": "{b} and {a}", "": "{b} implies {a}"}
_PREFIXES: Final[dict[str, Forms]] = dict.fromkeys(CONDITIONS, _PREFIX)
"""Maps an English WORD to the ways to write `WORD b, a` and `WORD b then a` in the language."""

_FROM_THEN_ON: Final = {
    "keep": "write `keep b implies a` to require `a` at every step where `b` holds, or `keep b implies always a` to "
    "require it from then on, too",
    "avoid": "write `avoid a and b` to forbid `a` at every step where `b` holds, or `keep b implies always not a` to "
    "forbid it from then on, too",
}
"""Help texts with the two possible meanings of `if b, keep a` and of `if b, avoid a`."""
_REASONS: Final = {
    ("if", "reach"): " for both at the same step, or `{b} then {a}` for one after the other",
    ("when", "reach"): " for both at the same step, or `{b} then {a}` for one after the other",
    ("while", "reach"): " for both at the same step; to require `{b}` at every step, write a clause `keep {b}`",
    ("for", "reach"): "; `always for` requires nothing after the end of play, so `next after` requires the last step",
}
_WHERE: Final = ": where `{b}` holds, `{a}` must hold, too"
_ONCE: Final = "; to require it at every step, write a clause `keep {b} implies {a}`"


def plain_english(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a formula has an English word that is no operator, else None.

    Examples are ``keep a while b`` and ``reach a within 20 steps``.
    """
    if not failure.wants_operator or failure.previous_token is None:
        return None
    for at, untimed_forms in ((failure.stop.index - 1, _PREFIXES), (failure.stop.index, _FORMS)):
        word, following = failure.tokens[at], failure.tokens[at + 1 : at + 2]
        is_timed = word.text in _TIMES and bool(following) and following[0].type == "NUMBER"
        forms = (_TIMES if is_timed else untimed_forms).get(word.text)
        if forms is None or word.type not in ("NAME", "WHEN"):
            continue
        if failure.tokens[0].type == "PREDICATE":
            return failure.error("TLT0101", f"{quote_token(word)} is not an operator", CASES, span=word.span)
        if word.text == "without" and _clause_keyword(failure) in ("reach", "keep"):
            return _without_error(failure)
        report = _time_error if is_timed else _infix_word_error
        return (
            _prefix_word_error(failure, at, forms, timed=is_timed)
            if at < failure.stop.index
            else report(failure, forms)
        )
    return None


def comparison_in_words(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a comparison is in words, else None: ``coins is more than 3``, ``health above 50%``."""
    at = failure.stop.index
    if not failure.wants_operator or failure.token.type != "NAME":
        return None
    words = [token.text for token in failure.tokens[at : at + 3]]
    has_verb = words[0] in ("is", "are")
    for phrase, sign in _COMPARISONS.items():
        length = has_verb + len(phrase)
        if tuple(words[has_verb:length]) != phrase:
            continue
        value = failure.tokens[at + length].type
        if value == "NUMBER" or (value == "NAME" and phrase[0] != "at"):
            title, span = f"{quote_token(failure.token)} is not an operator", span_of(failure.tokens[at : at + length])
            return failure.error("TLT0101", title, f"write `{sign}`", span=span, write=sign)
    return None


def filler_word(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a filler word stands in a formula, else None: ``reach the exit``, ``avoid being seen``."""
    at = failure.stop.index
    for index in (at - 1, at):
        word = failure.tokens[index]
        if failure.wants_operator and index > 0 and word.type == "NAME" and word.text in _FILLERS:
            title, following = f"{quote_token(word)} means nothing here", failure.tokens[index + 1]
            if following.type == "NAME" and _is_clear_filler(failure, index):
                return suggest_rewrite(failure, index, index + 2, following.text, title, " alone") or failure.error(
                    "TLT0101", title, "leave it out", span=word.span
                )
            if following.type == "NAME":
                help_ = "use a predicate, as in `near(a)`"
                if word.text in ("either", "both"):
                    help_ = "put brackets around what it joins, as in `not (a or b)` or `c and (a or b)`"
                return failure.error("TLT0101", f"{quote_token(word)} is not an operator", help_, span=word.span)
    return None


def _is_clear_filler(failure: ParseFailure, at: int) -> bool:
    """Whether the filler word at index ``at`` can be left out.

    It can be left out if it has no other meaning, or if it begins the formula and fits all
    operators of the formula.
    """
    word, kind = failure.tokens[at].text, _clause_keyword(failure)
    if word not in _JOINED:
        return True
    # `reach both a and b` may mean one after the other, and `avoid both a and b` may forbid each of them.
    if at != formula_start(failure) or (word == "both" and kind not in ("keep", "require")):
        return False
    return not has_token(failure, at, formula_stop(failure), INFIX - {*_JOINED[word]})


def condition_line(failure: ParseFailure) -> Diagnostic | None:
    """Return an error if a line of a spec begins with ``if``, ``when``, ``whenever`` or ``while``, else None."""
    forms = {"": "keep {b} implies {a}"}
    return _prefix_word_error(failure, 0, forms, timed=False) if failure.tokens[0].text in _PREFIXES else None


def _without_error(failure: ParseFailure) -> Diagnostic:
    """Return the error for `without` between two formulas, as in ``reach a without b``.

    If the clause can have only one meaning, a fix writes `avoid` in place of `without`.
    """
    help_ = "`avoid`, which begins a separate clause and applies to every step"
    at = failure.stop.index
    goals = _goal_starts(failure, at)
    sides = ((goals[-1], at), (at + 1, formula_stop(failure)))
    is_clear = len(goals) == 1 and is_clear_word(failure, "without", *sides, _clause_keyword(failure))
    write = "avoid" if is_clear else None
    return failure.error(
        "TLT0101", "`without` is not an operator", f"{'write' if is_clear else 'use'} {help_}", write=write
    )


def _infix_word_error(failure: ParseFailure, forms: Forms) -> Diagnostic:
    """Return the error for an English word between two formulas, such as ``keep a while b``."""
    at, kind = failure.stop.index, _clause_keyword(failure)
    begin, stop = _goal_starts(failure, at)[-1], formula_stop(failure)
    second = at + 1 + (failure.tokens[at + 1].text == "by")
    end = next(
        (index for index in outer_indices(failure.tokens, second, stop) if failure.tokens[index].type == "THEN"), stop
    )
    form = forms.get(kind, forms[""])
    parts = _Parts(operand_text(failure, begin, at), operand_text(failure, second, end))
    word = failure.token.text
    is_clear = (
        (end == stop or (kind == "reach" and word not in _OF_THE_REST))
        and (begin == formula_start(failure) or word != "unless")
        and not (" then " in form and kind == "keep")
        and is_clear_word(failure, word, (begin, at), (second, end), kind)
        and is_clear_here(failure, word)
    )
    return _rewrite_error(failure, at, (begin, end), form, parts if is_clear else None)


def _time_error(failure: ParseFailure, forms: Forms) -> Diagnostic:
    """Return the error for a time after its formula, such as ``reach a within 20 steps``."""
    at, kind = failure.stop.index, _clause_keyword(failure)
    goals, stop = _goal_starts(failure, at), formula_stop(failure)
    begin = goals[-1]
    time, end, is_clear_unit = _read_time(failure, at + 1)
    if len(goals) > 1:
        before = operand_text(failure, goals[-2], begin - 1)
        is_clear = not has_token(failure, goals[-2], begin - 1, UNCLEAR | TEMPORAL)
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
    if kind != "keep":
        is_clear = is_clear and failure.tokens[begin].type not in _UNARY
    is_clear = is_clear and is_clear_unit and end == stop and _is_clear_operand(failure, begin, at)
    parts = _Parts(operand_text(failure, begin, at), time.text, before, time)
    return _rewrite_error(failure, at, (start, stop), form, parts if is_clear else None)


def _prefix_word_error(failure: ParseFailure, at: int, forms: Forms, *, timed: bool) -> Diagnostic:
    """Return the error for an English word or a time before its formula: ``reach if b then a``."""
    if timed:
        return _prefix_time_error(failure, at, forms)
    stop, form = formula_stop(failure), forms.get(_clause_keyword(failure), forms[""])
    split = _condition_end(failure, at + 1, stop)
    second = split + (failure.tokens[split].text in _SEPARATORS)
    if _clause_keyword(failure) == "reach":
        # Stop before the next goal.
        stop = next(
            (index for index in outer_indices(failure.tokens, second, stop) if failure.tokens[index].type == "THEN"),
            stop,
        )
    parts = _Parts(operand_text(failure, second, stop), operand_text(failure, at + 1, split))
    previous = failure.tokens[at - 1].type if at > formula_start(failure) else None
    is_clear = previous in _BEFORE_CONDITIONS.get(_clause_keyword(failure), (None, "AND", "OR", "IMPLIES"))
    is_clear = is_clear and is_clear_here(failure, failure.tokens[at].text)
    is_clear = is_clear and not has_token(failure, formula_start(failure), split, TEMPORAL)
    is_clear = is_clear and not (
        _clause_keyword(failure) in ("reach", "avoid") and has_token(failure, second, stop, TEMPORAL)
    )
    # `if a then b until c` may mean a rule that ends at `c`; a keyword would also apply to `until` or `or` after it.
    is_clear = is_clear and not has_token(failure, second, stop, UNCLEAR)
    keyword = failure.tokens[second].text
    if keyword in _FROM_THEN_ON:
        title = (
            f"{quote_token(failure.tokens[at])} is not an operator"
            if at
            else f"a clause cannot begin with {quote_token(failure.tokens[at])}"
        )
        code = "TLT0101" if at else "TLT0107"
        return failure.error(code, title, _FROM_THEN_ON[keyword], span=failure.tokens[at].span)
    if keyword in OPERATORS:
        is_clear = is_clear and keyword == "reach" and failure.tokens[at].text != "while"
        is_clear = is_clear and not has_token(failure, second, stop, INFIX)
    wrapped = form if previous in (None, "THEN") else f"({form})"
    return _rewrite_error(failure, at, (at, stop), wrapped, parts if is_clear else None)


def _prefix_time_error(failure: ParseFailure, at: int, forms: Forms) -> Diagnostic:
    stop, kind, first = formula_stop(failure), _clause_keyword(failure), formula_start(failure)
    time, second, is_clear_unit = _read_time(failure, at + 1)
    before, start = "", at
    is_clear = is_clear_unit and _is_clear_operand(failure, second, stop)
    if at == first:
        form = forms.get(kind, forms[""])
        has_own_form = form != forms[""]
        is_clear = is_clear and (
            has_own_form or (_is_clear_time(failure, at, forms) and not has_token(failure, second, stop, INFIX))
        )
    elif kind == "reach" and failure.tokens[at - 1].type == "THEN":
        start = _goal_starts(failure, at)[-2]
        form, before = forms["then"], operand_text(failure, start, at - 1)
        is_clear = is_clear and not has_token(failure, start, at - 1, UNCLEAR | TEMPORAL)
    else:
        form = forms[""]
        is_clear = is_clear and _is_clear_time(failure, at, forms)
        is_clear = is_clear and not has_token(failure, first, stop, {*TEMPORAL, "AND", "OR"})
    parts = _Parts(operand_text(failure, second, stop), time.text, before, time)
    return _rewrite_error(failure, at, (start, stop), form, parts if is_clear else None)


@record
class _Time:
    """A time: a number as it stands in the text, and a unit of the language."""

    number: str
    unit: str

    @property
    def text(self) -> str:
        return f"{self.number} {self.unit}"

    @property
    def steps(self) -> int | None:
        """The number of steps, or None if the time has another unit or is no whole number."""
        return int(self.number) if self.unit in ("step", "steps") and self.number.isdecimal() else None


@record
class _Parts:
    """The parts of an English phrase `a WORD b` or `c then a WORD b`, as texts.

    ``a`` is a formula, and ``b`` is a formula or a time. ``c`` is the goal before ``a``, and empty
    without one. ``time`` is None if ``b`` is a formula.
    """

    a: str
    b: str
    c: str = ""
    time: _Time | None = None

    def fill(self, form: str) -> str:
        """Return the text ``form`` with the parts in place of ``{a}``, ``{b}``, ``{c}``, ``{end}`` and ``{less}``.

        Returns "" if the form has ``{less}``, but the time is not in steps.
        """
        if self.time is None or self.time.steps is None:
            return "" if "{less}" in form else form.format(a=self.a, b=self.b, c=self.c, end=self.b)
        less = f"{self.time.steps - 1} steps"
        return form.format(a=self.a, b=self.b, c=self.c, end=self.time.number, less=less)


def _rewrite_error(
    failure: ParseFailure, at: int, part: tuple[int, int], form: str, parts: _Parts | None
) -> Diagnostic:
    """Return the error for the English word at index ``at``; it suggests to write ``form`` instead.

    ``part`` is the range of token indices to be replaced, and ``parts`` are the parts that ``form``
    needs. If ``parts`` is None, the text has several meanings; then the help describes the form
    with letters.
    """
    word, kind = failure.tokens[at], _clause_keyword(failure)
    title = f"{quote_token(word)} is not an operator" if at else f"a clause cannot begin with {quote_token(word)}"
    code = "TLT0101" if at else "TLT0107"
    start, stop = part
    is_timed = form in _TIMED
    if _is_clause(form):
        start = 0
    is_zero = is_timed and parts is not None and parts.time is not None and _is_zero(parts.time)
    text = parts.fill(form) if parts and parts.a and parts.b and not is_zero else ""
    if word.text == "before" and form == _SEQUENCE[""]:
        # `b` may be a later goal, or something that must not happen before `a`.
        text = ""
    if parts and text:
        reason = ((word.text == "for" or not is_timed) and _REASONS.get((word.text, kind))) or (
            (_WHERE if _is_of_every_step(failure, at) else _ONCE) if form == _CONDITION[""] else ""
        )
        diagnostic = suggest_rewrite(failure, start, stop, text, title, reason.format(a=parts.a, b=parts.b), code)
        if diagnostic:
            return diagnostic
    return failure.error(code, title, _general_help(failure, at, form), span=word.span)


def _general_help(failure: ParseFailure, at: int, form: str) -> str:
    """Return a help text that shows ``form`` with the letters a, b and c in place of the parts of the text."""
    word, is_timed, is_prefix = failure.tokens[at].text, form in _TIMED, at == 0 or at < failure.stop.index
    time = _Time("20", "steps") if is_timed else None
    parts = _Parts("a", time.text if time else "b", "c", time)
    infix = "followed by" if word == "followed" else word
    english = f"{word} {parts.b}, a" if is_prefix else f"a {infix} {parts.b}"
    if form == _CONDITION[""] and not _is_of_every_step(failure, at):
        return (
            f"for `{english}`, write `b implies a` if it is about one step, a clause `keep b implies a` if it is about "
            "every step, or `a and b` if both must hold"
        )
    if word == "before" and form == _SEQUENCE[""]:
        return (
            "write `a then b` to require `a` and later `b`; if `b` is not required, write `require (not b) until a` to "
            "require `a` first"
        )
    if "{c}" in form:
        english = f"c then {english}"
    kind, text = _clause_keyword(failure), parts.fill(form)
    clause = effective_clause(failure, at)
    if clause != kind and clause in _FORMS.get(word, {}) and not is_timed:
        # The general form would mean something else where this clause applies.
        form = _FORMS[word][clause]
        text = parts.fill(form if _is_clause(form) else f"{clause} {form}")
        return f"write `{text}` for `{clause} {english}`"
    if at and _is_clause(form):
        english = f"{kind} {english}"
    return f"write `{text}` for `{english}`"


_UNARY: Final = BEFORE_ONE | {"ALL", "ANY"}
_BEFORE_CONDITIONS: Final[Mapping[str, tuple[str | None, ...]]] = {
    "reach": (None, "AND", "OR", "THEN"),
    "avoid": (None, "AND", "OR"),
}
"""Maps a clause keyword to the terminals that may stand before `if`.

None stands for the beginning of the formula.
"""
_OF_THE_REST: Final = ("after", "unless", "but")
"""Words that may apply to all goals that follow, or only to the next one."""


def _is_clear_time(failure: ParseFailure, begin: int, forms: Forms) -> bool:
    """Whether a time can apply only to the operand that begins at index ``begin``."""
    clause = failure.tokens[0].text if failure.start == "clause" else ""
    previous = failure.tokens[begin - 1].type if begin > formula_start(failure) else None
    if clause in ("reach", "avoid"):
        return False
    is_kept = clause == "keep" or has_always_before(failure)
    # These forms require a step to exist, which would turn what is kept into a goal.
    if is_kept and (forms is _AFTER_TIME or (previous is None and (clause == "keep" or forms is _FOR_TIME))):
        return False
    may_be_negated = forms is _IN_TIME
    return previous in (None, "IMPLIES") and is_clear_time_here(
        failure, may_be_negated=may_be_negated, may_be_kept=True
    )


def _is_clear_operand(failure: ParseFailure, start: int, stop: int) -> bool:
    """Whether a time can apply to all tokens from index ``start`` up to ``stop`` together."""
    is_one = is_of_one_step(failure, start, stop) and not has_token(failure, start, stop, UNCLEAR)
    return is_one and failure.tokens[start].text not in OPERATORS


def _goal_starts(failure: ParseFailure, at: int) -> list[int]:
    """Return the indices at which the goals of a `reach` clause begin, as far as they are before index ``at``.

    In other clauses, return only the index at which the formula begins.
    """
    start = formula_start(failure)
    if _clause_keyword(failure) != "reach":
        return [start]
    thens = (index for index in outer_indices(failure.tokens, start, at) if failure.tokens[index].type == "THEN")
    return [start, *(index + 1 for index in thens)]


def _is_of_every_step(failure: ParseFailure, at: int) -> bool:
    """Whether the condition at index ``at`` is certainly about every step; if False, it may be about one step."""
    is_kept = failure.tokens[0].text == "keep" and failure.start == "clause"
    return at == 0 or ((is_kept or has_always_before(failure)) and is_clear_here(failure, failure.tokens[at].text))


def _is_clause(form: str) -> bool:
    return form.split()[0] in CLAUSES


def _is_zero(time: _Time) -> bool:
    return not float(time.number)


def _clause_keyword(failure: ParseFailure) -> str:
    """Return the keyword of the clause whose formula is broken, or "".

    It is "" if parsing failed inside brackets, or outside a clause.
    """
    return failure.tokens[0].text if failure.start == "clause" and not failure.open_brackets else ""


def _read_time(failure: ParseFailure, at: int) -> tuple[_Time, int, bool]:
    """Return the time at index ``at``, the index after it, and whether its unit is certain."""
    unit = failure.tokens[at + 1]
    known = UNITS_ELSEWHERE.get(unit.text.lower(), unit.text if unit.type == "UNIT" else "")
    is_clear = bool(known) or not declares_clock(failure.source)
    return _Time(failure.tokens[at].text, known or "steps"), at + 1 + bool(known), is_clear


_SEPARATORS: Final = ("then", ",", ":")


def _condition_end(failure: ParseFailure, start: int, stop: int) -> int:
    """Return the index where a condition that begins at index ``start`` ends.

    The condition ends at `then`, a comma or a colon. Without one of these, it ends after a name and
    its arguments.
    """
    for index in outer_indices(failure.tokens, start, stop):
        if failure.tokens[index].text in _SEPARATORS:
            return index
    name = start + (failure.tokens[start].type == "NOT")
    following: Token | None = failure.tokens[name + 1] if name + 1 < stop else None
    if following is None or following.type != "LPAR":
        return min(name + 1, stop)
    return next((index + 1 for index in outer_indices(failure.tokens, name + 1, stop) if index > name + 1), stop)
