"""Helpers that parse a formula, and show a tree with all brackets."""

from __future__ import annotations

from tltlc.core.source import SourceFile
from tltlc.grammar import tree
from tltlc.grammar.parser import parse_formula


def read(text: str) -> tree.Expr:
    formula, diagnostics = parse_formula(SourceFile("formula", text))
    assert diagnostics == ()
    assert formula is not None
    return formula


def brackets(expression: tree.Expr) -> str:
    """Return the expression with brackets around every operator, which show its structure."""
    match expression:
        case tree.NumberExpr(value=value, unit=unit):
            return f"{value:g}{unit or ''}"
        case tree.Constant(value=constant):
            return "true" if constant else "false"
        case tree.NameExpr(name=name):
            return name
        case tree.CallExpr(name=name, arguments=arguments):
            parts = ", ".join((f"{item.name}=" if item.name else "") + brackets(item.value) for item in arguments)
            return f"{name}({parts})"
        case tree.Unary(op=op, operand=operand, bound=bound):
            limits = "" if bound is None else f"[{brackets(bound.low) if bound.low else ''},{brackets(bound.high)}]"
            return f"({op}{limits} {brackets(operand)})"
        case tree.BinaryExpr(op=op, left=left, right=right):
            return f"({brackets(left)} {op} {brackets(right)})"
        case tree.GroupExpr(inner=inner):
            return f"<{brackets(inner)}>"
        case tree.Quantified(all=all_, variable=variable, entities=entities, body=body):
            names = " ".join(entity.name for entity in entities)
            return f"({'all' if all_ else 'any'} {variable} {names}: {brackets(body)})"
        case tree.WhenExpr(cases=cases, otherwise=otherwise):
            parts = " ".join(f"{brackets(case.condition)}: {brackets(case.value)}" for case in cases)
            return f"(when {parts} otherwise {brackets(otherwise)})"
    raise AssertionError(expression)
