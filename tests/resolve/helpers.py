"""Resolve a text as the compiler does, without a file."""

from __future__ import annotations

from pathlib import Path

from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.expression.evaluate import evaluate
from tltlc.grammar.parser import parse
from tltlc.resolve.options import ResolveOptions
from tltlc.resolve.resolution import resolve
from tltlc.resolve.spec import ResolvedFile, Spec


def resolve_text(text: str, name: str = "<test>", **options: object) -> tuple[ResolvedFile, tuple[Diagnostic, ...]]:
    """Resolve a text that parses, and return the program and all diagnostics of the resolution."""
    module, errors = parse(SourceFile(name, text))
    assert errors == ()
    result = resolve(module, ResolveOptions(**options))  # type: ignore[arg-type]
    return result.program, result.diagnostics


def valid_program(text: str, name: str = "<test>", **options: object) -> ResolvedFile:
    """Return the program of a text without diagnostics."""
    program, diagnostics = resolve_text(text, name, **options)
    assert diagnostics == ()
    return program


def only_spec(text: str, name: str = "<test>", **options: object) -> Spec:
    """Return the only spec of a text without diagnostics."""
    (spec,) = valid_program(text, name, **options).specs
    return spec


def formula(text: str) -> str:
    """Return the formula of the only spec of a text without diagnostics, in ASCII."""
    return str(only_spec(text).formula)


def codes(text: str, name: str = "<test>", **options: object) -> list[str]:
    """Return the codes of all diagnostics of a text."""
    return [diagnostic.code for diagnostic in resolve_text(text, name, **options)[1]]


def robustness_of(spec: Spec, atom: str, **signals: float) -> float:
    """Return the robustness of an atom of a spec, with the declared values of its params."""
    params = {param.name: param.value for param in spec.params}
    expression = next(candidate.expression for candidate in spec.atoms if candidate.name == atom)
    return evaluate(expression, signals, params)


def write(folder: Path, **files: str) -> None:
    """Write a file NAME.tltl for each keyword argument."""
    for name, text in files.items():
        (folder / f"{name}.tltl").write_text(text, encoding="utf-8")
