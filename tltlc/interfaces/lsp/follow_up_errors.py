"""Find errors that may be mere consequences of syntax errors, because a part of the text was not parsed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from tltlc.core.record import record
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.lexer import Token
from tltlc.grammar.module import Module
from tltlc.grammar.tree import Import, TestDecl

_NO_SUCH_ATOM: Final = "TLT0209"
_WRONG_TEST: Final = "TLT0217"
_NO_CLOCK: Final = "TLT0313"
_NO_SUCH_NAME: Final = ("TLT0201", "TLT0208")
_HEADS: Final = ("signal", "entity", "param", "predicate", "let", "spec")


@record
class UnparsedParts:
    """Lists what the parser may have missed in a text with syntax errors.

    ``declared`` has the names that the unparsed parts may declare. ``imports`` says whether these
    parts may contain an import, and ``clock`` whether they may contain a ``clock`` declaration.
    ``tests`` has, for each parsed test, the span of the spec's name, because a diagnostic about the
    whole test has its label there. ``source`` is the text.
    """

    declared: frozenset[str]
    imports: bool
    clock: bool
    tests: frozenset[Span]
    source: SourceFile

    def may_explain(self, diagnostic: Diagnostic) -> bool:
        """Whether a diagnostic reports something as missing that an unparsed part may contain.

        This may be the declaration of a name, an atom of a spec, the clock, or the ``expect`` of a
        test.
        """
        if diagnostic.code == _NO_SUCH_ATOM:
            # The atom may belong to a clause that is being written.
            return True
        if diagnostic.code == _NO_CLOCK:
            return self.clock
        label = diagnostic.labels[0] if diagnostic.labels else None
        if label is None:
            return False
        if diagnostic.code == _WRONG_TEST:
            # A label on the whole test means that the test has no `expect`. The user may be writing it now.
            return label.span in self.tests
        if diagnostic.code not in _NO_SUCH_NAME:
            return False
        return self.imports or (label.source == self.source and label.source.slice(label.span) in self.declared)


def unparsed_parts(module: Module, tokens: Sequence[Token]) -> UnparsedParts:
    """Find out what the unparsed parts of a text may contain.

    ``module`` has the declarations that were parsed, and ``tokens`` are those of the whole text.
    """
    words = [token.text for token in tokens]
    imports_read = sum(isinstance(declaration, Import) for declaration in module.declarations)
    return UnparsedParts(
        frozenset(_declared_names(tokens)),
        words.count("import") > imports_read,
        "clock" in words,
        frozenset(declaration.spec.span for declaration in module.declarations if isinstance(declaration, TestDecl)),
        module.source,
    )


def _declared_names(tokens: Sequence[Token]) -> Iterator[str]:
    """Yield the names after the keywords of declarations, also in parts that were not parsed."""
    head = ""
    for token in tokens:
        if token.text in _HEADS:
            head = token.text
        elif head and token.type == "NAME":
            yield token.text
            head = "entity" if head == "entity" else ""
        elif token.type != "COMMA":
            head = ""
