"""TLT0429: what is asked without a temporal word, and so of the first step alone."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import takewhile

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import Group, Unary
from tltlc.grammar.walk import conjuncts
from tltlc.tools.lint import goals
from tltlc.tools.lint.file_view import Expression, View, operand
from tltlc.tools.lint.rule import Remark, Rule


def check(view: View) -> Iterator[Remark]:
    """A remark for each `require` of a block that asks for something at the first step and at no other.

    And for what stands behind an operand of a temporal word, as b in `eventually a and b`, where it seems to belong.
    """
    for spec in view.specs:
        for clause, value in spec.clauses("require"):
            parts = [value.at(tree) for tree in conjuncts(value.tree)]
            if spec.declaration.block and all(map(Expression.is_of_one_step, parts)):
                label = Label(value.source, clause.span, "asked at the first step, and never again")
                way_out = f"at every step is `keep {value.text}`"
                if not goals.is_of_implications(value):
                    way_out += f", at some step `reach {value.text}`"
                yield Remark("this speaks of the first step alone", (label,), way_out)
                continue
            for place, part in enumerate(parts):
                behind = list(takewhile(Expression.is_of_one_step, parts[place + 1 :]))
                if behind and isinstance(part.tree, Unary) and _is_bare(part.tree):
                    yield _outside(part, part.tree, behind)


def _is_bare(tree: Unary) -> bool:
    """Whether a temporal word has no brackets that would say where it ends."""
    return tree.op in ("F", "G") and not isinstance(tree.operand, Group)


def _outside(temporal: Expression, tree: Unary, behind: list[Expression]) -> Remark:
    source = temporal.source
    word = " ".join(source.text[tree.span.start : tree.operand.span.start].split())
    inside = " and ".join(map(operand, (temporal.at(tree.operand), *behind)))
    span = behind[0].tree.span.to(behind[-1].tree.span)
    label = Label(source, span, f"asked at the first step: `{word}` ends before it")
    return Remark("this speaks of the first step alone", (label,), f"both together are `{word} ({inside})`")


RULE = Rule("TLT0429", "note", check)
