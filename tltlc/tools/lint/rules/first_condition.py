"""TLT0441: a condition that counts at the first step only, as in `require a implies eventually b`."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.expression.tree import SignalValue, nodes
from tltlc.grammar.tree import BinaryExpr, Quantified, Unary
from tltlc.grammar.walk import conjuncts
from tltlc.logic.text.phrases import is_state
from tltlc.tools.lint.file_view import FileView, ScopedExpression, SpecView, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each required implication whose condition is about one step, and whose result is not.

    Nothing around such an implication says at which steps the condition counts, so it counts at the first one.
    In `require always for 3 s (a implies b)`, it counts in the first three seconds.

    There is no finding if the condition never changes, as in `initial(coins) > 3 implies eventually rich`.
    """
    for spec in view.specs:
        for _, value in spec.clauses("require"):
            for tree in conjuncts(value.tree):
                part = value.with_tree(without_brackets(tree))
                yield from _in_beginning(part, spec)
                for inside in _bodies(part):
                    yield from _at_first_step(inside, part, spec)


def _bodies(part: ScopedExpression) -> list[ScopedExpression]:
    """Return the bodies of the quantifier `all` for each entity, or the expression itself if it is something else."""
    part = part.with_tree(without_brackets(part.tree))
    if isinstance(part.tree, Quantified) and part.tree.all:
        return [inner for body in part.children() for inner in _bodies(body)]
    return [part]


def _at_first_step(part: ScopedExpression, whole: ScopedExpression, spec: SpecView) -> Iterator[RuleFinding]:
    """Yield a finding if an expression is an implication; ``whole`` is the expression with `all` around it."""
    tree = part.tree
    if not isinstance(tree, BinaryExpr) or tree.op not in ("implies", "within"):
        return
    condition, result = part.with_tree(tree.left), part.with_tree(tree.right).formula()
    if not _changes(condition, spec) or (tree.op == "implies" and result is not None and is_state(result)):
        return
    label = Label(part.source, tree.left.span, "later steps with this ask for nothing")
    help_ = f"for every step, write `{_at_every_step(whole.text, spec)}`"
    yield RuleFinding("this condition counts at the first step only", (label,), help_)


def _in_beginning(part: ScopedExpression, spec: SpecView) -> Iterator[RuleFinding]:
    """Yield a finding if an expression is `always for` a time, around implications."""
    tree = part.tree
    if not isinstance(tree, Unary) or tree.op != "G" or tree.bound is None or not tree.bound.words:
        return
    for rule in map(part.with_tree, map(without_brackets, conjuncts(tree.operand))):
        if isinstance(rule.tree, BinaryExpr) and rule.tree.op == "implies":
            condition, result = rule.with_tree(rule.tree.left), rule.with_tree(rule.tree.right)
            if _changes(condition, spec):
                time = " ".join(part.source.slice(tree.bound.high.span).split())
                help_ = f"for every step, write `{_at_every_step(rule.text, spec)}`"
                if result.depends_on_one_step():
                    word = " ".join(part.source.text[tree.span.start : tree.operand.span.start].split())
                    form = f"{operand_text(condition)} implies {word} {operand_text(result)}"
                    help_ = f"for a time from `{condition.text}` on, write `{_at_every_step(form, spec)}`"
                label = Label(part.source, tree.bound.span, "this time begins at the first step")
                yield RuleFinding(f"this condition counts in the first {time} of play only", (label,), help_)
                return


def _at_every_step(formula: str, spec: SpecView) -> str:
    return f"keep {formula}" if spec.declaration.block else f"always ({formula})"


def _changes(condition: ScopedExpression, spec: SpecView) -> bool:
    """Whether a condition is about one step, and may have different values at different steps."""
    if not condition.depends_on_one_step():
        return False
    formula = condition.formula()
    assert formula is not None
    constant = {register.name for register in spec.spec.registers if register.kind == "initial"}
    names = set(formula.atoms())
    return any(
        isinstance(node, SignalValue) and node.name not in constant
        for atom in spec.spec.atoms
        if atom.name in names
        for node in nodes(atom.expression)
    )


RULE = LintRule("TLT0441", "warning", check)
