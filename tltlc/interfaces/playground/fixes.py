"""Find fixes of errors that the playground can offer; each fix is tried before it is offered."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Final

from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.pipeline import CompileOptions, Session
from tltlc.tools.lint import fixes
from tltlc.tools.lint.fixes import OfferedFix

_LONGEST: Final = 20_000
"""The most characters of a text that gets fixes; in longer texts, trying them would take too long."""


def of_errors(source: SourceFile, diagnostics: Iterable[Diagnostic], libraries: tuple[Path, ...]) -> list[OfferedFix]:
    """Return the fixes of ``diagnostics`` that leave fewer errors in the text ``source``.

    ``libraries`` are the folders that are searched for imports. Texts over 20,000 characters get no
    fixes.
    """
    if len(source.text) > _LONGEST:
        return []

    def errors(text: SourceFile) -> tuple[Sequence[Diagnostic], Sequence[Diagnostic]]:
        session = Session(text, CompileOptions(library_dirs=libraries), proofs=False)
        return session.syntax_errors, session.source_diagnostics

    return list(fixes.fixes_of_errors(diagnostics, source, errors))
