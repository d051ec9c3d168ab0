"""One version of a text, with what the compiler finds out quickly: its syntax and names."""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING

from tltlc.core.record import EMPTY
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.allow_index import drop_silenced
from tltlc.grammar.lexer import Token, Tokens, tokenize
from tltlc.grammar.module import Module
from tltlc.interfaces.lsp.occurrences import Occurrence, occurrences
from tltlc.interfaces.lsp.paths import location_of
from tltlc.io.access_log import Stamp, access_log, stamp
from tltlc.io.files import unsaved_texts
from tltlc.pipeline import CompileOptions, Session
from tltlc.resolve.follow_up_errors import independent_errors
from tltlc.resolve.resolution import Resolution
from tltlc.resolve.scope import Scope
from tltlc.tools.lint.rule import LintFinding
from tltlc.tools.lint.run import apply_levels

if TYPE_CHECKING:
    from tltlc.io.project import Project


class Document:
    """One version of a text, with its syntax and names.

    ``project`` has the settings of the nearest ``tltl.toml``. ``texts`` contains the texts of all open
    documents, by path (for an unsaved text, by URI); they replace the files on disk. ``notes``
    contains, by path, the stamps (time of change, size) of the files that were read to find the
    project; :meth:`is_current` compares them with the present stamps. Each property is computed on
    first use and then cached, because the text does not change.
    """

    def __init__(
        self, source: SourceFile, project: Project, texts: Mapping[str, str], notes: Mapping[str, Stamp] = EMPTY
    ) -> None:
        self.source = source
        self.project = project
        self.texts = dict(texts)
        self._notes = dict(notes)
        # The proof that predicates stay in their ranges takes too long.
        self._session = Session(source, CompileOptions(library_dirs=project.libraries), proofs=False)

    @property
    def module(self) -> Module:
        """The syntax tree of the text. If there are syntax errors, the parts that cannot be parsed are missing."""
        return self._session.module

    @property
    def syntax_errors(self) -> tuple[Diagnostic, ...]:
        """The syntax errors of the text."""
        return self._session.syntax_errors

    @cached_property
    def resolution(self) -> Resolution:
        """The result of resolving the names in the text and in the files that it imports, with its diagnostics."""
        with unsaved_texts(self.texts), access_log() as notes:
            result = self._session.resolution
        self._notes.update(notes)
        return result

    def is_current(self) -> bool:
        """Whether the files on disk that this document depends on are unchanged.

        Files that are open in the editor are not checked, because their texts come from the editor.
        """
        return all(
            os.path.abspath(path) in self.texts or stamp(path) == state  # noqa: PTH100 (keeps links as they are)
            for path, state in self._notes.items()
        )

    @property
    def scope(self) -> Scope:
        """The names that are visible in the text."""
        return self.resolution.env.scope

    @property
    def is_broken(self) -> bool:
        """Whether the text has a syntax error."""
        return bool(self.syntax_errors)

    @cached_property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """The diagnostics about syntax and names, except those that a comment or the project silences.

        If there is a syntax error, these are errors only; errors in names that may be consequences
        of the syntax error are left out.
        """
        if self.is_broken:
            return independent_errors(self.module, self.syntax_errors, self.resolution.diagnostics)
        resolved = self.resolution
        remaining = drop_silenced((loaded.module for loaded in resolved.modules), resolved.diagnostics)
        remaining_findings = apply_levels(map(LintFinding, remaining), self.project.lint)
        return tuple(finding.diagnostic for finding in remaining_findings)

    @property
    def is_clean(self) -> bool:
        """Whether the text has no errors in syntax and names, so that automata can be built."""
        return not any(
            diagnostic.severity == "error" for diagnostic in (*self.syntax_errors, *self.resolution.diagnostics)
        )

    @cached_property
    def lexed(self) -> Tokens:
        """The tokens and comments of the text."""
        return tokenize(self.source.text)

    @property
    def tokens(self) -> list[Token]:
        """The tokens; the last one marks the end."""
        return self.lexed.tokens

    @cached_property
    def names(self) -> tuple[Occurrence, ...]:
        """Every name in the text that refers to a declaration, in order."""
        return occurrences(self.scope, self.tokens)

    def name_at(self, offset: int) -> Occurrence | None:
        """Return the name that contains an offset or ends at it; None if there is no such name."""
        return next((name for name in self.names if name.span.start <= offset <= name.span.end), None)

    def token_at(self, offset: int) -> Token | None:
        """Return the token at an offset; None between tokens."""
        return next((token for token in self.tokens if token.start <= offset < token.end), None)

    @cached_property
    def reads(self) -> frozenset[str]:
        """The locations of this document and of all files that it imports, also indirectly.

        A location is an absolute path, or the URI of a text that is not a file.
        """
        return frozenset(location_of(loaded.module.source) for loaded in self.resolution.modules)

    def depends_on(self, location: str) -> bool:
        """Whether a change of the document at ``location`` may affect this document.

        Changes of this document's file and of the files that it imports may affect it. If an import
        failed, any file may be the one that the import did not find.
        """
        # Until the names are resolved, it is not known which files this one imports.
        return "resolution" not in self.__dict__ or location in self.reads or self.scope.incomplete
