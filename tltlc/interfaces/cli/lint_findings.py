"""The findings that ``tltlc check`` shows: those of the compiler, and that a spec may not mean what was meant."""

from __future__ import annotations

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.interfaces.compiled_input import Input
from tltlc.io.project import Project
from tltlc.tools.lint import allow
from tltlc.tools.lint.rules import rules
from tltlc.tools.lint.run import findings, view_of


def diagnostics_of(spec_input: Input, spec: str | None = None) -> tuple[Diagnostic, ...]:
    """Return the diagnostics of a compiled file, then the findings of the linter about its specs.

    A diagnostic of the compiler is left out if a finding of the linter supersedes it. An error of the
    linter is a warning here, because the file compiles; it stays an error if the project file says so.
    What says nothing about the meaning of a spec is left out unless the project file names its code:
    findings about training, sizes, and unused names and comments. If ``spec`` is the name of a spec in
    the file, only the findings inside this spec are returned. For an artefact, which has no text, the
    linter finds nothing.
    """
    if spec_input.session is None:
        return spec_input.diagnostics
    source, project = spec_input.session.source, spec_input.project
    with project.apply_lint_levels():
        view = view_of(source, spec_input.session.options)
    found = [finding.diagnostic for finding in findings(view, project.lint)]
    superseded = {*map(_without_severity, view.diagnostics)}.difference(map(_without_severity, found))
    compiled = [own for own in spec_input.diagnostics if _without_severity(own) not in superseded]
    left_out = {allow.CODE, *(rule.code for rule in rules() if rule.lint_only)}.difference(project.lint)
    about_specs = [_as_warning(diagnostic, project) for diagnostic in found if diagnostic.code not in left_out]
    if spec is not None:
        (place,) = (item.declaration.span for item in view.specs if item.spec.name == spec)
        about_specs = [
            diagnostic
            for diagnostic in about_specs
            if any(label.source == source and place.covers(label.span) for label in diagnostic.labels[:1])
        ]
    return (*compiled, *about_specs)


def _without_severity(diagnostic: Diagnostic) -> Diagnostic:
    return replace(diagnostic, severity="note")


def _as_warning(diagnostic: Diagnostic, project: Project) -> Diagnostic:
    if diagnostic.severity != "error" or diagnostic.code in project.lint:
        return diagnostic
    return replace(diagnostic, severity="warning")
