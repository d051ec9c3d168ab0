"""TLT0478: `a implies x >= highest_within(x, 10 s) - 5`, where the 10 s may begin before a."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, CallExpr, Clause, Expr, IsExpr, NameExpr, NumberExpr, Unary
from tltlc.grammar.walk import children, conjuncts, parts
from tltlc.resolve.scope import MEMORY_FUNCTIONS
from tltlc.tools.lint.asked_results import AskedResult, asked_results
from tltlc.tools.lint.file_view import FileView, ScopedExpression, SpecView, edited_text, operand_text, without_brackets
from tltlc.tools.lint.names import mentioned_signals
from tltlc.tools.lint.rule import LintRule, RuleFinding
from tltlc.tools.lint.rules.first_change import same_text

_SINCE: Final = {
    "times_within": "times_since",
    "total_time_within": "total_time_since",
    "highest_within": "highest_since",
    "lowest_within": "lowest_since",
}
_COUNTS: Final = ("times_within", "total_time_within")
_SIGNS: Final = ("<", "<=", ">", ">=")
_EARLIER: Final = ("begins", "ends", "previously", "historically")
"""What is about one step alone, or says what has been before it."""


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each limit on the last seconds that a rule asks for while a condition holds.

    The seconds may begin before the condition does. So they may in a condition with such a count and a state. There
    is none if what is counted mentions the condition, which then says itself what counts.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("keep", "require"):
            inner = _inner_conditions(value.tree)
            conditions: dict[int, ScopedExpression] = {}
            for asked in asked_results(clause, value):
                conditions[id(asked.condition.tree)] = asked.condition
                if id(asked.condition.tree) not in inner and not asked.steps:
                    yield from _in_answer(asked, clause, value, spec)
            for condition in conditions.values():
                yield from _in_condition(condition)


def _inner_conditions(tree: Expr) -> set[int]:
    """Return the ids of the conditions of rules in the answers of other rules, which are not all of the condition."""
    found: set[int] = set()
    pending = [(tree, False)]
    while pending:
        part, is_inner = pending.pop()
        if isinstance(part, BinaryExpr) and part.op == "implies":
            if is_inner:
                found.add(id(without_brackets(part.left)))
            pending += [(part.left, is_inner), (part.right, True)]
        else:
            pending += [(child, is_inner) for child in children(part)]
    return found


# --- windows in the answer of a rule ------------------------------------------------------------


def _in_answer(asked: AskedResult, clause: Clause, value: ScopedExpression, spec: SpecView) -> Iterator[RuleFinding]:
    condition, limit = asked.condition, asked.part
    call = _range_window(limit)
    if call is not None and _is_lasting(condition) and not _reads_the_same(call, condition, limit):
        if _is_all_asked(asked, value):
            yield _too_early(call, condition, limit, clause, value, spec)
        return
    call = _only_window(limit)
    if call is None or not _is_lasting(condition) or _reads_the_same(call, condition, limit):
        return
    is_least = _is_least(limit.tree, call)
    if is_least and call.name in _COUNTS and _is_all_asked(asked, value):
        yield _too_early(call, condition, limit, clause, value, spec)
    if is_least != (call.name == "lowest_within") or not _is_about(limit, call):
        return
    number, _, *maximum = (limit.with_tree(argument.value).text for argument in call.arguments)
    since = f"{_SINCE[call.name]}({', '.join((number, f'begins {operand_text(condition)}', *maximum))})"
    offered = " or ".join(edited_text(limit, call.span, text) for text in (limit.with_tree(call).text, since))
    if not _is_all_asked(asked, value):
        offered = f"({offered})"
    keyword = f"{clause.kind} " if spec.declaration.block else ""
    help_ = (
        f"if only steps since `{condition.text}` began count, write "
        f"`{keyword}{edited_text(value, limit.tree.span, offered)}`; if the time before it counts, too, allow this "
        "with the comment `// tltlc: allow TLT0478`"
    )
    yield _finding(limit.with_tree(call), condition.text, help_)


def _too_early(
    call: CallExpr,
    condition: ScopedExpression,
    limit: ScopedExpression,
    clause: Clause,
    value: ScopedExpression,
    spec: SpecView,
) -> RuleFinding:
    """Return the finding for a least number in a time, of which the start of a condition falls short."""
    length = limit.with_tree(call.arguments[1].value).text
    keyword = f"{clause.kind} " if spec.declaration.block else ""
    lasted = f"time_holding({condition.text}) >= {length}"
    help_ = (
        f"if it must be so once `{condition.text}` has lasted {length}, write "
        f"`{keyword}{edited_text(value, condition.tree.span, lasted)}`; if what came before it counts, too, allow this "
        "with the comment `// tltlc: allow TLT0478`"
    )
    label = Label(limit.source, call.span, f"at the start of `{condition.text}`, this is about the time before it")
    return RuleFinding(f"the last {length} may begin before `{condition.text}`", (label,), help_)


def _is_lasting(condition: ScopedExpression) -> bool:
    """Whether a condition is a state that may last, and that is not about a count, a time or a value of the past."""
    if any(isinstance(part, CallExpr) and part.name in MEMORY_FUNCTIONS for part in parts(condition.tree)):
        return False
    tops = [without_brackets(part) for part in conjuncts(condition.tree)]
    is_event = any(isinstance(top, Unary) and top.op in _EARLIER for top in tops)
    return not is_event and condition.depends_on_one_step()


def _is_about(limit: ScopedExpression, call: CallExpr) -> bool:
    """Whether a limit is one on how much a number has changed, or on how often, or how long, something may be.

    What must not be at all is not counted: `times_within(shot, 5 s) < 1` is about what was before, too.
    """
    assert isinstance(limit.tree, BinaryExpr)
    if call.name not in _COUNTS:
        return any(same_text(limit, part, call.arguments[0].value) for part in _present_parts(limit.tree))
    sides = [without_brackets(side) for side in (limit.tree.left, limit.tree.right)]
    (other,) = (side for side in sides if not any(part is call for part in parts(side)))
    if not isinstance(other, NumberExpr):
        return True
    is_strict = limit.tree.op in ("<", ">") and call.name == "times_within"
    return other.value > (1 if is_strict else 0)


def _present_parts(tree: Expr) -> Iterator[Expr]:
    """Yield the parts of an expression that are not inside a function of the past."""
    pending = [tree]
    while pending:
        part = pending.pop()
        yield part
        if not isinstance(part, CallExpr) or part.name not in MEMORY_FUNCTIONS:
            pending += children(part)


def _is_all_asked(asked: AskedResult, value: ScopedExpression) -> bool:
    """Whether a comparison is all that its rule asks for, so that `or` after it needs no brackets."""
    rules = (part for part in parts(value.tree) if isinstance(part, BinaryExpr) and part.op == "implies")
    return any(without_brackets(rule.right) is asked.part.tree for rule in rules)


# --- windows in the condition of a rule ---------------------------------------------------------


def _in_condition(condition: ScopedExpression) -> Iterator[RuleFinding]:
    tops = [condition.with_tree(without_brackets(tree)) for tree in conjuncts(condition.tree)]
    counts = [(top, call) for top in tops for call in [_only_window(top)] if call is not None]
    states = [top for top in tops if _is_plain(top.tree)]
    if len(counts) != 1 or not states or len(states) + 1 < len(tops):
        return
    ((count, call),) = counts
    if call.name not in _COUNTS or not _is_least(count.tree, call) or _is_once(count, call):
        return
    if any(_reads_the_same(call, state, count) for state in states):
        return
    counted, *others = (count.with_tree(argument.value) for argument in call.arguments)
    state = " and ".join(part.text for part in states)
    event = without_brackets(counted.tree)
    is_beginning = isinstance(event, Unary) and event.op in ("begins", "ends")
    begun = "begins " if call.name == "times_within" and not is_beginning else ""
    both = f"{begun}{operand_text(counted)} and {state}"
    within = f"{call.name}({', '.join((both, *(other.text for other in others)))})"
    those = f"only those in `{state}` count" if call.name == "times_within" else f"only the time in `{state}` counts"
    help_ = (
        f"if {those}, write `{edited_text(condition, call.span, within)}`; if what was before it counts, too, allow "
        "this with the comment `// tltlc: allow TLT0478`"
    )
    yield _finding(count.with_tree(call), state, help_)


def _is_plain(tree: Expr) -> bool:
    """Whether a condition is a name, a test of an enum, or the negation of one of them."""
    if isinstance(tree, Unary) and tree.op == "not":
        tree = without_brackets(tree.operand)
    return isinstance(tree, (NameExpr, IsExpr))


def _is_once(count: ScopedExpression, call: CallExpr) -> bool:
    """Whether a count is at least 1, so that it is about presence; TLT0469 has that."""
    assert isinstance(count.tree, BinaryExpr)
    least = [side.value for side in (count.tree.left, count.tree.right) if isinstance(side, NumberExpr)]
    is_strict = count.tree.op in ("<", ">")
    return call.name == "times_within" and any(number <= (0 if is_strict else 1) for number in least)


# --- both ---------------------------------------------------------------------------------------


def _only_window(comparison: ScopedExpression) -> CallExpr | None:
    """Return the function of the last seconds that a comparison has; None if it has none, or several."""
    tree = comparison.tree
    if not isinstance(tree, BinaryExpr) or tree.op not in _SIGNS:
        return None
    calls = [part for part in parts(tree) if isinstance(part, CallExpr) and part.name in _SINCE]
    if len(calls) != 1 or calls[0].name in comparison.env.scope.names:
        return None
    return calls[0]


def _range_window(comparison: ScopedExpression) -> CallExpr | None:
    """Return `highest_within(x, 2 s)` of a limit on it minus `lowest_within(x, 2 s)`; None for other comparisons."""
    tree = comparison.tree
    if not isinstance(tree, BinaryExpr) or tree.op not in _SIGNS:
        return None
    sides = [without_brackets(tree.left), without_brackets(tree.right)]
    difference, most = sides if tree.op in ("<", "<=") else sides[::-1]
    if not isinstance(most, NumberExpr):
        return None
    if not isinstance(difference, BinaryExpr) or difference.op != "-":
        return None
    highest, lowest = (without_brackets(side) for side in (difference.left, difference.right))
    if not isinstance(highest, CallExpr) or not isinstance(lowest, CallExpr):
        return None
    if (highest.name, lowest.name) != ("highest_within", "lowest_within"):
        return None
    is_same = all(
        comparison.with_tree(one.value).text == comparison.with_tree(other.value).text
        for one, other in zip(highest.arguments, lowest.arguments, strict=True)
    )
    return highest if is_same and highest.name not in comparison.env.scope.names else None


def _is_least(tree: Expr, call: CallExpr) -> bool | None:
    """Whether a comparison is one with the least that a call may be: a greater value of the call may make it true.

    False if a smaller value may; None if that cannot be said, as for the root of the call.
    """
    assert isinstance(tree, BinaryExpr)
    is_left = any(part is call for part in parts(tree.left))
    is_rising = is_left == (tree.op in (">", ">="))
    side = tree.left if is_left else tree.right
    while side is not call:
        side = without_brackets(side)
        if isinstance(side, Unary) and side.op == "-":
            is_rising, side = not is_rising, side.operand
        elif isinstance(side, BinaryExpr) and side.op in ("+", "-", "*", "/"):
            first, second = side.left, side.right
            is_first = any(part is call for part in parts(first))
            factor = without_brackets(second if is_first else first)
            if side.op in ("*", "/") and (not isinstance(factor, NumberExpr) or factor.value <= 0):
                return None
            if not is_first and side.op == "/":
                return None
            is_rising ^= side.op == "-" and not is_first
            side = first if is_first else second
        elif side is not call:
            return None
    return is_rising


def _reads_the_same(call: CallExpr, condition: ScopedExpression, of: ScopedExpression) -> bool:
    """Whether what a function speaks of reads a signal that a condition reads."""
    scope = of.env.scope
    return bool(mentioned_signals(call.arguments[0].value, scope) & mentioned_signals(condition.tree, scope))


def _finding(call: ScopedExpression, state: str, help_: str) -> RuleFinding:
    assert isinstance(call.tree, CallExpr)
    number, length = (call.with_tree(argument.value).text for argument in call.tree.arguments[:2])
    before = {
        "times_within": f"a beginning of `{number}`",
        "total_time_within": f"the time with `{number}`",
        "highest_within": "a fall",
        "lowest_within": "a rise",
    }[call.tree.name]
    label = Label(call.source, call.tree.span, f"{before} before `{state}` counts, too")
    return RuleFinding(f"the last {length} may begin before `{state}`", (label,), help_)


RULE = LintRule("TLT0478", "note", check)
