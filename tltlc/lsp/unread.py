"""Messages that may only be there because a part of a text could not be read: nobody wants them while typing it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.lexer import Token
from tltlc.grammar.tree import Import, Module, TestDecl

_NO_SUCH_ATOM: Final = "TLT0209"
_WRONG_TEST: Final = "TLT0217"
_NO_CLOCK: Final = "TLT0313"
_NO_SUCH_NAME: Final = ("TLT0201", "TLT0208")
_HEADS: Final = ("signal", "entity", "param", "predicate", "let", "spec")


def may_follow(diagnostic: Diagnostic, module: Module, tokens: Sequence[Token]) -> bool:
    """Whether what a message misses may stand in what could not be read of a text, which is broken somewhere."""
    words = [token.text for token in tokens]
    if diagnostic.code == _NO_SUCH_ATOM:
        # It may be one of a clause that is being written.
        return True
    if diagnostic.code == _NO_CLOCK:
        return "clock" in words
    if diagnostic.code == _WRONG_TEST:
        # Said of a test as a whole, it expects nothing: that may be what is being written.
        where = diagnostic.labels[0].span
        return any(isinstance(each, TestDecl) and each.spec.span == where for each in module.declarations)
    if diagnostic.code not in _NO_SUCH_NAME:
        return False
    if words.count("import") > sum(isinstance(each, Import) for each in module.declarations):
        return True
    label = diagnostic.labels[0]
    return label.source == module.source and label.source.slice(label.span) in set(_declared(tokens))


def _declared(tokens: Sequence[Token]) -> Iterator[str]:
    """The names behind the heads of declarations, as far as the text goes."""
    head = ""
    for token in tokens:
        if token.text in _HEADS:
            head = token.text
        elif head and token.type == "NAME":
            yield token.text
            head = "entity" if head == "entity" else ""
        elif token.type != "COMMA":
            head = ""
