"""Suggest how to write an English phrase, such as `a while b`, in the language."""

from __future__ import annotations

from typing import Final

from tltlc.core.record import record, replace
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.mistakes.english_forms import CONDITION, FORMS, HOLDING, SEQUENCE, TIMED, Form
from tltlc.grammar.mistakes.one_reading import effective_clause, has_always_before, is_clear_here
from tltlc.grammar.mistakes.parse_failure import ParseFailure, outer_indices, quote_token
from tltlc.grammar.mistakes.rephrasing import formula_start, suggest_rewrite, text_of

_REASONS: Final = {
    ("if", "reach"): " for both at the same step, or `{head}{b} then {a}` for one after the other",
    ("when", "reach"): " for both at the same step, or `{head}{b} then {a}` for one after the other",
    ("while", "reach"): " for both at the same step; to require `{b}` at every step, write a clause `keep {b}`",
    ("for", "reach"): "; `always for` requires nothing after the end of play, so `next after` requires the last step",
}
_WHERE: Final = ": where `{b}` holds, `{a}` must hold, too"
FIXED_CLOCK: Final = "this needs a fixed clock: declare the rate of the game, e.g. `clock 60 Hz`"
REAL_TIME: Final = ("s", "ms", "min", "h")
"""The units of times in the language, apart from steps."""
_ONCE: Final = "; to require it at every step, write a clause `keep {b} implies {a}`"


def rewrite_error(
    failure: ParseFailure, at: int, part: tuple[int, int], form: Form, parts: Parts | None, time: Time | None = None
) -> Diagnostic:
    """Return the error for the English word at index ``at``, which suggests to write ``form`` instead.

    ``part`` is the range of token indices to be replaced. ``parts`` are the texts that ``form`` needs;
    None if the phrase may mean several things. Then the error has no fix, and its help shows the form
    with the letters a, b and c. ``time`` is the time in the phrase, None if it has no certain unit.
    """
    word, kind = failure.tokens[at], clause_keyword(failure)
    title = failure.misplaced(word) if at else f"a clause cannot begin with {quote_token(word)}"
    code = "TLT0101" if at else "TLT0107"
    start, stop = part
    is_timed = form in TIMED
    if form.clause:
        start = 0
    is_zero = is_timed and parts is not None and parts.time is not None and _is_zero(parts.time)
    text = parts.fill(form) if parts and parts.a and parts.b and not is_zero else ""
    if word.text == "before" and form == SEQUENCE[""]:
        # `b` may be a later goal, or something that must not happen before `a`.
        text = ""
    if parts and text:
        reason = (form != HOLDING and (word.text == "for" or not is_timed) and _REASONS.get((word.text, kind))) or (
            (_WHERE if _is_of_every_step(failure, at) else _ONCE) if form == CONDITION[""] else ""
        )
        head = f"{text_of(failure, 0, start)} " if start else ""
        reason = reason.format(a=parts.a, b=parts.b, head=head)
        diagnostic = suggest_rewrite(failure, start, stop, text, title, reason, code)
        if diagnostic:
            return diagnostic
    return failure.error(code, title, _general_help(failure, at, form, time), span=word.span)


@record
class Time:
    """A time such as ``20 steps``: the number as it stands in the text, and a unit of the language."""

    number: str
    unit: str

    @property
    def text(self) -> str:
        """The time as it is written in a spec."""
        return f"{self.number} {self.unit}"

    @property
    def is_real(self) -> bool:
        """Whether the time is in seconds, or another unit that needs a clock."""
        return self.unit in REAL_TIME

    @property
    def steps(self) -> int | None:
        """The number of steps, or None if the time has another unit or is no whole number."""
        return int(self.number) if self.unit in ("step", "steps") and self.number.isdecimal() else None


@record
class Parts:
    """The parts of an English phrase `a WORD b` or `c then a WORD b`, as texts.

    ``a`` is a formula, and ``b`` is a formula or a time. ``c`` is the goal before ``a``, and empty
    without one. ``time`` is None if ``b`` is a formula.
    """

    a: str
    b: str
    c: str = ""
    time: Time | None = None

    def fill(self, form: Form) -> str:
        """Return the text of ``form`` with the parts in place of ``{a}``, ``{b}`` and the other names in braces.

        Return "" if the form has ``{less}``, the time minus one step, but the time is not in steps.
        """
        end, less = self.b, ""
        if self.time is not None and self.time.steps is not None:
            end, less = self.time.number, f"{self.time.steps - 1} steps"
        elif "{less}" in form.formula:
            return ""
        formula = form.formula.format(a=self.a, b=self.b, c=self.c, end=end, less=less)
        return f"{form.clause} {formula}" if form.clause else formula


