"""Say what suggested clauses ask for where a reader may expect something else: counts, times, `until` and `next`."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import ceil, floor, inf
from typing import Final, TypeGuard

from tltlc.core.source import SourceFile
from tltlc.grammar import lalr
from tltlc.grammar.builder import Builder
from tltlc.grammar.lexer import tokenize
from tltlc.grammar.mistakes.declared_names import DeclaredNames
from tltlc.grammar.past_words import OF_EVENTS
from tltlc.grammar.tables import load
from tltlc.grammar.tree import BinaryExpr, CallExpr, Declaration, Expr, GroupExpr, NumberExpr, Unary
from tltlc.grammar.walk import expressions, parts

_SECONDS: Final = {"ms": 0.001, "s": 1.0, "min": 60.0, "h": 3600.0}
_BEGINNINGS: Final = (
    "begin", "start", "becom", "turn", "enter", "rise", "rising", "fall", "drop", "goes", "change", "each", "every",
    "time", "leave", "get", "end", "stop",
)  # fmt: skip
"""Words about a moment, which a state that lasts has only one of."""
_AWAITING: Final = ("F", "X", "U", "M", "then", "within")
"""The operators that ask for something that may come later."""
_OF_CALLS: Final = {
    "times": "`{call}` counts how often `{0}` begins: steps in a row count once",
    "times_since": "`{call}` counts how often `{0}` begins, anew from each step with `{1}` on",
    "total_time": "`{call}` adds up the lengths of all steps with `{0}`",
    "total_time_since": "`{call}` adds up the lengths of the steps with `{0}`, anew from each step with `{1}` on",
    "value_at": "`{call}` is the value at the first step until the first step with `{1}`",
}
"""What the functions of the trace so far are, where a reader may expect something else."""
_CHANGES: Final = (" != previous(", " > previous(", " < previous(", " or ends (")
"""What stands in conditions of a number that changes."""
_COUNTS: Final = ("times", "times_since", "times_within")
_OF_EDGES: Final = ("times", "times_within")
"""The functions that count the beginnings of beginnings and ends as these themselves."""
_LESS: Final = ("less than", "under")
_FROM_START: Final = ("times", "total_time", "time_holding")
"""The functions that may count steps before a rule begins."""
_MOST_STEPS: Final = 100
"""With more steps, one more or less is hardly noticed."""


def notes(clauses: str, names: DeclaredNames, typed: str) -> tuple[str, ...]:
    """Return what to know of clauses that stand for ``typed``: nothing of what stands there already."""
    written = _written(clauses)
    if written is None:
        return ()
    source, declarations = written
    formulas = (part for spec in declarations for part in expressions(spec))
    all_notes = (note for part in formulas for note in _notes(part, source, names.step_s))
    new = dict.fromkeys(note for note, words in all_notes if not any(word in typed.lower() for word in words))
    anew = (note for part in _parts_of(declarations) if "before" in typed and (note := _asked_anew(part, source)))
    less = _last_step_notes(source, declarations, names.step_s, typed)
    return (*equality_notes(clauses, typed), *new, *dict.fromkeys((*anew, *less)))


def _notes(expression: Expr, source: SourceFile, step_s: float) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield each note of an expression, and the words with which a writer has said so already."""
    events = {id(call.arguments[1].value) for call in parts(expression) if _is_since(call)}
    for part in parts(expression):
        if isinstance(part, CallExpr):
            arguments = [source.slice(argument.span) for argument in part.arguments]
            edge = part.arguments[0].value if part.name in _OF_EDGES and part.arguments else None
            is_edge = isinstance(edge, Unary) and edge.op in ("begins", "ends")
            note = "" if is_edge else _OF_CALLS.get(part.name, "")
            if isinstance(edge, Unary) and edge.op == "begins":
                inner = source.slice(edge.operand.span)
                yield f"`{source.slice(part.span)}` counts the first step, too, if it has `{inner}`", (f"{part.name}(",)
            if note and not (part.name == "value_at" and _is_after_event(part, expression, source)):
                call = source.slice(part.span)
                yield note.format(*arguments, call=call), (f"{part.name}(",)
            if part.name == "times_within" and (window := _window_note(part, source, step_s)):
                yield window, ("times_within(",)
            if part.name in _COUNTS and any(sign in arguments[0] for sign in _CHANGES):
                yield f"`{arguments[0]}` at steps in a row counts once", (" != previous(", " or ends (")
        elif isinstance(part, Unary) and part.op == "begins" and id(part) not in events:
            inner = source.slice(part.operand.span)
            yield f"`begins {inner}` holds only at the first step of `{inner}`, and not at those after it", _BEGINNINGS
        elif isinstance(part, Unary) and part.op == "G" and part.bound is not None and part.bound.words:
            steps = _steps(part.bound.high, step_s)
            if 1 < steps <= _MOST_STEPS:
                yield (
                    f"`{source.slice(part.span)}` asks for {ceil(steps)} steps, from the present one on",
                    ("always", "G["),
                )
        if isinstance(part, BinaryExpr) and part.op in ("U", "W"):
            yield from _counted_before(part.left, source)
        if note := _apart_note(part, source, step_s):
            yield note, ("then within",)
        if isinstance(part, BinaryExpr) and part.op == "U":
            end = source.slice(part.right.span)
            yield f"write `weak_until` for `until` if play may end before `{end}`", ("weak_until",)
        elif isinstance(part, BinaryExpr) and part.op in ("implies", "within"):
            yield from _rule_notes(part, source)
        elif isinstance(part, BinaryExpr) and part.op in (">", ">=") and _is_held(part.left):
            note = _of_time(part, source, step_s)
            if note:
                yield note, ("time_holding",)


