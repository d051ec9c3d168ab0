"""A text as it stands at one moment, and what the compiler makes of it at once: syntax and names."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING

from tltlc.core.record import EMPTY
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.allow_index import unsilenced
from tltlc.grammar.lexer import Token, Tokens, tokenize
from tltlc.grammar.parser import parse
from tltlc.grammar.tree import Module
from tltlc.interfaces.lsp.follow_up_errors import unread
from tltlc.interfaces.lsp.names import Occurrence, occurrences
from tltlc.interfaces.lsp.paths import path_of
from tltlc.io.files import Stamp, noted, stamp, unsaved
from tltlc.resolve.options import ResolveOptions
from tltlc.resolve.program import Resolution, resolution
from tltlc.resolve.scope import Scope
from tltlc.tools.lint.rule import Finding
from tltlc.tools.lint.run import levelled

if TYPE_CHECKING:
    from tltlc.io.project import Project


class Document:
    """One state of a text; ``unsaved`` are the texts of all open documents by path, in place of their files.

    Everything is found when it is first asked for, and then kept: the text does not change.
    """

    def __init__(
        self, source: SourceFile, project: Project, texts: Mapping[str, str], notes: Mapping[str, Stamp] = EMPTY
    ) -> None:
        self.source = source
        self.project = project
        self.texts = dict(texts)
        self._notes = dict(notes)

    @cached_property
    def _parsed(self) -> tuple[Module, tuple[Diagnostic, ...]]:
        return parse(self.source)

    @property
    def module(self) -> Module:
        """The declarations that could be read."""
        return self._parsed[0]

    @cached_property
    def resolution(self) -> Resolution:
        """What the names stand for; predicates are not proved to stay in their ranges, which takes too long."""
        options = ResolveOptions(library_dirs=self.project.libraries, proofs=False)
        with unsaved(self.texts), noted() as notes:
            found = resolution(self.module, options)
        self._notes.update(notes)
        return found

    def is_current(self) -> bool:
        """Whether the files that it is made of are as they were; ``notes`` has those that were looked at before.

        In place of the files that are open, their texts counted.
        """
        return all(path_of(path) in self.texts or stamp(path) == state for path, state in self._notes.items())

    @property
    def scope(self) -> Scope:
        """The names that the text sees."""
        return self.resolution.env.scope

    @property
    def is_broken(self) -> bool:
        """Whether there is an error of syntax."""
        return bool(self._parsed[1])

    @cached_property
    def said(self) -> tuple[Diagnostic, ...]:
        """What is wrong with syntax and names, less what comments and the project allow."""
        if self.is_broken:
            # Of what could be read, only what is wrong with names: the rest may be missing.
            errors = [each for each in self.resolution.diagnostics if each.severity == "error"]
            missing = unread(self.module, self.tokens)
            return (*self._parsed[1], *(each for each in errors if not missing.may_mend(each)))
        found = self.resolution
        left = unsilenced((loaded.module for loaded in found.modules), found.diagnostics)
        kept = levelled(map(Finding, left), self.project.lint)
        return tuple(each.diagnostic for each in kept)

    @property
    def is_clean(self) -> bool:
        """Whether nothing found so far is an error, so that automata can be built."""
        return not any(each.severity == "error" for each in (*self._parsed[1], *self.resolution.diagnostics))

    @cached_property
    def lexed(self) -> Tokens:
        """The text in tokens."""
        return tokenize(self.source.text)

    @property
    def tokens(self) -> list[Token]:
        """The tokens, the last of which is the end."""
        return self.lexed.tokens

    @cached_property
    def names(self) -> tuple[Occurrence, ...]:
        """Every name that stands for something, in order."""
        return occurrences(self.scope, self.tokens)

    def name_at(self, offset: int) -> Occurrence | None:
        """The name at a place, or right before it."""
        return next((each for each in self.names if each.span.start <= offset <= each.span.end), None)

    def token_at(self, offset: int) -> Token | None:
        """The token at a place."""
        return next((each for each in self.tokens if each.start <= offset < each.end), None)

    @cached_property
    def reads(self) -> frozenset[str]:
        """The paths of the files that it is made of, its own among them."""
        return frozenset(path_of(loaded.module.source.name) for loaded in self.resolution.modules)

    def depends_on(self, name: str) -> bool:
        """Whether a text is a part of it, or may become one where an import found nothing."""
        # Before its names have been looked at, nothing is known.
        return "resolution" not in self.__dict__ or name in self.reads or self.scope.incomplete
