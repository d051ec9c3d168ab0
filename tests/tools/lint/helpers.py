"""Lint a text as the command does, without a file."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import lru_cache
from itertools import product

from tltlc.core.source import SourceFile
from tltlc.monitor import Monitor
from tltlc.pipeline import CompileOptions, compile_text
from tltlc.tools.lint.file_view import FileView, SpecView
from tltlc.tools.lint.fix_application import FixedFile, fix
from tltlc.tools.lint.rule import LintFinding, RuleFinding
from tltlc.tools.lint.run import lint, view_of

SIGNALS = "signal a: bool signal b: bool signal c: bool\n"
RANGES = "signal x in [0, 10]\nsignal y in [0, 10]\n" + SIGNALS
PLACES = "entity x, y, z\nsignal d(e): length in [0 m, 9 m]\npredicate at(e: entity) = 1 - 2 * d(e) / 9 m\n"
APART = PLACES + "exclusive at(x), at(y)\n"
_HEAD = "spec s {\n    limit 9 steps\n    judge at goal\n    "


def findings_in(text: str, **options: object) -> tuple[LintFinding, ...]:
    """Return the findings of the linter in a text."""
    return lint(SourceFile("example.tltl", text), CompileOptions(**options))  # type: ignore[arg-type]


def codes(text: str, **options: object) -> list[str]:
    """Return the codes of the findings in a text, in order."""
    return [finding.diagnostic.code for finding in findings_in(text, **options)]


def labelled_texts(text: str, code: str) -> list[str]:
    """Return the text at the first label of each finding with this code."""
    labels = [finding.diagnostic.labels[0] for finding in findings_in(text) if finding.diagnostic.code == code]
    return [label.source.slice(label.span) for label in labels]


def spec_and_findings(
    check: Callable[[FileView], Iterable[RuleFinding]], text: str
) -> tuple[SpecView, list[RuleFinding]]:
    """Return the only spec of a text, and the findings of one rule on it, without duplicates."""
    view = view_of(SourceFile("example.tltl", text), CompileOptions())
    (spec,) = view.specs
    return spec, list(dict.fromkeys(check(view)))


def apply_fixes(text: str) -> FixedFile:
    """Apply all fixes to a text."""
    return fix(SourceFile("example.tltl", text))


def block(*clauses: str, before: str = SIGNALS) -> str:
    """Return a spec of these clauses. It has a limit and `judge at goal`, so that no rule reports
    their absence."""
    return before + _HEAD + "\n    ".join(clauses) + "\n}\n"


def labelled_texts_in_block(code: str, *clauses: str, before: str = SIGNALS) -> list[str]:
    """Return the text at the first label of each finding with this code, in a spec of these clauses."""
    return labelled_texts(block(*clauses, before=before), code)


@lru_cache(maxsize=256)
def accepted_traces(text: str, bools: str, longest: int = 5) -> frozenset[tuple[str, ...]]:
    """Return the traces of at most ``longest`` samples that a monitor of the only spec of a text accepts.

    ``bools`` has the names of the bool signals, one letter each. A sample is a string of those that are true.
    """
    (fspa,) = compile_text(text)
    samples = ["".join(names) for names in product(*(("", name) for name in bools))]
    accepted = set()
    for trace in product(samples, repeat=longest):
        monitor = Monitor(fspa)
        for length, sample in enumerate(trace, start=1):
            if monitor.step({name: float(name in sample) for name in bools}).accepting:
                accepted.add(trace[:length])
    return frozenset(accepted)