def _counted_before(asked: Expr, source: SourceFile) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield a note on each count of what a rule asks for that may have begun before the rule does."""
    for part in parts(asked):
        if isinstance(part, CallExpr) and part.name in _FROM_START:
            yield f"`{source.slice(part.span)}` also counts what was before this rule begins", ()


def _apart_note(rule: Expr, source: SourceFile, step_s: float) -> str:
    """Return that `a then within 3 s a` is met by two a exactly 3 s apart, and the time that it is not; else ""."""
    if not isinstance(rule, BinaryExpr) or rule.op != "then" or rule.bound is None:
        return ""
    event, again = source.slice(rule.left.span), source.slice(rule.right.span)
    steps = _steps(rule.bound.high, step_s)
    if event != again or not 1 < steps <= _MOST_STEPS or steps != int(steps):
        return ""
    longest = rule.bound.high
    shorter = f"{round(longest.value * (1 - 1 / steps), 6):g} {longest.unit}"
    return f"{source.slice(longest.span)} after the first is forbidden, too: write {shorter} if it is allowed"


def _asks_for_less(typed: str) -> bool:
    return any(less in typed.lower() for less in _LESS)


def _last_step_notes(source: SourceFile, specs: Sequence[Declaration], step_s: float, typed: str) -> list[str]:
    noted = (_last_step_note(part, source, step_s) for part in _parts_of(specs)) if _asks_for_less(typed) else ()
    return [note for note in noted if note]


def _last_step_note(answer: Expr, source: SourceFile, step_s: float) -> str:
    """Return that `eventually within 2 s a` may come 2 s later, for one who asks for less; "" for other formulas."""
    if not isinstance(answer, Unary) or answer.op != "F" or answer.bound is None:
        return ""
    longest, steps = answer.bound.high, _steps(answer.bound.high, step_s)
    if not isinstance(longest, NumberExpr) or not 1 < steps <= _MOST_STEPS:
        return ""
    shorter = f"{round(longest.value * (1 - 1 / steps), 6):g} {longest.unit or ''}".rstrip()
    return f"{source.slice(longest.span)} later counts, too: write {shorter} if that is too late"


def _every_note(comparison: Expr, source: SourceFile, step_s: float) -> str:
    """Return how far apart `time_holding(not a) < 6 s` lets two a be; "" for other formulas."""
    if not isinstance(comparison, BinaryExpr) or comparison.op != "<" or not _is_held(comparison.left):
        return ""
    limit = comparison.right
    steps = _steps(limit, step_s) if isinstance(limit, NumberExpr) else 0.0
    if not isinstance(limit, NumberExpr) or not 2 < steps <= _MOST_STEPS or steps != int(steps):
        return ""
    longest, shorter = (round(limit.value * (1 + more / steps), 6) for more in (1, -1))
    return (
        f"it counts from the step after each: two may be {longest:g} {limit.unit} apart; write "
        f"`< {shorter:g} {limit.unit}` if {source.slice(limit.span)} is the most"
    )


def _window_note(call: CallExpr, source: SourceFile, step_s: float) -> str:
    """Return at which steps `times_within(p, 2 s)` counts; nothing where steps differ in length."""
    length = call.arguments[1].value if len(call.arguments) > 1 else None
    steps = _steps(length, step_s) if isinstance(length, NumberExpr) else 0
    if not 0 < steps < inf:
        return ""
    return f"`{source.slice(call.span)}` counts how often it has begun at this step or one of the {ceil(steps)} before"


def _rule_notes(rule: BinaryExpr, source: SourceFile) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield what to know of a rule with a condition: `a implies b`, or `within 2 s of a, b`."""
    given, condition = rule.left, source.slice(rule.left.span)
    if rule.op == "implies" and _is_next_state(rule.right):
        yield f"write `weak_next` for `next` if play may end at a step with `{condition}`", ("weak_next",)
    answer = rule.right.inner if isinstance(rule.right, GroupExpr) else rule.right
    is_awaited = rule.op == "within" or (isinstance(answer, Unary) and answer.op == "F")
    if is_awaited:
        yield from _counted_before(answer, source)
    if is_awaited and isinstance(given, BinaryExpr) and given.op in (">", ">=") and _is_held(given.left):
        yield f"each step with `{condition}` asks anew; write `begins ({condition})` if once is enough", ("begins",)


