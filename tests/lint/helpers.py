"""Lints a text as the command does, without the file that it would stand in."""

from __future__ import annotations

from tltlc.lint.fixing import Fixed, fix
from tltlc.lint.rule import Finding
from tltlc.lint.run import lint
from tltlc.pipeline import CompileOptions
from tltlc.source import SourceFile


def found(text: str, **options: object) -> tuple[Finding, ...]:
    """What is to be said of a text."""
    return lint(SourceFile("example.tltl", text), CompileOptions(**options))  # type: ignore[arg-type]


def codes(text: str, **options: object) -> list[str]:
    """The codes of what is to be said of a text, in order."""
    return [each.diagnostic.code for each in found(text, **options)]


def marked(text: str, code: str) -> list[str]:
    """What the remarks with a code point at first."""
    labels = [each.diagnostic.labels[0] for each in found(text) if each.diagnostic.code == code]
    return [label.source.slice(label.span) for label in labels]


def mended(text: str) -> Fixed:
    """A text with all its fixes."""
    return fix(SourceFile("example.tltl", text))
