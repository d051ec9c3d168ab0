"""Messages that may only be there because a part of a text could not be read: nobody wants them while typing it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from tltlc.core.record import record
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.lexer import Token
from tltlc.grammar.tree import Import, Module, TestDecl

_NO_SUCH_ATOM: Final = "TLT0209"
_WRONG_TEST: Final = "TLT0217"
_NO_CLOCK: Final = "TLT0313"
_NO_SUCH_NAME: Final = ("TLT0201", "TLT0208")
_HEADS: Final = ("signal", "entity", "param", "predicate", "let", "spec")


@record
class Unread:
    """What may stand in the parts of a broken text that could not be read.

    ``declared`` are names that those parts may declare; ``imports`` and ``clock`` say whether there may be an import or
    a clock in them; ``tests`` are the spans that stand for a whole test in messages.
    """

    declared: frozenset[str]
    imports: bool
    clock: bool
    tests: frozenset[Span]
    source: SourceFile

    def may_mend(self, diagnostic: Diagnostic) -> bool:
        """Whether what a message misses may stand in a part that could not be read."""
        if diagnostic.code == _NO_SUCH_ATOM:
            # It may be one of a clause that is being written.
            return True
        if diagnostic.code == _NO_CLOCK:
            return self.clock
        label = diagnostic.labels[0] if diagnostic.labels else None
        if label is None:
            return False
        if diagnostic.code == _WRONG_TEST:
            # A message about the whole test says that it expects nothing: that may be what is being written.
            return label.span in self.tests
        if diagnostic.code not in _NO_SUCH_NAME:
            return False
        return self.imports or (label.source == self.source and label.source.slice(label.span) in self.declared)


def unread(module: Module, tokens: Sequence[Token]) -> Unread:
    """What may stand in the unread parts of a text that is broken somewhere, by its declarations and its tokens."""
    words = [token.text for token in tokens]
    read = sum(isinstance(each, Import) for each in module.declarations)
    return Unread(
        frozenset(_declared(tokens)),
        words.count("import") > read,
        "clock" in words,
        frozenset(each.spec.span for each in module.declarations if isinstance(each, TestDecl)),
        module.source,
    )


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