def _is_next_state(answer: Expr) -> bool:
    """Whether an answer is `next p`, where p asks for nothing at further steps."""
    while isinstance(answer, GroupExpr):
        answer = answer.inner
    if not isinstance(answer, Unary) or answer.op != "X" or answer.bound is not None:
        return False
    return not any(isinstance(part, (Unary, BinaryExpr)) and part.op in _AWAITING for part in parts(answer.operand))


def _is_since(expression: Expr) -> TypeGuard[CallExpr]:
    """Whether an expression is a function of an event: `times_since(p, q)`, `value_at(x, q)`."""
    if not isinstance(expression, CallExpr):
        return False
    return expression.name in OF_EVENTS and len(expression.arguments) > 1


def _is_after_event(call: CallExpr, rule: Expr, source: SourceFile) -> bool:
    """Whether a rule asks for a value at an event only after that event: `a implies x >= value_at(x, begins a)`."""
    if not isinstance(rule, BinaryExpr) or rule.op != "implies":
        return False
    return _state_text(rule.left, source) == _state_text(call.arguments[1].value, source)


def _state_text(event: Expr, source: SourceFile) -> str:
    """Return the text of a in `begins a`, `ends a` and `a`, without brackets around it."""
    while isinstance(event, GroupExpr) or (isinstance(event, Unary) and event.op in ("begins", "ends")):
        event = event.inner if isinstance(event, GroupExpr) else event.operand
    return source.slice(event.span)


def reading_notes(clauses: str, names: DeclaredNames, typed: str) -> tuple[str, ...]:
    """Return what to know of numbers in clauses that a sentence may mean: fractions, and steps that a time takes."""
    source, specs = _written(clauses) or (None, ())
    times: list[str] = []
    if source is not None and "time_holding" not in typed:
        compared = (part for part in _parts_of(specs) if isinstance(part, BinaryExpr) and part.op in (">", ">="))
        times = [_of_time(part, source, names.step_s) for part in compared if _is_held(part.left)]
    if source is not None and ("then within" not in typed or _asks_for_less(typed)):
        times += [_apart_note(part, source, names.step_s) for part in _parts_of(specs)]
    if source is not None:
        times += _last_step_notes(source, specs, names.step_s, typed)
    if source is not None and "every" in typed:
        times += [_every_note(part, source, names.step_s) for part in _parts_of(specs)]
    return (*equality_notes(clauses, typed), *dict.fromkeys(note for note in times if note))


def form_notes(clauses: str, names: DeclaredNames) -> tuple[str, ...]:
    """Return what to know of times in clauses that a sentence which is not understood may mean."""
    _, specs = _written(clauses) or (None, ())
    source = SourceFile("", f"spec s {{ {clauses} }}", "text")
    return tuple(dict.fromkeys(note for part in _parts_of(specs) if (note := _apart_note(part, source, names.step_s))))


def equality_notes(clauses: str, typed: str) -> tuple[str, ...]:
    """Return why clauses have two comparisons of a number with fractions in place of the `==` of ``typed``."""
    written = _written(clauses)
    if written is None or "==" not in typed:
        return ()
    source, specs = written
    texts = dict.fromkeys(text for formula in _parts_of(specs) if (text := _equal_number(formula, source)))
    return tuple(f"`{text}` has fractions, which `==` cannot compare: two comparisons say the same" for text in texts)


