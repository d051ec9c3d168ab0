"""Peers that learn formulas from traces: plain enumeration, and Scarlet (TACAS 2022), from PyPI."""

from __future__ import annotations

import csv
import re
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Final

from benchmarks.measure import run
from tltlc.tools.mine.evidence import Evidence, LabelledTrace

Values = tuple[int, ...]
"""The truth of a formula at every sample: a number for each trace, with the first sample as its lowest bit."""

_SCARLET: Final = """
import sys
from Scarlet.ltllearner import LTLlearner
LTLlearner(input_file=sys.argv[1], csvname=sys.argv[2], timeout=float(sys.argv[3]), verbosity=0).learn()
"""


@dataclass(frozen=True)
class LearnedFormula:
    """What a peer found.

    ``formula`` is in our language; None if the peer found none. ``seconds`` is the time until the
    peer ended or was stopped, and ``tried`` the number of formulas that it tried or reported.
    """

    formula: str | None
    seconds: float
    tried: int = 0


def enumerate_formulas(evidence: Evidence, timeout_s: float) -> LearnedFormula:
    """Find the shortest formula of `! & | X F G U` that all traces satisfy and all counterexamples violate.

    Formulas are enumerated by size; of formulas that agree on all samples, only the first one is used.
    """
    start = time.perf_counter()
    tried = 0
    good = len(evidence.traces)
    for formula, values in _formulas(evidence):
        tried += 1
        accepts = [value & 1 for value in values]
        if all(accepts[:good]) and not any(accepts[good:]):
            return LearnedFormula(formula, time.perf_counter() - start, tried)
        if tried % 64 == 0 and time.perf_counter() - start > timeout_s:
            break
    return LearnedFormula(None, time.perf_counter() - start, tried)


def _formulas(evidence: Evidence) -> Iterator[tuple[str, Values]]:
    traces = evidence.all
    full_masks = tuple((1 << len(trace.letters)) - 1 for trace in traces)
    seen: set[Values] = set()
    by_size: list[list[tuple[str, Values]]] = [[]]

    def new(formula: str, values: Values, size: int) -> Iterator[tuple[str, Values]]:
        if values not in seen:
            seen.add(values)
            by_size[size].append((formula, values))
            yield formula, values

    by_size.append([])
    for atom in evidence.atoms():
        yield from new(atom, tuple(_mask(trace, atom) for trace in traces), 1)
    while True:
        size = len(by_size)
        by_size.append([])
        for formula, values in by_size[size - 1]:
            pairs = list(zip(values, full_masks, strict=True))
            yield from new(f"(!{formula})", tuple(full_mask & ~value for value, full_mask in pairs), size)
            yield from new(f"(X {formula})", tuple(value >> 1 for value in values), size)
            yield from new(f"(F {formula})", tuple((1 << value.bit_length()) - 1 for value in values), size)
            always = tuple(full_mask & ~((1 << (full_mask & ~value).bit_length()) - 1) for value, full_mask in pairs)
            yield from new(f"(G {formula})", always, size)
        for left_size in range(1, size - 1):
            for left, left_values in by_size[left_size]:
                for right, right_values in by_size[size - 1 - left_size]:
                    both = list(zip(left_values, right_values, strict=True))
                    if left < right:
                        yield from new(f"({left} & {right})", tuple(a & b for a, b in both), size)
                        yield from new(f"({left} | {right})", tuple(a | b for a, b in both), size)
                    yield from new(f"({left} U {right})", tuple(_until(a, b) for a, b in both), size)


def _mask(trace: LabelledTrace, atom: str) -> int:
    return sum(1 << index for index, letter in enumerate(trace.letters) if atom in letter)


def _until(left: int, right: int) -> int:
    reached = right
    while True:
        further = reached | (left & (reached >> 1))
        if further == reached:
            return reached
        reached = further


def has_scarlet() -> bool:
    """Whether Scarlet and the package that it imports are installed."""
    return all(map(find_spec, ("Scarlet", "ltlf2dfa")))


def scarlet(evidence: Evidence, timeout_s: float) -> LearnedFormula:
    """Return the last formula that Scarlet reports; the time includes its process."""
    atoms = evidence.atoms()
    with tempfile.TemporaryDirectory() as folder:
        sample, table = Path(folder) / "sample.trace", Path(folder) / "found.csv"
        parts = [
            "\n".join(_line(trace, atoms) for trace in part) for part in (evidence.traces, evidence.counterexamples)
        ]
        sample.write_text("\n---\n".join(parts) + "\n", encoding="utf-8")
        table.touch()
        command = [sys.executable, "-c", _SCARLET, str(sample), str(table), str(timeout_s)]
        process_run = run(command, timeout_s + 5.0)
        rows = list(csv.reader(table.read_text(encoding="utf-8").splitlines()))[1:]
    formulas = [row[2] for row in rows if len(row) > 2]
    return LearnedFormula(
        _with_our_atoms(formulas[-1], atoms) if formulas else None, process_run.wall_ms / 1e3, len(formulas)
    )


def _line(trace: LabelledTrace, atoms: tuple[str, ...]) -> str:
    return ";".join(",".join(str(int(atom in letter)) for atom in atoms) for letter in trace.letters)


def _with_our_atoms(formula: str, atoms: tuple[str, ...]) -> str:
    """Replace Scarlet's letters p, q, r, … by our atoms."""
    return re.sub(r"\b[p-z]\b", lambda letter: atoms[ord(letter[0]) - ord("p")], formula)
