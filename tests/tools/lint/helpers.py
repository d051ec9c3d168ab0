"""Lints a text as the command does, without the file that it would stand in."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from tltlc.core.source import SourceFile
from tltlc.pipeline import CompileOptions
from tltlc.tools.lint.file_view import SpecView, View
from tltlc.tools.lint.fixing import Fixed, fix
from tltlc.tools.lint.rule import Finding, Remark
from tltlc.tools.lint.run import lint, view_of

SIGNALS = "signal a: bool signal b: bool signal c: bool\n"
RANGES = "signal x in [0, 10]\nsignal y in [0, 10]\n" + SIGNALS
PLACES = "entity x, y, z\nsignal d(e): length in [0 m, 9 m]\npredicate at(e: entity) = 1 - 2 * d(e) / 9 m\n"
APART = PLACES + "exclusive at(x), at(y)\n"
_HEAD = "spec s {\n    limit 9 steps\n    judge at goal\n    "


def found(text: str, **options: object) -> tuple[Finding, ...]:
    """What is to be said of a text."""
    return lint(SourceFile("example.tltl", text), CompileOptions(**options))  # type: ignore[arg-type]


def codes(text: str, **options: object) -> list[str]:
    """The codes of what is to be said of a text, in order."""
    return [each.diagnostic.code for each in found(text, **options)]


def marked(text: str, code: str) -> list[str]:
    """What the remarks with a code point at first."""
    labels = [each.diagnostic.labels[0] for each in found(text) if each.diagnostic.code == code]
    return [label.source.slice(label.span) for label in labels]


def remarks(check: Callable[[View], Iterable[Remark]], text: str) -> tuple[SpecView, list[Remark]]:
    """The spec of a text, and what one rule has to say of it, whatever others say."""
    view = view_of(SourceFile("example.tltl", text), CompileOptions())
    (spec,) = view.specs
    return spec, list(dict.fromkeys(check(view)))


def mended(text: str) -> Fixed:
    """A text with all its fixes."""
    return fix(SourceFile("example.tltl", text))


def block(*clauses: str, before: str = SIGNALS) -> str:
    """A spec of these clauses that has a limit and says when it is judged, so that nothing is said of that."""
    return before + _HEAD + "\n    ".join(clauses) + "\n}\n"


def of(code: str, *clauses: str, before: str = SIGNALS) -> list[str]:
    """What a rule points at in a spec of these clauses."""
    return marked(block(*clauses, before=before), code)
