"""TLT0437: a bound without effect, as in `reach eventually within 5 s a`: `reach` may wait before the bound begins.

In `eventually within 60 s (a then b)`, it is `then` that may wait for its first goal after the bound.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, Unary
from tltlc.grammar.walk import operands
from tltlc.tools.lint.file_view import FileView, ScopedExpression, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each bounded `eventually` that another `eventually` precedes, and likewise for `always`."""
    for spec in view.specs:
        for clause, value in spec.clauses("reach", "keep"):
            op = "F" if clause.kind == "reach" else "G"
            inner = _bounded(value, op)
            if inner is not None:
                bound, awaited = _bound_text(inner), operand_text(_operand(inner))
                advice = f"write `require eventually {bound} {awaited}`"
                if op == "G":
                    first = f"require always {bound.replace('within ', 'for ')} {awaited}"
                    advice = f"for the first steps alone, write `{first}`; for every step, write `keep {awaited}`"
                yield _finding(inner, f"`{clause.kind}`", advice)
        for formula in spec.formulas():
            parts = tuple(formula.parts())
            sequences = [part.tree for part in parts if isinstance(part.tree, BinaryExpr) and part.tree.op == "then"]
            events = _events(parts)
            rests = {without_brackets(sequence.right).span for sequence in sequences}
            for part in parts:
                yield from _in_sequence(part, is_rest=part.tree.span in rests)
                yield from _in_operator(part)
                yield from _before_sequence(part, events.get(part.tree.span))


def _in_sequence(part: ScopedExpression, *, is_rest: bool) -> Iterator[RuleFinding]:
    """Yield a finding for the last goal of a sequence, which may come at any later step.

    A bound of an earlier goal has an effect, if a strange one: the next goal must follow the step from
    which the bound counts. ``is_rest`` says that the sequence follows another goal.
    """
    tree = part.tree
    if not isinstance(tree, BinaryExpr) or tree.op != "then" or tree.bound is not None:
        return
    inner, left = _bounded(part.with_tree(tree.right), "F"), part.with_tree(tree.left)
    if inner is None:
        return
    first, before = _bounded(left, "F"), operand_text(left)
    if first is not None and is_rest:
        # This bound belongs to the `then` before it, too.
        before = f"then {_bound_text(first)} {operand_text(_operand(first))}"
    elif isinstance(without_brackets(left.tree), Unary):
        before = f"({before})"
    yield _finding(inner, "`then`", f"write `{before} then {_bound_text(inner)} {operand_text(_operand(inner))}`")


def _in_operator(part: ScopedExpression) -> Iterator[RuleFinding]:
    tree = part.tree
    if isinstance(tree, Unary) and tree.op in ("F", "G") and tree.bound is None:
        inner = _bounded(part.with_tree(tree.operand), tree.op)
        if inner is not None:
            word = part.source.slice(tree.op_span)
            yield _finding(inner, f"the `{word}` before it", "leave out one of the two operators")


def _events(parts: Iterable[ScopedExpression]) -> dict[Span, str]:
    """Map the spans of what rules ask for to their events; to "" where the condition is no `begins p` or `ends p`."""
    events = {}
    for part in parts:
        tree = part.tree
        if isinstance(tree, BinaryExpr) and tree.op == "implies":
            event = without_brackets(tree.left)
            is_event = isinstance(event, Unary) and event.op in ("begins", "ends")
            events[without_brackets(tree.right).span] = part.with_tree(event).text if is_event else ""
    return events


def _before_sequence(part: ScopedExpression, event: str | None) -> Iterator[RuleFinding]:
    """Yield a finding for `eventually` with a bound before a sequence; a rule may ask for it after an event."""
    outer = _bounded(part, "F") if isinstance(part.tree, Unary) else None
    inner = without_brackets(_operand(outer).tree) if outer is not None else None
    if outer is None or not isinstance(inner, BinaryExpr) or inner.op != "then":
        return
    bound = _bound_text(outer)
    first, time = operand_text(outer.with_tree(inner.left)), bound.removeprefix("within ")
    advice, second = ["without a time, leave the bound out"], without_brackets(inner.right)
    if inner.bound is None and not (isinstance(second, BinaryExpr) and second.op == "then"):
        sequence = f"{first} then {bound} {operand_text(outer.with_tree(second))}"
        sequence = f"reach {sequence}" if event is None else f"eventually ({sequence})"
        advice.append(f"for a time from `{first}` on, write `{sequence}`")
    if not time.endswith(("step", "steps")):
        if event:
            goals = [operand_text(outer.with_tree(goal)) for goal in operands(inner, "then")]
            whole = goals[0]
            for goal in goals[1:]:
                whole = f"({goal} and not {event} and previously (not {event} since {whole}))"
            anew = f"where each `{event}` asks for all of it anew, also if one before it is not answered yet"
            advice.insert(0, f"for all of it within {time} of `{event}`, write `eventually {bound} {whole}`, {anew}")
        elif event is None:
            timed = f"({first} and time_holding(true) <= {time})"
            advice.append(f"for a time from the first step of play, write `{timed}` for `{first}`")
    yield _finding(outer, "`then`", "; ".join(advice), f"`then` waits for `{first}`, however long that takes")


def _bounded(part: ScopedExpression, op: str) -> ScopedExpression | None:
    """Return the expression without brackets if it is the operator ``op`` with a bound that begins at once."""
    tree = without_brackets(part.tree)
    if not isinstance(tree, Unary) or tree.op != op or tree.bound is None:
        return None
    begins_at_once = tree.bound.low is None or tree.bound.low.value == 0
    return part.with_tree(tree) if begins_at_once and tree.bound.high.value else None


def _operand(part: ScopedExpression) -> ScopedExpression:
    assert isinstance(part.tree, Unary)
    return part.with_tree(part.tree.operand)


def _bound_text(part: ScopedExpression) -> str:
    """Return the bound in words."""
    assert isinstance(part.tree, Unary)
    assert part.tree.bound is not None
    high = part.tree.bound.high
    return f"within {' '.join(part.source.slice(high.span).split())}{'' if high.unit else ' steps'}"


def _finding(part: ScopedExpression, cause: str, advice: str, message: str = "") -> RuleFinding:
    assert isinstance(part.tree, Unary)
    assert part.tree.bound is not None
    message = message or f"{cause} may wait for any time before this time begins"
    if part.tree.op == "G":
        message = f"{cause} asks for it at every step, so this time never ends"
    label = Label(part.source, part.tree.bound.span, message)
    return RuleFinding("this bound has no effect", (label,), advice)


RULE = LintRule("TLT0437", "warning", check, supersedes=("TLT0443",))
