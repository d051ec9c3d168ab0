"""The syntax tree of a ``.tltl`` file."""

from tltlc.grammar.parser import parse
from tltlc.grammar.tree import Call, ClockDecl, Declaration, EntityDecl, Expr, Import, Name, SignalDecl, SpecDecl
from tltlc.grammar.walk import expressions, parts

__all__ = [
    "Call",
    "ClockDecl",
    "Declaration",
    "EntityDecl",
    "Expr",
    "Import",
    "Name",
    "SignalDecl",
    "SpecDecl",
    "expressions",
    "parse",
    "parts",
]
