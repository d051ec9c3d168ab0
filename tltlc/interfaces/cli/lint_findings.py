"""The warnings of the linter that commands beside ``tltlc lint`` show: that a spec may not mean what was meant."""

from __future__ import annotations

from typing import Final

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.interfaces.compiled_input import Input
from tltlc.io.project import Project
from tltlc.tools.lint import allow
from tltlc.tools.lint.rules import unused_declaration, unused_import
from tltlc.tools.lint.run import findings, view_of

_UNUSED: Final = (unused_declaration.RULE.code, unused_import.RULE.code, allow.CODE)
"""The codes of findings about names and comments that are not needed, which change no spec."""


def lint_warnings(spec_input: Input, spec: str | None = None) -> tuple[Diagnostic, ...]:
    """Return the warnings of the linter about the specs of a compiled file.

    An error of the linter is a warning here, because the file compiles; it stays an error if the project
    file says so. Notes are left out, and so are findings about unused names and comments. If ``spec`` is the name of a
    spec in the file, only the findings inside this spec are returned. An artefact, which has no text, has
    none.
    """
    if spec_input.session is None:
        return ()
    source, project = spec_input.session.source, spec_input.project
    with project.apply_lint_levels():
        view = view_of(source, spec_input.session.options)
    about_specs = tuple(
        _as_warning(finding.diagnostic, project)
        for finding in findings(view, project.lint)
        if finding.diagnostic.severity != "note" and finding.diagnostic.code not in _UNUSED
    )
    if spec is None:
        return about_specs
    (place,) = (item.declaration.span for item in view.specs if item.spec.name == spec)
    return tuple(
        diagnostic
        for diagnostic in about_specs
        if any(label.source == source and place.covers(label.span) for label in diagnostic.labels[:1])
    )


def _as_warning(diagnostic: Diagnostic, project: Project) -> Diagnostic:
    return diagnostic if diagnostic.code in project.lint else replace(diagnostic, severity="warning")
