"""Helpers that compare what a help suggests with the meaning of a sentence, over all short traces."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from itertools import product

import pytest

from tltlc import compile_text
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.monitor import Monitor
from tltlc.tools.lint.scopes import apply_edits

Trace = tuple[tuple[bool, ...], ...]
Meaning = Callable[[Trace], bool]
NAMES = """
clock 1 Hz
signal a: bool
signal b: bool
signal phase: int in [0, 3]
signal last: int in [0, 3]
signal mode: (idle, alert, chase)
signal coins in [0, 3]
entity door
signal has(x: entity): bool
"""
VARIES = NAMES.replace("clock 1 Hz", "clock varies")
LONGEST = {1: 7, 2: 4}
"""The greatest length of the traces, by how many of a and b the clauses name."""


def a(trace: Trace) -> list[bool]:
    return [sample[0] for sample in trace]


def b(trace: Trace) -> list[bool]:
    return [sample[1] for sample in trace]


def starts(trace: Trace) -> list[int]:
    """Return the steps at which a begins to hold."""
    holds = a(trace)
    return [i for i in range(len(holds)) if holds[i] and not (i and holds[i - 1])]


def error_of(clause: str, names: str = NAMES) -> tuple[str, Diagnostic]:
    text = f"{names}spec s {{ {clause} }}"
    with pytest.raises(TltlError) as failure:
        compile_text(text)
    return text, failure.value.diagnostics[0]


def suggestions(clause: str, names: str = NAMES) -> Iterator[str]:
    """Yield the clauses with which a help replaces a clause: that of its fix, else each one that it quotes."""
    text, error = error_of(clause, names)
    if error.fixes:
        fixed = apply_edits(SourceFile("a.tltl", text), error.fixes[0].edits).text
        yield fixed.removeprefix(f"{names}spec s {{").removesuffix("}")
        return
    for quoted in re.findall("`([^`]*)`", error.help or ""):
        yield quoted if quoted.split()[0] in ("keep", "reach", "avoid", "require") else f"require {quoted}"


def check(clauses: str, meaning: Meaning) -> None:
    """Assert that a spec with the clauses accepts exactly the traces of a meaning."""
    (fspa,) = compile_text(f"{NAMES}spec s {{ {clauses} }}")
    varied = [name in {signal.name for signal in fspa.signals} for name in ("a", "b")]
    letters = [letter for letter in product((False, True), repeat=2) if all(map(bool.__le__, letter, varied))]
    for trace in product(letters, repeat=LONGEST[sum(varied)]):
        monitor = Monitor(fspa)
        for stop, (now_a, now_b) in enumerate(trace, start=1):
            step = monitor.step({"a": now_a, "b": now_b})
            assert step.accepting == meaning(trace[:stop]), (clauses, trace[:stop])


def begins_twice_in_time(trace: Trace) -> bool:
    """Whether a begins to hold at two steps, the second one of the two steps after the first."""
    begun = starts(trace)
    return any(0 < second - first <= 2 for first in begun for second in begun)
