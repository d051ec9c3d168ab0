"""Linting a file: it is compiled once, every rule looks at it, and comments silence what they allow."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping
from typing import Final

from tltlc.core.record import EMPTY, replace
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, stop_at_errors
from tltlc.grammar.allow_index import unsilenced
from tltlc.grammar.parser import parse
from tltlc.grammar.tree import SpecDecl
from tltlc.pipeline import CompileOptions, build_spec
from tltlc.resolve.options import ResolveOptions
from tltlc.resolve.program import resolution
from tltlc.tools.lint.allow import silenced
from tltlc.tools.lint.file_view import SpecView, View
from tltlc.tools.lint.rule import Finding, Rule
from tltlc.tools.lint.rules import rules

_COUNTS: Final = {"note": 0, "warning": 1, "error": 2}


def lint(
    source: SourceFile,
    options: CompileOptions | None = None,
    elsewhere: Container[str] = frozenset(),
    levels: Mapping[str, str] = EMPTY,
) -> tuple[Finding, ...]:
    """What is to be said of a file that compiles, in the order of its text; the compiler's own warnings are among it.

    All specs of the file are looked at, whatever the options name; ``elsewhere`` are names that other files may use
    of it; :func:`levelled` explains ``levels``.
    Errors: :class:`TltlError` with everything that was found, as of :func:`tltlc.pipeline.compile_source`.
    """
    return findings(replace(view_of(source, options or CompileOptions()), elsewhere=elsewhere), levels)


def findings(view: View, levels: Mapping[str, str] = EMPTY) -> tuple[Finding, ...]:
    """What the compiler and the rules have to say of a file, less what its comments and ``levels`` silence.

    Only what is shown supersedes anything, and nothing of a higher severity than its own.
    """
    found = [Finding(said) for said in view.said]
    supersedes: dict[str, tuple[str, ...]] = {}
    for rule in rules():
        # The body of a quantifier is looked at once for each entity, and says the same of all.
        found += dict.fromkeys(_found(rule, view))
        supersedes[rule.code] = rule.supersedes
    shown = levelled(silenced(view, found), levels)
    more: dict[str, list[Diagnostic]] = {}
    for finding in shown:
        for code in supersedes.get(finding.diagnostic.code, ()):
            more.setdefault(code, []).append(finding.diagnostic)
    left = [each for each in shown if not _is_superseded(each.diagnostic, more.get(each.diagnostic.code, ()))]
    return tuple(sorted(left, key=lambda finding: _place(finding, view.source)))


def levelled(found: Iterable[Finding], levels: Mapping[str, str]) -> tuple[Finding, ...]:
    """The findings with the severities of ``levels``, code by code, less those whose level is ``allow``."""
    left = [each for each in found if levels.get(each.diagnostic.code) != "allow"]
    return tuple(_at(each, levels.get(each.diagnostic.code, each.diagnostic.severity)) for each in left)


def view_of(source: SourceFile, options: CompileOptions) -> View:
    """A file parsed, resolved and compiled; errors as of :func:`lint`."""
    module, said = parse(source)
    stop_at_errors(said)
    resolved = resolution(module, ResolveOptions(library_dirs=options.library_dirs, params=options.params))
    said += resolved.diagnostics
    modules = [loaded.module for loaded in resolved.modules]
    stop_at_errors(unsilenced(modules, said))
    declared = {each.name: each for each in module.declarations if isinstance(each, SpecDecl)}
    specs: list[SpecView] = []
    for spec in resolved.program.specs:
        fspa, remarks = build_spec(spec, options)
        said += remarks
        if fspa is not None:
            specs.append(SpecView(declared[spec.name], spec, fspa, resolved.env))
    stop_at_errors(unsilenced(modules, said))
    return View(module, resolved.env, resolved.modules, tuple(specs), said, program=resolved.program)


def _at(finding: Finding, severity: str) -> Finding:
    return replace(finding, diagnostic=replace(finding.diagnostic, severity=severity))


def _found(rule: Rule, view: View) -> Iterator[Finding]:
    for remark in rule.check(view):
        fixes = (remark.fix,) if remark.fix else ()
        yield Finding(Diagnostic(rule.code, remark.title, remark.labels, remark.help, rule.severity, fixes))


def _is_superseded(diagnostic: Diagnostic, more: Iterable[Diagnostic]) -> bool:
    """Whether a rule says more of one of the places that a diagnostic points at, and counts as much."""
    places = [other.labels[0] for other in more if _COUNTS[other.severity] >= _COUNTS[diagnostic.severity]]
    labels = diagnostic.labels
    return any(label.source == place.source and label.span.covers(place.span) for label in labels for place in places)


def _place(finding: Finding, source: SourceFile) -> tuple[bool, int, str]:
    """Where a finding stands among others: those of imported files come first."""
    label = finding.diagnostic.labels[0] if finding.diagnostic.labels else None
    return label is not None and label.source == source, label.span.start if label else 0, finding.diagnostic.code
