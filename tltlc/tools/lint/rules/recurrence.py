"""TLT0424: `always eventually` over finite traces, which constrains only the last step."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, Expr, LetDecl, Unary
from tltlc.grammar.walk import conjuncts, operands, parts
from tltlc.tools.lint.file_view import FileView, ScopedExpression, operand_text, without_brackets
from tltlc.tools.lint.goals import consists_of_implications
from tltlc.tools.lint.rule import LintRule, RuleFinding

_WORDS = {"F": "it comes again and again", "G": "it lasts from some time on"}
"""What the author usually means by ``G F`` (the key ``F``) and by ``F G`` (the key ``G``)."""
_ALLOWED = "it is right as it stands: allow it with the comment `// tltlc: allow TLT0424`"
_DUAL = {"G": "F", "F": "G"}
_OF_CLAUSES = {"keep": ("G", True), "avoid": ("G", False), "reach": ("F", True)}
"""Maps each kind of clause to its operator, and to whether the operand is the clause's formula.

The second value is False if the operand is the negated formula.
"""


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each `G F p` and `F G p` of a spec over finite traces.

    A `keep` or `avoid` clause counts as an outer `G`, and a `reach` clause as an outer `F`. Lets
    are checked only if all specs of the file are over finite traces. `require F G p` is right as it
    stands: from some step on, p lasts to the end of the trace.
    """
    finite = [spec for spec in view.specs if spec.spec.semantics == "finite"]
    for spec in finite:
        for clause, formula in spec.clauses("reach", "keep", "avoid", "require"):
            is_clause = spec.declaration.block and clause.kind != "avoid"
            whole = without_brackets(formula.tree) if is_clause else None
            yield from _findings_inside(formula.tree, view, whole, is_required=clause.kind == "require")
            # In a chain of goals only the last step can be a condition on the end of the trace.
            last = operands(formula.tree, "then")[-1] if clause.kind == "reach" else formula.tree
            start = clause.span.start if last is formula.tree else without_brackets(last).span.start
            if clause.kind in _OF_CLAUSES:
                yield from _findings(start, last, *_OF_CLAUSES[clause.kind], view, is_clause=last is formula.tree)
    if len(finite) == len(view.specs) > 0:
        for declaration in view.module.declarations:
            if isinstance(declaration, LetDecl):
                yield from _findings_inside(declaration.body, view, None, is_required=True)


def _findings_inside(tree: Expr, view: FileView, clause: Expr | None, *, is_required: bool) -> Iterator[RuleFinding]:
    """Yield findings about the operand of each unbounded `always` and `eventually` in the expression ``tree``.

    If ``tree`` is the expression of a whole clause, then ``clause`` is ``tree`` without brackets, and
    the advice may be to write another clause. Otherwise ``clause`` is None. If ``is_required``, then
    ``tree`` must hold at the first step, so each of its conjuncts that is `F G p` is left out.
    """
    at_the_end = {id(without_brackets(part)) for part in conjuncts(tree) if is_required and _is_eventually_always(part)}
    for part in parts(tree):
        if isinstance(part, Unary) and part.op in _DUAL and part.bound is None and id(part) not in at_the_end:
            yield from _findings(part.span.start, part.operand, part.op, True, view, is_clause=part is clause)


def _is_eventually_always(tree: Expr) -> bool:
    """Whether an expression is `F G p`, without bounds."""
    for op in ("F", "G"):
        tree = without_brackets(tree)
        if not isinstance(tree, Unary) or tree.op != op or tree.bound is not None:
            return False
        tree = tree.operand
    return True


