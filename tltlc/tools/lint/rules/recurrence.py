"""TLT0424: `always eventually` over finite traces, which constrains only the last step."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, Expr, LetDecl, Unary
from tltlc.grammar.walk import operands, parts
from tltlc.tools.lint.file_view import Expression, View, inner, operand
from tltlc.tools.lint.goals import is_of_implications
from tltlc.tools.lint.rule import LintRule, Remark

_WORDS = {"F": "it comes again and again", "G": "it lasts from some time on"}
"""What the author usually means, by the inner operator."""
_OTHER = {"G": "F", "F": "G"}
_OF_CLAUSES = {"keep": ("G", True), "avoid": ("G", False), "reach": ("F", True)}
"""The operator of each clause kind, and whether its formula applies as it is or negated."""


def check(view: View) -> Iterator[Remark]:
    """Yield a remark for each `G F p` and `F G p` of a spec over finite traces.

    This includes clauses that stand for the outer operator. Lets are checked only if all specs of
    the file are over finite traces.
    """
    finite = [spec for spec in view.specs if spec.spec.semantics == "finite"]
    for spec in finite:
        for clause, formula in spec.clauses("reach", "keep", "avoid", "require"):
            yield from _inside(formula.tree, view)
            # In a chain of goals only the last step can be a condition on the end of the trace.
            last = operands(formula.tree, "then")[-1] if clause.kind == "reach" else formula.tree
            start = clause.span.start if last is formula.tree else inner(last).span.start
            if clause.kind in _OF_CLAUSES:
                yield from _remarks(start, last, *_OF_CLAUSES[clause.kind], view)
    if len(finite) == len(view.specs) > 0:
        for declaration in view.module.declarations:
            if isinstance(declaration, LetDecl):
                yield from _inside(declaration.body, view)


def _inside(tree: Expr, view: View) -> Iterator[Remark]:
    for part in parts(tree):
        if isinstance(part, Unary) and part.op in _OTHER and part.bound is None:
            yield from _remarks(part.span.start, part.operand, part.op, True, view)


def _remarks(start: int, tree: Expr, outer: str, holds: bool, view: View) -> Iterator[Remark]:
    """Yield remarks for the parts of an operand that reduce to their truth at the last step.

    ``outer`` is the operator in front of the operand. The operand is negated unless ``holds``.
    `always` distributes over `and`, and `eventually` over `or`.
    """
    whole = inner(tree)
    waiting = [(tree, holds)]
    while waiting:
        part, sign = waiting.pop()
        part = inner(part)
        begin = start if part is whole else part.span.start
        if isinstance(part, Unary) and part.op == "not":
            whole = inner(part.operand) if part is whole else whole
            waiting.append((part.operand, not sign))
        elif isinstance(part, Unary) and part.op in _OTHER and part.bound is None:
            op = part.op if sign else _OTHER[part.op]
            if op == _OTHER[outer]:
                yield _remark(Span(begin, part.op_span.end), op, Expression(part.operand, view.env), sign)
        elif (
            isinstance(part, BinaryExpr) and part.op in ("and", "or") and (part.op == "and") == ((outer == "G") == sign)
        ):
            waiting += (part.right, sign), (part.left, sign)
        elif isinstance(part, BinaryExpr) and part.op == "U" and sign and outer == "G":
            goal = Expression(part.right, view.env).text
            label = Label(
                view.source, Span(begin, part.op_span.end), f"asked again at every step, so `{goal}` at the last"
            )
            once = " ".join(view.source.slice(part.span).split())
            yield Remark("this `until` starts anew at every step", (label,), f"once is `require {once}`")


def _remark(place: Span, op: str, awaited: Expression, sign: bool) -> Remark:
    """Return the remark; ``sign`` is whether ``awaited`` is to hold, or else its negation."""
    goal = awaited.text if sign else f"not {operand(awaited)}"
    label = Label(awaited.source, place, f"where the trace ends, this is `{goal}` at its last step and no more")
    suggestion = f"where play has no end and {_WORDS[op]}, say `semantics infinite`"
    if not (sign and is_of_implications(awaited)):
        suggestion += f"; once is `reach {goal}`"
    return Remark("this speaks of the last step alone", (label,), suggestion)


RULE = LintRule("TLT0424", "warning", check)
