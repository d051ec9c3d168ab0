"""Linting a file: it is compiled once, every rule looks at it, and comments silence what they allow."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping

from tltlc.diagnostics.diagnostic import Diagnostic, Label, stop_at_errors
from tltlc.grammar.parser import parse
from tltlc.grammar.silencing import unsilenced
from tltlc.grammar.tree import SpecDecl
from tltlc.lint.allow import silenced
from tltlc.lint.rule import Finding, Rule
from tltlc.lint.rules import rules
from tltlc.lint.view import SpecView, View
from tltlc.pipeline import CompileOptions, build_spec
from tltlc.record import replace
from tltlc.resolve.options import ResolveOptions
from tltlc.resolve.program import resolution
from tltlc.source import SourceFile


def lint(
    source: SourceFile, options: CompileOptions | None = None, elsewhere: Container[str] = frozenset()
) -> tuple[Finding, ...]:
    """What is to be said of a file that compiles, in the order of its text; the compiler's own warnings are among it.

    All specs of the file are looked at, whatever the options name; ``elsewhere`` are names that other files may use
    of it.
    Errors: :class:`TltlError` with everything that was found, as of :func:`tltlc.pipeline.compile_source`.
    """
    return findings(replace(view_of(source, options or CompileOptions()), elsewhere=elsewhere))


def findings(view: View) -> tuple[Finding, ...]:
    """What the compiler and the rules have to say of a file, less what its comments silence."""
    # The body of a quantifier is looked at once for each entity, and says the same of all.
    of_rules = [(rule, finding) for rule in rules() for finding in dict.fromkeys(_found(rule, view))]
    better: dict[str, list[Label]] = {}
    for rule, finding in of_rules:
        for code in rule.supersedes:
            better.setdefault(code, []).append(finding.diagnostic.labels[0])
    found = [Finding(said) for said in view.said] + [finding for _, finding in of_rules]
    found = [each for each in found if not _is_superseded(each.diagnostic, better.get(each.diagnostic.code, ()))]
    return tuple(sorted(silenced(view, found), key=lambda finding: _place(finding, view.source)))


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
        diagnostic = Diagnostic(rule.code, remark.title, remark.labels, remark.help, rule.severity)
        yield Finding(diagnostic, remark.fix)


def _is_superseded(said: Diagnostic, places: Iterable[Label]) -> bool:
    """Whether a diagnostic points at one of the places of which a rule says more."""
    return any(
        label.source == place.source and label.span.covers(place.span) for label in said.labels for place in places
    )


def _place(finding: Finding, source: SourceFile) -> tuple[bool, int, str]:
    """Where a finding stands among others: those of imported files come first."""
    label = finding.diagnostic.labels[0] if finding.diagnostic.labels else None
    return label is not None and label.source == source, label.span.start if label else 0, finding.diagnostic.code
