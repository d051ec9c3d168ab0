"""The syntax tree of a ``.tltl`` file."""

from tltlc.grammar.parser import parse
from tltlc.grammar.tree import (
    CallExpr,
    ClockDecl,
    Declaration,
    EntityDecl,
    Expr,
    Import,
    NameExpr,
    SignalDecl,
    SpecDecl,
)
from tltlc.grammar.walk import expressions, parts

__all__ = [
    "CallExpr",
    "ClockDecl",
    "Declaration",
    "EntityDecl",
    "Expr",
    "Import",
    "NameExpr",
    "SignalDecl",
    "SpecDecl",
    "expressions",
    "parse",
    "parts",
]
