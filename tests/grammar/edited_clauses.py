"""The specs that the offered edits of a wrong clause lead to."""

from __future__ import annotations

from functools import cache

from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.parser import parse
from tltlc.resolve.resolution import resolve
from tltlc.tools.lint.fixes import fixes_of_errors
from tltlc.tools.lint.scopes import apply_edits

HEAD = """entity k, d
signal a: bool
signal b: bool
signal c: bool
signal p(e): bool
signal q(e): bool
"""


def errors(source: SourceFile) -> tuple[Diagnostic, ...]:
    module, diagnostics = parse(source)
    return tuple(
        diagnostic for diagnostic in (*diagnostics, *resolve(module).diagnostics) if diagnostic.severity == "error"
    )


@cache
def edited_specs(clause: str) -> list[str]:
    """Return the valid specs that the offered edits of a clause lead to, applied repeatedly until no error is left."""
    queue, valid = [f"{HEAD}spec s {{ {clause}\n}}\n"], []
    while queue:
        source = SourceFile("a.tltl", queue.pop())
        diagnostics = errors(source)
        if not diagnostics:
            valid.append(source.text)
        offers = fixes_of_errors(diagnostics, source, lambda text: (parse(text)[1], errors(text)))
        queue += (apply_edits(source, offer.fix.edits).text for offer in offers)
    return valid
