"""TLT0482: `keep begins a implies (always for 2 s b) or c`, where c excuses only at the step of a."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.expression.tree import SignalValue, nodes
from tltlc.grammar import walk
from tltlc.grammar.tree import BinaryExpr, CallExpr, Clause, Expr, GroupExpr, NameExpr, Unary
from tltlc.logic.formula import Formula, and_, eventually, not_
from tltlc.logic.text.phrases import is_state
from tltlc.resolve.spec import Conjunct
from tltlc.tools.lint.asked_results import AskedResult, asked_results
from tltlc.tools.lint.atom_relations import relations
from tltlc.tools.lint.file_view import FileView, ScopedExpression, SpecView, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each rule that asks for a time from a step on, or else for a condition at that step.

    There is none if the condition says what has been, if it is about what the rule begins with, or if it is or
    includes the negation of what must last. With a clock that varies, the formula for the other meaning needs steps.
    """
    for spec in view.specs:
        if spec.spec.clock_varies:
            continue
        for clause, value in spec.clauses("keep", "require"):
            for asked in asked_results(clause, value):
                if not asked.steps:
                    yield from _findings(asked, clause, value, spec)


def _findings(asked: AskedResult, clause: Clause, value: ScopedExpression, spec: SpecView) -> Iterator[RuleFinding]:
    answers = walk.operands(asked.part.tree, "or", through_brackets=True)
    lasting = [place for place, tree in enumerate(answers) if _is_time(tree, is_last=tree is answers[-1])]
    if len(answers) < 2 or len(lasting) != 1:
        return
    (place,) = lasting
    time = without_brackets(answers[place])
    assert isinstance(time, Unary)
    others = [asked.part.with_tree(tree) for tree in (*answers[:place], *answers[place + 1 :])]
    state, condition = asked.part.with_tree(time.operand), asked.condition
    if all(_is_present(other, spec) for other in others) and not any(
        _mentioned(other.tree, other) & _mentioned(condition.tree, condition) for other in others
    ):
        formulas = [part.formula() for part in (state, condition, *others)]
        known = [formula for formula in formulas if formula is not None and is_state(formula)]
        if len(known) == len(formulas) and _may_end(known[0], known[2:], spec):
            is_whole = asked.is_all_of(clause, value)
            yield _finding(asked, asked.part.with_tree(time), others, is_whole=is_whole)


def _is_time(tree: Expr, *, is_last: bool) -> bool:
    """Whether an operand of `or` is `(always for 2 s b)`, in brackets unless nothing follows."""
    inner = without_brackets(tree)
    is_bracketed = isinstance(tree, GroupExpr) or is_last
    if not is_bracketed or not isinstance(inner, Unary) or inner.op != "G" or inner.bound is None:
        return False
    return inner.bound.low is None or inner.bound.low.value == 0


def _is_present(other: ScopedExpression, spec: SpecView) -> bool:
    """Whether a condition is about the step itself; it may also be the beginning or end of such a condition."""
    tree = without_brackets(other.tree)
    if isinstance(tree, Unary) and tree.op in ("begins", "ends"):
        other = other.with_tree(tree.operand)
    formula = other.formula()
    if formula is None:
        return False
    registers = {register.name for register in spec.spec.registers}
    atoms = {atom.name: atom for atom in spec.spec.atoms}
    return bool(formula.atoms()) and not any(
        isinstance(node, SignalValue) and node.name in registers
        for name in formula.atoms()
        if name in atoms
        for node in nodes(atoms[name].expression)
    )


def _mentioned(tree: Expr, part: ScopedExpression) -> set[str]:
    """Return the names that a condition mentions; `near(key)` is another one than `near(door)`."""
    mentioned, pending = set(), [tree]
    while pending:
        inner = pending.pop()
        if isinstance(inner, NameExpr) or (isinstance(inner, CallExpr) and inner.name in part.env.scope.names):
            mentioned.add(part.with_tree(inner).text)
        else:
            pending += walk.children(inner)
    return mentioned


def _may_end(state: Formula, others: list[Formula], spec: SpecView) -> bool:
    """Whether a step may have neither what must last nor an excuse, and one may have the first alone."""
    excused = [not_(other) for other in others]
    neither, alone = and_(not_(state), *excused), and_(state, *excused)
    return all(_can_be(step, spec) for step in (neither, alone))


def _can_be(state: Formula, spec: SpecView) -> bool:
    part = Conjunct(eventually(state), spec.spec.source, spec.spec.name_span)
    return not spec.decision((part, *relations(spec, state.atoms())), spec.spec)


def _finding(
    asked: AskedResult, time: ScopedExpression, others: list[ScopedExpression], *, is_whole: bool
) -> RuleFinding:
    assert isinstance(time.tree, Unary)
    end, condition = " or ".join(other.text for other in others), asked.condition
    is_chain = isinstance(condition.tree, BinaryExpr) and condition.tree.op in ("and", "or")
    last = f"({end})" if others[1:] else operand_text(others[0])
    meant = f"({time.text}) or ({operand_text(time.with_tree(time.tree.operand))} until {last})"
    place = asked.part.tree if others[1:] else others[0].tree
    label = Label(time.source, place.span, "at a later step, it does not end that time")
    rule = f"keep {condition.text if is_chain else operand_text(condition)} implies {meant}"
    help_ = (
        f"if it may end that time, write `{rule if is_whole else f'({meant})'}`; "
        "if it counts at that step alone, allow this with the comment `// tltlc: allow TLT0482`"
    )
    return RuleFinding(f"`{end}` counts only at the step of `{condition.text}`", (label,), help_)


RULE = LintRule("TLT0482", "note", check)
