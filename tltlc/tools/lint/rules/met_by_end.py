"""TLT0456: `eventually (a until b)`, which a step with b alone meets."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from tltlc.automaton.finite.contradiction import unsatisfiable
from tltlc.core.source import Span
from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import BinaryExpr, CallExpr, Expr, Unary
from tltlc.grammar.walk import conjuncts, operands
from tltlc.logic.formula import Formula, and_, not_
from tltlc.logic.text.phrases import is_state
from tltlc.resolve.spec import Conjunct
from tltlc.tools.lint.asked_results import asked_results
from tltlc.tools.lint.atom_relations import relations
from tltlc.tools.lint.file_view import FileView, ScopedExpression, SpecView, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding

if TYPE_CHECKING:
    from typing import TypeGuard


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each `until` and `weak_until` that `eventually` or `reach` lets begin at any step.

    There is none where a holds at each step with b, nor for `always eventually`, which TLT0424 reports. Nor is there
    one where b says that the condition of the rule is over, as in `keep begins c implies eventually (a weak_until
    not c)`: nothing is asked for after c. TLT0433 reports `until` in a `reach` clause, where a never has an effect.
    """
    for spec in view.specs:
        ends = _ends_of_conditions(spec)
        for clause, value in spec.clauses("reach", "keep", "avoid", "require"):
            parts = [*value.parts()]
            repeated = {without_brackets(part.tree.operand).span for part in parts if _is_unary(part.tree, "G")}
            for part in parts:
                if _is_unary(part.tree, "F") and part.tree.span not in repeated:
                    until = part.with_tree(without_brackets(part.tree.operand))
                    if _is_until(until.tree) and not _is_meant(until, ends.get(part.tree.span, []), spec):
                        yield _after_eventually(part, part.tree, until)
            if clause.kind == "reach":
                *earlier, last = operands(without_brackets(value.tree), "then")
                until = value.with_tree(without_brackets(last))
                if _is_until(until.tree) and until.tree.op == "W" and not _is_meant(until, [], spec):
                    before = " ".join(value.source.text[clause.span.start : last.span.start].split())
                    word, form = ("`then`", f"{before} ({{}})") if earlier else ("`reach`", "reach {}")
                    yield _finding(until, word, form)


def _is_unary(tree: Expr, op: str) -> TypeGuard[Unary]:
    return isinstance(tree, Unary) and tree.op == op


def _is_until(tree: Expr) -> TypeGuard[BinaryExpr]:
    return isinstance(tree, BinaryExpr) and tree.op in ("U", "W")


def _ends_of_conditions(spec: SpecView) -> dict[Span, list[Formula]]:
    """Return, for each result of a rule, the formulas that say that its condition is over."""
    ends: dict[Span, list[Formula]] = {}
    for clause, value in spec.clauses("keep", "require"):
        for asked in asked_results(clause, value):
            lasting = [_lasting(without_brackets(tree)) for tree in conjuncts(asked.condition.tree)]
            formulas = [asked.condition.with_tree(tree).formula() for tree in lasting]
            ends[asked.part.tree.span] = [not_(formula) for formula in formulas if formula is not None]
    return ends


def _lasting(condition: Expr) -> Expr:
    """Return p for `begins p` and `time_holding(p) >= 2 s`, and any other condition as it is."""
    if isinstance(condition, Unary) and condition.op == "begins":
        return without_brackets(condition.operand)
    if isinstance(condition, BinaryExpr) and condition.op in (">", ">="):
        timer = without_brackets(condition.left)
        if isinstance(timer, CallExpr) and timer.name == "time_holding":
            return without_brackets(timer.arguments[0].value)
    return condition


def _is_meant(until: ScopedExpression, ends: list[Formula], spec: SpecView) -> bool:
    """Whether the second half of an `until` includes the first, or is one of the ``ends``."""
    first, end = (part.formula() for part in until.children())
    if end is None or end in ends:
        return end is not None
    if first is None or not (is_state(first) and is_state(end)):
        return False
    alone = and_(end, not_(first))
    if not {atom.name for atom in spec.spec.atoms}.issuperset(alone.atoms()):
        return False
    part = Conjunct(alone, until.source, until.tree.span)
    return unsatisfiable((part, *relations(spec, alone.atoms())), spec.spec)


def _after_eventually(part: ScopedExpression, tree: Unary, until: ScopedExpression) -> RuleFinding:
    word = " ".join(part.source.text[tree.span.start : tree.operand.span.start].split())
    end = ""
    if tree.bound is None and isinstance(until.tree, BinaryExpr) and until.tree.op == "U":
        end = f"{word} {operand_text(until.children()[-1])}"
    return _finding(until, f"`{word}`", f"{word} ({{}})", end)


def _finding(until: ScopedExpression, waits: str, form: str, end_alone: str = "") -> RuleFinding:
    """Return the finding for an `until`.

    ``waits`` is the operator before it, ``form`` the text around its operands, and ``end_alone`` a formula that says
    the same.
    """
    assert isinstance(until.tree, BinaryExpr)
    first, end = until.children()
    word = until.source.slice(until.tree.op_span)
    message = f"{waits} may wait for a step with `{end.text}`, with or without `{first.text}`"
    allow = f"write `{end_alone}`" if end_alone else "allow it with the comment `// tltlc: allow TLT0456`"
    weak = f", and `weak_until` if play may end before `{end.text}`" if word == "until" else ""
    help_ = (
        f"if `{first.text}` must come first, write `{form.format(f'{operand_text(first)} and ({until.text})')}`{weak}; "
        f"if `{end.text}` alone is enough, {allow}"
    )
    label = Label(until.source, until.tree.span, message)
    return RuleFinding(f"`{end.text}` alone meets this `{word}`", (label,), help_)


RULE = LintRule("TLT0456", "note", check)
