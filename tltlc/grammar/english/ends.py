"""Read `unless c` and `while c` behind a sentence that is read without them: they change the clauses that it says."""

from __future__ import annotations

from typing import Final

from tltlc.core.record import record
from tltlc.grammar.english.rules import Reading
from tltlc.grammar.mistakes.sentences.states import AND, ATOM, OR, State, joined
from tltlc.grammar.mistakes.sentences.validity import parsed_clause
from tltlc.grammar.mistakes.sentences.words import Words, phrases
from tltlc.grammar.tree import BinaryExpr, CallExpr, Expr, Unary
from tltlc.grammar.walk import parts

_EXCUSES: Final = phrases("unless", "except when", "except if", "except while", "except during", "except")
_STRETCHES: Final = phrases("while", "during", "as long as", "so long as", "for as long as")
_EVENTS: Final = phrases("when", "if")
_ENDS: Final = (*_EXCUSES, *_STRETCHES, *_EVENTS)
_AHEAD: Final = frozenset(("F", "G", "X", "N", "U", "W", "R", "M", "then", "within"))
_WITHIN: Final = phrases("within", "in", "inside")
_MEANWHILE: Final = phrases(
    "within that time", "in that time", "during that time", "within this time", "in this time", "meanwhile",
    "in the meantime", "in meantime", "in between", "by then",
)  # fmt: skip
_PAST: Final = ("once ", "historically ", "previously ")
_WINDOWS: Final = ("highest_within", "lowest_within", "times_within", "total_time_within", "previous")
_LOOSE: Final = {"and": AND, "or": OR, "implies": OR + 1, "iff": OR + 1, "then": OR + 1, "since": AND}


@record
class End:
    """The end of a sentence: the words before it, whether it excuses, and the words of its condition.

    ``whole`` is the sentence without the time of `unless c within 5 s`, which is ``time``; it is the sentence itself
    if there is none. The time is "" for `unless c in that time`.
    """

    whole: Words
    before: Words
    excuses: bool
    condition: Words
    time: str | None
    is_stretch: bool = True


def end_of(words: Words) -> End | None:
    """Return the last `unless c` or `while c` of a sentence; None if it has none, or nothing before it."""
    found = words.find_last(_ENDS)
    if found is None:
        return None
    at, phrase = found
    before = words[: at - 1] if words.word(at - 1) == "," else words[:at]
    condition = words[at + len(phrase) :]
    time, length = _time_behind(condition) if phrase in _EXCUSES else (None, 0)
    if time == "":
        times = (before.time(index) for index in range(len(before)))
        time = next((known[0].text for known in times if known is not None), "")
    condition, whole = condition[: len(condition) - length], words[: len(words) - length]
    if len(before) < 2 or not condition:
        return None
    return End(whole, before, phrase in _EXCUSES, condition, time, phrase in _STRETCHES)


def _time_behind(words: Words) -> tuple[str | None, int]:
    """Return the time at the end of words, "" for `in that time`, and the number of its words."""
    found = words.find_last((*_MEANWHILE, *_WITHIN))
    if found is None:
        return None, 0
    at, phrase = found
    if phrase in _MEANWHILE:
        return ("", len(phrase)) if at + len(phrase) == len(words) else (None, 0)
    time = words.time(at + len(phrase))
    is_last = time is not None and time[1] == len(words)
    return (time[0].text, len(words) - at) if time is not None and is_last else (None, 0)


def with_end(reading: Reading, end: End, condition: State) -> Reading | None:
    """Return a reading of the words before an end with the condition of that end in its clauses.

    None if it has several clauses, of which the end may be about the last alone, or if its clause asks for something
    that is no rule for each step, or that may come later.
    """
    changed = _changed(reading.clauses[0], end, condition) if len(reading.clauses) == 1 else None
    if changed is None:
        return None
    labels = [label for label in (reading.condition, changed.where) if label]
    label = ", and ".join((*labels[:1], *(later.removeprefix("if ") for later in labels[1:])))
    return Reading((changed.clause,), label)


def with_last_seconds(reading: Reading, excuse: State) -> list[Reading]:
    """Return a reading of `health >= highest_within(health, 2 s) - 5 unless a`, and that in which a excuses the 2 s.

    Only the reading itself if its clause does not end in the excuse, or is about no last seconds.
    """
    clause = reading.clauses[0]
    time, operand = last_seconds(clause), excuse.at(ATOM)
    kept, forbidden = f" or {operand}", f" and {excuse.negated().at(ATOM)}"
    implied = f" implies {excuse.at(OR)}"
    end = next((ending for ending in (kept, forbidden, implied) if clause.endswith(ending)), "")
    if reading.condition or reading.clauses[1:] or not time or not end or excuse.text.startswith(_PAST):
        return [reading]
    wide = f"once within {time} {operand}"
    longer = {kept: f" or {wide}", forbidden: f" and not {wide}", implied: f" implies {wide}"}[end]
    return [
        Reading((clause.removesuffix(end) + longer,), f"if it excuses what comes up to {time} later, too"),
        Reading((clause,), f"if `{excuse.text}` counts at its own step alone"),
    ]


def last_seconds(clause: str) -> str:
    """Return the time of the only window of the last seconds in a clause: 2 s of `highest_within(x, 2 s)`; else ""."""
    tree = parsed_clause(clause)
    if tree is None or isinstance(tree.value, tuple):
        return ""
    windows = [part for part in parts(tree.value) if isinstance(part, CallExpr) and part.name in _WINDOWS]
    times = [call.arguments[1].value.span for call in windows if call.arguments[1:]]
    return clause[times[0].start : times[0].end] if len(times) == 1 else ""


