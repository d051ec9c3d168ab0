"""TLT0460: `keep p implies previously q` where p and q never hold together, so that p lasts one step at most."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from tltlc.automaton.finite.contradiction import unsatisfiable
from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import Unary
from tltlc.grammar.walk import conjuncts
from tltlc.logic.formula import Formula, and_, not_
from tltlc.logic.text.phrases import is_state
from tltlc.resolve.spec import Conjunct
from tltlc.tools.lint.asked_results import AskedResult, asked_results
from tltlc.tools.lint.atom_relations import relations
from tltlc.tools.lint.file_view import FileView, SpecView, operand_text, without_brackets
from tltlc.tools.lint.rule import LintRule, RuleFinding

_NEIGHBOURS: Final = ("previously", "X", "N")


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each rule that asks, one step before or after p, for what never holds together with p.

    There is none for `p implies previously not p`, which says so, nor where p is a change, as `begins p` is.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("keep", "require"):
            for asked in asked_results(clause, value):
                tree = asked.part.tree
                is_neighbour = isinstance(tree, Unary) and tree.op in _NEIGHBOURS and tree.bound is None
                if is_neighbour and not asked.steps and _excludes(asked, spec):
                    yield _finding(asked)


def _excludes(asked: AskedResult, spec: SpecView) -> bool:
    """Whether a condition and what is asked for at its neighbour never hold together, but each may hold."""
    assert isinstance(asked.part.tree, Unary)
    other = asked.part.with_tree(without_brackets(asked.part.tree.operand))
    condition, state = asked.condition.formula(), other.formula()
    if condition is None or state is None or not (is_state(condition) and is_state(state)):
        return False
    changes = (without_brackets(tree) for tree in conjuncts(asked.condition.tree))
    if any(isinstance(tree, Unary) and tree.op in ("begins", "ends") for tree in changes):
        return False
    results = [other.with_tree(tree).formula() for tree in conjuncts(other.tree)]
    negated = [not_(condition), *(not_(part) for part in _parts(asked) if part is not None)]
    if any(part in negated for part in results):
        return False
    return (
        not _can_be(and_(condition, state), asked, spec)
        and _can_be(condition, asked, spec)
        and _can_be(state, asked, spec)
    )


def _parts(asked: AskedResult) -> list[Formula | None]:
    return [asked.condition.with_tree(tree).formula() for tree in conjuncts(asked.condition.tree)]


def _can_be(state: Formula, asked: AskedResult, spec: SpecView) -> bool:
    if not {atom.name for atom in spec.spec.atoms}.issuperset(state.atoms()):
        return True
    part = Conjunct(state, asked.part.source, asked.part.tree.span)
    return not unsatisfiable((part, *relations(spec, state.atoms())), spec.spec)


def _finding(asked: AskedResult) -> RuleFinding:
    assert isinstance(asked.part.tree, Unary)
    condition, other = asked.condition.text, asked.part.with_tree(asked.part.tree.operand).text
    is_before = asked.part.tree.op == "previously"
    change, neighbour = ("begins", "before") if is_before else ("ends", "after")
    meant = f"{change} {operand_text(asked.condition)} implies {asked.part.text if is_before else other}"
    label = Label(
        asked.part.source,
        asked.part.tree.span,
        f"with two such steps in a row, the step {neighbour} one of them is not `{other}`",
    )
    help_ = f"if it may last, write `{meant}`; if it must not, allow it with the comment `// tltlc: allow TLT0460`"
    return RuleFinding(f"by this rule, `{condition}` lasts one step at most", (label,), help_)


RULE = LintRule("TLT0460", "note", check)
