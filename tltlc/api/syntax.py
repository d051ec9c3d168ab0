"""What does a ``.tltl`` file declare?

``parse`` returns the declarations of a source text, without resolving names. ``expressions`` and
``parts`` yield the expressions inside a declaration.
"""

from tltlc.grammar.parser import parse
from tltlc.grammar.tree import (
    CallExpr,
    ClockDecl,
    Declaration,
    EntityDecl,
    Expr,
    GroupDecl,
    Import,
    NameExpr,
    ParamDecl,
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
    "GroupDecl",
    "Import",
    "NameExpr",
    "ParamDecl",
    "SignalDecl",
    "SpecDecl",
    "expressions",
    "parse",
    "parts",
]