def _general_help(failure: ParseFailure, at: int, form: Form, written: Time | None) -> str:
    """Return a help text that shows ``form`` with the letters a, b and c: "write `b implies a` for `a if b`"."""
    word, is_timed, is_prefix = failure.tokens[at].text, form in TIMED, at == 0 or at < failure.stop.index
    time = _example_time(failure, form, written) if is_timed else None
    if time and failure.lacks_fixed_clock(form.formula):
        return FIXED_CLOCK
    parts = Parts("a", time.text if time else "b", "c", time)
    infix = "followed by" if word == "followed" else word
    english = f"{word} {parts.b}, a" if is_prefix else f"a {infix} {parts.b}"
    if form == CONDITION[""] and not _is_of_every_step(failure, at):
        return (
            f"for `{english}`, write `b implies a` if it is about one step, a clause `keep b implies a` if it is about "
            "every step, or `a and b` if both must hold"
        )
    if word == "before" and not is_timed and effective_clause(failure, at) == "keep":
        return kept_before_help("a", "b")
    if word == "before" and form == SEQUENCE[""] and clause_keyword(failure) == "reach":
        return reached_before_help("a", "b")
    if word == "before" and form == SEQUENCE[""]:
        return (
            "write `a then b` to require `a` and later `b`; if `b` is not required, write `require (not b) until a` to "
            "require `a` first"
        )
    if "{c}" in form.formula:
        english = f"c then {english}"
    kind, text = clause_keyword(failure), parts.fill(form)
    clause = effective_clause(failure, at)
    if clause != kind and clause in FORMS.get(word, {}) and not is_timed:
        # The general form would mean something else where this clause applies.
        form = FORMS[word][clause]
        text = parts.fill(form if form.clause else replace(form, clause=clause))
        return f"write `{text}` for `{clause} {english}`"
    if at and form.clause:
        english = f"{kind} {english}"
    return f"write `{text}` for `{english}`"


def kept_before_help(first: str, second: str) -> str:
    """Return the help for `keep a before b`, with both readings."""
    return (
        f"write `keep {second} implies once {first}` if `{first}` must come first, "
        f"`require {first} weak_until {second}` if it must hold at every step until then"
    )


def reached_before_help(first: str, second: str) -> str:
    """Return the help for `reach a before b`, with its readings."""
    return (
        f"write `require (not {second}) until {first}` if `{first}` must come, and `{second}` not before it, "
        f"`require (not {second}) weak_until {first}` if `{first}` need not come, "
        f"`reach {first} then {second}` if `{second}` must follow, and may come earlier, too"
    )


def clause_keyword(failure: ParseFailure) -> str:
    """Return the keyword of the clause in which parsing failed: ``"reach"``.

    Return "" if parsing failed inside brackets, or outside a clause.
    """
    return failure.tokens[0].text if failure.start == "clause" and not failure.open_brackets else ""


def goal_starts(failure: ParseFailure, at: int) -> list[int]:
    """Return the indices of the first tokens of the goals of a `reach` clause, up to index ``at``.

    The goals are the parts between `then`. In other clauses, return only the index at which the formula
    begins.
    """
    start = formula_start(failure)
    if clause_keyword(failure) != "reach":
        return [start]
    thens = (index for index in outer_indices(failure.tokens, start, at) if failure.tokens[index].type == "THEN")
    return [start, *(index + 1 for index in thens)]


def _is_of_every_step(failure: ParseFailure, at: int) -> bool:
    """Whether the condition at index ``at`` must be about every step.

    If False, it may also be about a single step.
    """
    is_kept = failure.tokens[0].text == "keep" and failure.start == "clause"
    return at == 0 or ((is_kept or has_always_before(failure)) and is_clear_here(failure, failure.tokens[at].text))


def _example_time(failure: ParseFailure, form: Form, written: Time | None) -> Time:
    """Return the time with which a help shows a form: the written one where the form and the clock can have it."""
    fits_form = written is not None and (written.steps is not None or "{less}" not in form.formula)
    if written and fits_form and not _is_zero(written) and (written.is_real or not failure.clock_varies):
        return written
    return Time("3", "s") if form == HOLDING else Time("2", "s") if failure.clock_varies else Time("20", "steps")


def _is_zero(time: Time) -> bool:
    return not float(time.number)
