"""Lint a file: compile it once, run every rule, and apply the comments that silence findings."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping
from typing import Final

from tltlc.core.record import EMPTY, replace
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.grammar.tree import SpecDecl
from tltlc.pipeline import CompileOptions, Session
from tltlc.tools.lint.allow import apply_allow_comments
from tltlc.tools.lint.file_view import FileView, SpecView
from tltlc.tools.lint.rule import LintFinding, LintRule
from tltlc.tools.lint.rules import rules

_UNUSED: Final = "TLT0421"
"""The code of the declarations that nothing uses."""
_RANKS: Final = {"note": 0, "warning": 1, "error": 2}


def lint(
    source: SourceFile,
    options: CompileOptions | None = None,
    used_elsewhere: Container[str] = frozenset(),
    levels: Mapping[str, str] = EMPTY,
) -> tuple[LintFinding, ...]:
    """Return the findings about a file that compiles, in the order of its text.

    They include the compiler's own warnings. All specs of the file are checked, even if the options
    name only some. ``used_elsewhere`` contains the names of this file that other files may use.
    ``levels`` maps codes to severities: a finding gets the severity to which its code is mapped, and
    is left out if this is ``allow``.

    Raises:
        TltlError: all diagnostics, if the file does not compile, as in
            :func:`tltlc.pipeline.compile_source`.
    """
    return findings(replace(view_of(source, options or CompileOptions()), used_elsewhere=used_elsewhere), levels)


def findings(view: FileView, levels: Mapping[str, str] = EMPTY) -> tuple[LintFinding, ...]:
    """Return the findings of the compiler and of all rules, in the order of the text; unused declarations come last.

    Findings that ``allow`` comments silence are left out, and so are those that ``levels`` silences
    (:func:`apply_levels`). Of the rest, less specific findings are left out if a more specific
    finding supersedes them (:class:`~tltlc.tools.lint.rule.LintRule`).
    """
    all_findings = [LintFinding(diagnostic) for diagnostic in view.diagnostics]
    supersedes: dict[str, tuple[str, ...]] = {}
    for rule in rules():
        # Drop duplicates: a rule sees the body of a quantifier once for each entity.
        all_findings += dict.fromkeys(_rule_findings(rule, view))
        supersedes[rule.code] = rule.supersedes
    unsilenced = apply_levels(apply_allow_comments(view, all_findings), levels)
    superseding: dict[str, list[Diagnostic]] = {}
    for finding in unsilenced:
        for code in supersedes.get(finding.diagnostic.code, ()):
            superseding.setdefault(code, []).append(finding.diagnostic)
    remaining = [
        finding
        for finding in unsilenced
        if not _is_superseded(finding.diagnostic, superseding.get(finding.diagnostic.code, ()))
    ]
    return tuple(sorted(remaining, key=lambda finding: _sort_key(finding, view.source)))


def apply_levels(all_findings: Iterable[LintFinding], levels: Mapping[str, str]) -> tuple[LintFinding, ...]:
    """Return the findings with the severities in ``levels``, which maps codes to severities.

    A finding whose code is mapped to ``allow`` is left out. One whose code is not in ``levels``
    keeps its severity.
    """
    reported = [finding for finding in all_findings if levels.get(finding.diagnostic.code) != "allow"]
    return tuple(
        _with_severity(finding, levels.get(finding.diagnostic.code, finding.diagnostic.severity))
        for finding in reported
    )


def view_of(source: SourceFile, options: CompileOptions) -> FileView:
    """Compile all specs of a file, and return the file in the form that lint rules read.

    Raises:
        TltlError: all diagnostics, if the file does not compile.
    """
    session = Session(source, replace(options, specs=()))
    automata, module, resolved = session.automata, session.module, session.resolution
    declared = {
        declaration.name: declaration for declaration in module.declarations if isinstance(declaration, SpecDecl)
    }
    specs = tuple(
        SpecView(declared[spec.name], spec, fspa, resolved.env)
        for spec, fspa in zip(session.specs, automata, strict=True)
    )
    return FileView(module, resolved.env, resolved.modules, specs, session.reported, program=session.program)


def _with_severity(finding: LintFinding, severity: str) -> LintFinding:
    return replace(finding, diagnostic=replace(finding.diagnostic, severity=severity))


def _rule_findings(rule: LintRule, view: FileView) -> Iterator[LintFinding]:
    for finding in rule.check(view):
        fixes = (finding.fix,) if finding.fix else ()
        yield LintFinding(Diagnostic(rule.code, finding.title, finding.labels, finding.help, rule.severity, fixes))


def _is_superseded(diagnostic: Diagnostic, superseding: Iterable[Diagnostic]) -> bool:
    """Whether the diagnostics in ``superseding`` make ``diagnostic`` superfluous.

    They do if each label of ``diagnostic`` has a label of one of them inside, whose severity is at least
    that of ``diagnostic``.
    """
    places = [
        label
        for candidate in superseding
        if _RANKS[candidate.severity] >= _RANKS[diagnostic.severity]
        for label in candidate.labels
    ]
    return bool(places) and all(
        any(label.source == place.source and label.span.covers(place.span) for place in places)
        for label in diagnostic.labels
    )


def _sort_key(finding: LintFinding, source: SourceFile) -> tuple[int, int, str]:
    """Return the sort key of a finding: outside ``source``, then in it by position, then what nothing uses.

    A list of the unused declarations is long where rules share them, and says least about the rules.
    """
    label = finding.diagnostic.labels[0] if finding.diagnostic.labels else None
    place = (label is not None and label.source == source) + (finding.diagnostic.code == _UNUSED)
    return place, label.span.start if label else 0, finding.diagnostic.code