@record
class _Changed:
    clause: str
    where: str = ""


def _changed(clause: str, end: End, condition: State) -> _Changed | None:
    if not end.excuses:
        return _limited(clause, condition, end_is_stretch=end.is_stretch)
    if end.time is None:
        return _excused(clause, condition)
    times = [time[0].text for index in range(len(end.before)) if (time := end.before.time(index)) is not None]
    if end.time not in times or "time_since(" in clause.partition(" implies ")[0]:
        return None  # it would be counted back from each step
    excused = _excused(clause, State(f"once within {end.time} {condition.at(ATOM)}")) if end.time else None
    return excused if excused is not None and not excused.where else None


def _is_alternative(expr: Expr) -> bool:
    return isinstance(expr, BinaryExpr) and expr.op == "or"


def _excused(clause: str, excuse: State) -> _Changed | None:
    """Return a clause that a condition excuses, and at which step that condition counts."""
    tree = parsed_clause(clause)
    value = tree.value if tree is not None else None
    if tree is None or value is None or isinstance(value, tuple) or _is_chain(value):
        return None
    if isinstance(value, BinaryExpr) and value.op == "implies" and tree.kind == "keep":
        left, right = state_of(value.left, clause), state_of(value.right, clause)
        if is_about_past(value.right):
            is_end = isinstance(value.left, Unary) and value.left.op == "ends" and "once within" in left.text
            where = (
                f"if `{excuse.text}` counts at the end of that time"
                if is_end and not excuse.text.startswith(_PAST)
                else ""
            )
            return _Changed(f"keep {left.at(OR)} implies {joined([right, excuse], 'or').text}", where)
        condition = joined([left, excuse.negated()], "and")
        if excuse.text in left.text or (isinstance(value.right, Unary) and value.right.bound is None):
            return None  # no condition excuses itself; what has no time may end at any step
        return _Changed(f"keep {condition.text} implies {right.text}", _at_step(excuse, left))
    if tree.kind == "avoid" and isinstance(value, BinaryExpr) and value.op == "then":
        if excuse.text in clause:
            return None
        return _second(clause, value, excuse.negated(), f"if `{excuse.text}` counts at the later of the two")
    if not is_about_past(value):
        return None
    state = state_of(value, clause)
    if tree.kind == "avoid":
        return _Changed(f"avoid {joined([state, excuse.negated()], 'and').text}")
    return _Changed(f"keep {joined([state, excuse], 'or').text}") if tree.kind == "keep" else None


def _limited(clause: str, during: State, *, end_is_stretch: bool) -> _Changed | None:
    """Return a clause that asks for something only while a condition holds."""
    tree = parsed_clause(clause)
    value = tree.value if tree is not None else None
    if tree is None or value is None or isinstance(value, tuple) or _is_chain(value):
        return None
    if tree.kind == "avoid" and isinstance(value, BinaryExpr) and value.op == "then":
        return _both(clause, value, during)
    if not is_about_past(value):
        return None
    if during.level > ATOM or _is_alternative(value):
        return None  # the end may be about a part alone
    if isinstance(value, BinaryExpr) and value.op == "implies" and tree.kind == "keep":
        if not end_is_stretch:
            return None
        condition = joined([state_of(value.left, clause), during], "and")
        return _Changed(f"keep {condition.text} implies {state_of(value.right, clause).text}")
    state = state_of(value, clause)
    if tree.kind == "avoid":
        return _Changed(f"avoid {joined([state, during], 'and').text}")
    return _Changed(f"keep {during.at(OR)} implies {state.at(OR)}") if tree.kind == "keep" else None


def _is_chain(value: Expr) -> bool:
    """Whether an expression is `a then b then c`."""
    if not isinstance(value, BinaryExpr) or value.op != "then":
        return False
    return any(isinstance(side, BinaryExpr) and side.op == "then" for side in (value.left, value.right))


def _second(clause: str, value: BinaryExpr, free: State, where: str) -> _Changed:
    last = joined([state_of(value.right, clause), free], "and")
    return _Changed(f"avoid {state_of(value.left, clause).at(ATOM)} {_operator(value, clause)} ({last.text})", where)


def _both(clause: str, value: BinaryExpr, during: State) -> _Changed:
    first, last = (joined([state_of(side, clause), during], "and") for side in (value.left, value.right))
    where = f"if both count only while `{during.text}`"
    return _Changed(f"avoid ({first.text}) {_operator(value, clause)} ({last.text})", where)


def _operator(value: BinaryExpr, clause: str) -> str:
    """Return `then` or `then within 5 s`, as it is written."""
    return clause[value.op_span.start : value.right.span.start].rstrip().rstrip("(").rstrip()


def _at_step(excuse: State, state: State) -> str:
    """Return at which step an excuse counts."""
    return f"if `{excuse.text}` counts at the step of `{state.text}`"


def state_of(expr: Expr, clause: str) -> State:
    """Return the text of an expression of a clause, as a part of other clauses."""
    level = _LOOSE.get(expr.op, ATOM) if isinstance(expr, BinaryExpr) else ATOM
    return State(clause[expr.span.start : expr.span.end], level)


def is_about_past(expr: Expr) -> bool:
    """Whether an expression has no operator that looks ahead."""
    return not any(isinstance(part, (Unary, BinaryExpr)) and part.op in _AHEAD for part in parts(expr))
