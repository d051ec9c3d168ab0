"""Resolves a text as the compiler does, without the file that it would stand in."""

from __future__ import annotations

from pathlib import Path

from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.expression.evaluate import evaluate
from tltlc.grammar.parser import parse
from tltlc.resolve.options import ResolveOptions
from tltlc.resolve.program import resolve
from tltlc.resolve.spec import Program, Spec


def resolved(text: str, name: str = "<test>", **options: object) -> tuple[Program, tuple[Diagnostic, ...]]:
    """The program of a text that parses, and every diagnostic of its resolution."""
    module, errors = parse(SourceFile(name, text))
    assert errors == ()
    return resolve(module, ResolveOptions(**options))  # type: ignore[arg-type]


def good(text: str, name: str = "<test>", **options: object) -> Program:
    """The program of a text about which there is nothing to say."""
    program, diagnostics = resolved(text, name, **options)
    assert diagnostics == ()
    return program


def only(text: str, name: str = "<test>", **options: object) -> Spec:
    """The one spec of such a text."""
    (spec,) = good(text, name, **options).specs
    return spec


def formula(text: str) -> str:
    """The formula of the one spec of such a text, in ASCII."""
    return str(only(text).formula)


def codes(text: str, name: str = "<test>", **options: object) -> list[str]:
    """The codes of all diagnostics of a text."""
    return [diagnostic.code for diagnostic in resolved(text, name, **options)[1]]


def value(spec: Spec, atom: str, **signals: float) -> float:
    """The robustness of an atom of a spec, with its params at their values."""
    params = {param.name: param.value for param in spec.params}
    expression = next(each.expression for each in spec.atoms if each.name == atom)
    return evaluate(expression, signals, params)


def write(folder: Path, **files: str) -> None:
    """Writes NAME.tltl for each keyword."""
    for name, text in files.items():
        (folder / f"{name}.tltl").write_text(text, encoding="utf-8")
