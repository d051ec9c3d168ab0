"""TLT0435: `always a implies b`, where `always` ends before `implies`."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.diagnostics.diagnostic import Label
from tltlc.grammar.tree import Binary, Group, Unary
from tltlc.grammar.walk import operands
from tltlc.tools.lint.file_view import Expression, View
from tltlc.tools.lint.goals import conjuncts
from tltlc.tools.lint.rule import Remark, Rule


def check(view: View) -> Iterator[Remark]:
    """A remark for each condition of a `require` that begins with `always` and without brackets, as in `G a -> F b`.

    What is no state formula, as in `G F a -> G F b`, is mostly meant so.
    """
    for spec in view.specs:
        for _, value in spec.clauses("require"):
            for part in conjuncts(value):
                if isinstance(part.tree, Binary) and part.tree.op in ("implies", "iff"):
                    first, *others = operands(part.tree.left, "and")
                    if isinstance(first, Unary) and first.op == "G" and not isinstance(first.operand, Group):
                        asked = (part.at(first.operand), *map(part.at, others))
                        if all(map(Expression.is_of_one_step, asked)):
                            yield _remark(part, part.tree, first)


def _remark(part: Expression, tree: Binary, first: Unary) -> Remark:
    def written(start: int, end: int) -> str:
        return " ".join(part.source.text[start:end].split())

    word = written(first.span.start, first.operand.span.start)
    inside = written(first.operand.span.start, tree.span.end)
    rest = written(tree.op_span.start, tree.op_span.end)
    label = Label(part.source, tree.left.span, f"the condition of `{rest}` is all of this: `{word}` ends before it")
    condition = written(first.span.start, tree.left.span.end)
    way_out = f"at every step is `{word} ({inside})`; where this is meant, say so: `({condition}) {rest} …`"
    return Remark(f"`{word}` speaks of the condition alone", (label,), way_out)


RULE = Rule("TLT0435", "warning", check)