def _findings(
    start: int, tree: Expr, outer: str, holds: bool, view: FileView, *, is_clause: bool
) -> Iterator[RuleFinding]:
    """Yield findings for the parts of an operand that constrain only the last step.

    ``tree`` is the operand of the operator ``outer``, `F` or `G`. If ``holds`` is false, ``outer``
    applies to the negation of ``tree``. `always` distributes over `and`, and `eventually` over `or`,
    so the operands of this `and` or `or` are checked one by one.

    ``start`` is the offset at which the label for the whole operand begins. ``is_clause`` says
    whether ``outer`` and its operand are a whole clause.
    """
    whole = without_brackets(tree)
    pending = [(tree, holds)]
    while pending:
        part, sign = pending.pop()
        part = without_brackets(part)
        begin = start if part is whole else part.span.start
        if isinstance(part, Unary) and part.op == "not":
            whole = without_brackets(part.operand) if part is whole else whole
            pending.append((part.operand, not sign))
        elif isinstance(part, Unary) and part.op in _DUAL and part.bound is None:
            op = part.op if sign else _DUAL[part.op]
            if op == _DUAL[outer]:
                awaited = ScopedExpression(part.operand, view.env)
                word = view.source.slice(part.op_span)
                as_clause = is_clause and (part is whole or outer == "G")
                last = f"write `require eventually always {_operand(awaited, sign)}`"
                once = _once(awaited, sign, outer, word, is_whole=part is whole, as_clause=as_clause)
                yield _finding(Span(begin, part.op_span.end), op, awaited, sign, last if as_clause else _ALLOWED, once)
        elif (
            isinstance(part, BinaryExpr) and part.op in ("and", "or") and (part.op == "and") == ((outer == "G") == sign)
        ):
            pending += (part.right, sign), (part.left, sign)
        elif isinstance(part, BinaryExpr) and part.op == "U" and sign and outer == "G":
            goal = ScopedExpression(part.right, view.env).text
            label = Label(
                view.source,
                Span(begin, part.op_span.end),
                f"required at every step, so `{goal}` must hold at the last one",
            )
            advice = "if once is enough, take it out of the `always`"
            if is_clause or part is whole:
                advice = _either_until(part, view, goal, is_clause=is_clause)
            yield RuleFinding("this `until` starts again at every step", (label,), advice)


def _either_until(part: BinaryExpr, view: FileView, goal: str, *, is_clause: bool) -> str:
    """Return advice on what to write in place of `G (a U b)`: an until where b must come, and a weak one."""
    strong = ScopedExpression(part, view.env)
    left, right = (operand_text(ScopedExpression(side, view.env)) for side in (part.left, part.right))
    weak = f"{left} weak_until {right}"
    each = ""
    if is_clause:
        each = f"; `keep begins {left} implies ({weak})` if that counts each time that `{left}` begins"
        strong_text, weak_text = f"require {strong.text}", f"require {weak}"
    else:
        strong_text, weak_text = operand_text(strong), f"({weak})"
    return (
        f"write `{strong_text}` if it must hold once, until `{goal}` comes, and `{goal}` must come; "
        f"`{weak_text}` if `{goal}` need not come{each}"
    )


def _once(awaited: ScopedExpression, sign: bool, outer: str, word: str, *, is_whole: bool, as_clause: bool) -> str:
    """Return advice on what to write in place of `G F awaited` or `F G awaited` if once is enough.

    If ``sign`` is false, the negation of ``awaited`` is to hold. ``outer`` is the outer operator, `F`
    or `G`, and ``word`` the inner operator as the source spells it. ``is_whole`` says whether the
    outer operator contains nothing else, and ``as_clause`` whether the advice may be to write a clause.
    """
    if as_clause:
        return f"write `reach {_goal(awaited, sign)}`"
    if outer == "F":
        return f"leave out this `{word}`"
    if is_whole:
        return f"write `eventually {_operand(awaited, sign)}`"
    return "take it out of the `always`"


def _goal(awaited: ScopedExpression, sign: bool) -> str:
    return awaited.text if sign else f"not {operand_text(awaited)}"


def _operand(awaited: ScopedExpression, sign: bool) -> str:
    return operand_text(awaited) if sign else _goal(awaited, sign)


def _finding(place: Span, op: str, awaited: ScopedExpression, sign: bool, last: str, once: str) -> RuleFinding:
    """Return the finding that an expression such as `G F awaited` constrains only the last step.

    ``op`` is the inner operator, `F` or `G`, and ``place`` is the span of both operators. ``sign`` is
    false if the negation of ``awaited`` is required. ``last`` is the advice if the last step is meant,
    and ``once`` that from :func:`_once`.
    """
    label = Label(
        awaited.source, place, f"on a trace that ends, this only means `{_goal(awaited, sign)}` at the last step"
    )
    help_ = f"if the last step is meant, {last}"
    help_ += f"; if play has no end and {_WORDS[op]}, write `semantics infinite`: then no trace that ends violates it"
    if not (sign and consists_of_implications(awaited)):
        help_ += f"; if once is enough, {once}"
    return RuleFinding("this is only about the last step", (label,), help_)


RULE = LintRule("TLT0424", "warning", check, supersedes=("TLT0410",))
