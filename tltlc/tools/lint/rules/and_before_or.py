"""TLT0462: `a or b and c`, which is read as `a or (b and c)`."""

from __future__ import annotations

from collections.abc import Iterator

from tltlc.core.source import SourceFile
from tltlc.grammar import walk
from tltlc.grammar.tree import BinaryExpr, Expr, LetDecl, SpecDecl
from tltlc.tools.lint.file_view import FileView
from tltlc.tools.lint.rule import LintRule, RuleFinding


def check(view: FileView) -> Iterator[RuleFinding]:
    """Yield a finding for each chain of `or` on one line with an `and` among its operands, without brackets.

    There is none if each operand is an `and`, as in `a and b or c and d`, nor for the signs `|` and `&`, whose order
    is that of programming languages.
    """
    for declaration in view.module.declarations:
        if isinstance(declaration, (LetDecl, SpecDecl)):
            for expression in walk.expressions(declaration):
                inner: set[int] = set()
                for part in walk.parts(expression):
                    if isinstance(part, BinaryExpr) and part.op == "or":
                        inner |= {id(side) for side in (part.left, part.right)}
                        if id(part) not in inner:
                            yield from _finding(part, view)


def _finding(chain: BinaryExpr, view: FileView) -> Iterator[RuleFinding]:
    source, operands = view.source, walk.operands(chain, "or")
    joined = [operand for operand in operands if _is_joined(operand, source)]
    whole = source.slice(chain.span)
    if not joined or len(joined) == len(operands) or "\n" in whole or source.slice(chain.op_span) != "or":
        return
    texts = [source.slice(operand.span) for operand in operands]
    read = " or ".join(
        f"({text})" if operand in joined else text for operand, text in zip(operands, texts, strict=True)
    )
    help_ = f"write `{read}` if you mean this"
    if len(operands) == 2:
        help_ += f", `{_other_reading(operands, source)}` if you do not"
    yield RuleFinding("`and` applies before `or`", (view.label(chain.span, f"read as `{read}`"),), help_)


def _is_joined(operand: Expr, source: SourceFile) -> bool:
    return isinstance(operand, BinaryExpr) and operand.op == "and" and source.slice(operand.op_span) == "and"


def _other_reading(operands: list[Expr], source: SourceFile) -> str:
    """Return `(a or b) and c` for `a or b and c`, and `a and (b or c)` for `a and b or c`."""
    left, right = operands
    if _is_joined(left, source):
        *first, last = (source.slice(part.span) for part in walk.operands(left, "and"))
        return " and ".join([*first, f"({last} or {source.slice(right.span)})"])
    first_part, *rest = (source.slice(part.span) for part in walk.operands(right, "and"))
    return " and ".join([f"({source.slice(left.span)} or {first_part})", *rest])


RULE = LintRule("TLT0462", "note", check)