def _parts_of(declarations: Sequence[Declaration]) -> Iterator[Expr]:
    """Yield the formulas of declarations, and the formulas in them."""
    return (part for declaration in declarations for whole in expressions(declaration) for part in parts(whole))


def _asked_anew(rule: Expr, source: SourceFile) -> str:
    """Return what to know of `a implies (not c weak_until b)`, where a may last; "" for other formulas."""
    if not isinstance(rule, BinaryExpr) or rule.op != "implies":
        return ""
    answer = rule.right.inner if isinstance(rule.right, GroupExpr) else rule.right
    is_edge = isinstance(rule.left, Unary) and rule.left.op in ("begins", "ends")
    if is_edge or not isinstance(answer, BinaryExpr) or answer.op != "W":
        return ""
    event, first = source.slice(rule.left.span), source.slice(answer.right.span)
    return f"each step with `{event}` asks for `{first}` anew; write `begins` before it if one is enough each time"


def _equal_number(formula: Expr, source: SourceFile) -> str:
    """Return a of `a >= b and a <= b`; "" for other formulas."""
    if not isinstance(formula, BinaryExpr) or formula.op != "and":
        return ""
    left, right = formula.left, formula.right
    if not (isinstance(left, BinaryExpr) and isinstance(right, BinaryExpr)) or (left.op, right.op) != (">=", "<="):
        return ""
    number, same, limit, same_limit = (
        source.slice(side.span) for side in (left.left, right.left, left.right, right.right)
    )
    return number if (number, limit) == (same, same_limit) else ""


def _written(clauses: str) -> tuple[SourceFile, Sequence[Declaration]] | None:
    """Return a spec with these clauses and its tree; None if they cannot be parsed."""
    source = SourceFile("", f"spec s {{ {clauses} }}", "text")
    lexed = tokenize(source.text)
    try:
        return source, lalr.run(load(), "module", lexed.tokens, Builder(source, lexed.docs))
    except lalr.UnexpectedTokenError:
        return None


def _is_held(expression: Expr) -> bool:
    return isinstance(expression, CallExpr) and expression.name == "time_holding"


def _is_wait(held: Expr) -> bool:
    """Whether a time counts how long an answer has been missing, as that of `time_holding(not b since a)` does."""
    argument = held.arguments[0].value if isinstance(held, CallExpr) and held.arguments else None
    return isinstance(argument, BinaryExpr) and argument.op == "since"


def _is_ever(held: Expr) -> bool:
    """Whether a time counts from the first step with a condition on, as that of `time_holding(once a)` does."""
    inner = held.arguments[0].value if isinstance(held, CallExpr) and held.arguments else None
    return isinstance(inner, Unary) and inner.op == "once" and inner.bound is None


def _of_time(comparison: BinaryExpr, source: SourceFile, step_s: float) -> str:
    """Return how many steps in a row take a time, which is 0 s at the first of them, and the time of one step less."""
    limit = comparison.right
    steps = _steps(limit, step_s) if isinstance(limit, NumberExpr) else 0.0
    if not steps or _is_ever(comparison.left) or _is_wait(comparison.left):
        return ""
    number = (ceil(steps) if comparison.op == ">=" else floor(steps) + 1) + 1
    if number > _MOST_STEPS:
        return ""
    needed = (
        f"`{source.slice(comparison.span)}` needs {number} steps in a row, and its time is 0 s at the first of them"
    )
    if number < 3:
        return needed
    left = source.slice(comparison.left.span)
    less = f"{left} {comparison.op} {_shorter(number, comparison.op, step_s)} s"
    return f"{needed}; `{less}` needs {number - 1}"


def _steps(time: NumberExpr, step_s: float) -> float:
    """Return how many steps a time takes; 0 for a number of steps, and if the clock does not say it."""
    return round(time.value * _SECONDS[time.unit] / step_s, 6) if time.unit in _SECONDS and step_s else 0.0


def _shorter(number: int, op: str, step_s: float) -> str:
    """Return the seconds of the comparison that needs ``number - 1`` steps, with as few digits as tell them apart."""
    least, most = (number - 3) * step_s, (number - 2) * step_s
    for digits in range(10):
        scale = 10**digits
        at_most = floor(round(most * scale, 6)) / scale
        at_least = ceil(round(least * scale, 6)) / scale
        if op == ">=" and at_most > least:
            return f"{at_most:.{digits}f}"
        if op == ">" and at_least < most:
            return f"{at_least:.{digits}f}"
    return f"{most if op == '>=' else least}"
