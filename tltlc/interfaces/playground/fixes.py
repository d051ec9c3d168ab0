"""Fixes of errors that the page offers; each one is tried first."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Final

from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.parser import parse
from tltlc.resolve.options import ResolveOptions
from tltlc.resolve.program import resolve
from tltlc.tools.lint import fixes
from tltlc.tools.lint.fixes import Offer

_LONGEST: Final = 20_000
"""In longer texts, trying each fix would take too long."""


def of_errors(source: SourceFile, diagnostics: Iterable[Diagnostic], libraries: tuple[Path, ...]) -> list[Offer]:
    """Return the fixes for errors of a text; ``libraries`` are its import folders.

    Long texts get none.
    """
    if len(source.text) > _LONGEST:
        return []

    def errors(text: SourceFile) -> tuple[Diagnostic, ...]:
        module, syntax = parse(text)
        _, resolution = resolve(module, ResolveOptions(library_dirs=libraries, proofs=False))
        return (*syntax, *resolution)

    return list(fixes.of_errors(diagnostics, source, errors))
