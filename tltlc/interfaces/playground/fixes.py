"""Fixes of errors that the page offers, tried before."""

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
"""Characters of a text that is soon read again for each fix."""


def of_errors(source: SourceFile, told: Iterable[Diagnostic], libraries: tuple[Path, ...]) -> list[Offer]:
    """The fixes of errors of a text that imports from these folders; none of a long text."""
    if len(source.text) > _LONGEST:
        return []

    def errors(text: SourceFile) -> tuple[Diagnostic, ...]:
        module, found = parse(text)
        _, more = resolve(module, ResolveOptions(library_dirs=libraries, proofs=False))
        return (*found, *more)

    return list(fixes.of_errors(told, source, errors))
