"""A source file after parsing: its declarations and its comments."""

from __future__ import annotations

from tltlc.core.record import record
from tltlc.core.source import SourceFile, Span
from tltlc.grammar.tree import Declaration


@record
class Comment:
    """A ``//`` or ``///`` comment with its slashes, for tools that print the source text."""

    text: str
    span: Span


@record
class Module:
    """A parsed source file: its declarations and its comments, both in order."""

    source: SourceFile
    declarations: tuple[Declaration, ...]
    comments: tuple[Comment, ...]
