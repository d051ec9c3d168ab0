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
"""Of a formula its truth at every sample of every trace: a number per trace, the first sample its lowest bit."""

_SCARLET: Final = """
import sys
from Scarlet.ltllearner import LTLlearner
LTLlearner(input_file=sys.argv[1], csvname=sys.argv[2], timeout=float(sys.argv[3]), verbosity=0).learn()
"""


@dataclass(frozen=True)
class Learned:
    """What a peer found, as a formula in the language, None for nothing; and the seconds it took or was given."""

    formula: str | None
    seconds: float
    tried: int = 0


def enumerated(evidence: Evidence, timeout_s: float) -> Learned:
    """The shortest formula of `! & | X F G U` that all traces satisfy and all counterexamples violate.

    Formulas come by their size, one of those that are alike on all samples; truth is a bit per sample.
    """
    begun = time.perf_counter()
    tried = 0
    good = len(evidence.traces)
    for formula, values in _formulas(evidence):
        tried += 1
        accepts = [value & 1 for value in values]
        if all(accepts[:good]) and not any(accepts[good:]):
            return Learned(formula, time.perf_counter() - begun, tried)
        if tried % 64 == 0 and time.perf_counter() - begun > timeout_s:
            break
    return Learned(None, time.perf_counter() - begun, tried)


def _formulas(evidence: Evidence) -> Iterator[tuple[str, Values]]:
    traces = evidence.all
    wholes = tuple((1 << len(trace.letters)) - 1 for trace in traces)
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
            pairs = list(zip(values, wholes, strict=True))
            yield from new(f"(!{formula})", tuple(whole & ~value for value, whole in pairs), size)
            yield from new(f"(X {formula})", tuple(value >> 1 for value in values), size)
            yield from new(f"(F {formula})", tuple((1 << value.bit_length()) - 1 for value in values), size)
            always = tuple(whole & ~((1 << (whole & ~value).bit_length()) - 1) for value, whole in pairs)
            yield from new(f"(G {formula})", always, size)
        for left_size in range(1, size - 1):
            for left, these in by_size[left_size]:
                for right, those in by_size[size - 1 - left_size]:
                    both = list(zip(these, those, strict=True))
                    if left < right:
                        yield from new(f"({left} & {right})", tuple(one & other for one, other in both), size)
                        yield from new(f"({left} | {right})", tuple(one | other for one, other in both), size)
                    yield from new(f"({left} U {right})", tuple(_until(one, other) for one, other in both), size)


def _mask(trace: LabelledTrace, atom: str) -> int:
    return sum(1 << place for place, letter in enumerate(trace.letters) if atom in letter)


def _until(left: int, right: int) -> int:
    found = right
    while True:
        further = found | (left & (found >> 1))
        if further == found:
            return found
        found = further


def has_scarlet() -> bool:
    """Whether Scarlet is installed, with what it imports."""
    return all(map(find_spec, ("Scarlet", "ltlf2dfa")))


def scarlet(evidence: Evidence, timeout_s: float) -> Learned:
    """The last formula that Scarlet reports, by default one that separates all; its process included."""
    atoms = evidence.atoms()
    with tempfile.TemporaryDirectory() as place:
        sample, table = Path(place) / "sample.trace", Path(place) / "found.csv"
        parts = [
            "\n".join(_line(trace, atoms) for trace in part) for part in (evidence.traces, evidence.counterexamples)
        ]
        sample.write_text("\n---\n".join(parts) + "\n", encoding="utf-8")
        table.touch()
        command = [sys.executable, "-c", _SCARLET, str(sample), str(table), str(timeout_s)]
        made = run(command, timeout_s + 5.0)
        rows = list(csv.reader(table.read_text(encoding="utf-8").splitlines()))[1:]
    found = [row[2] for row in rows if len(row) > 2]
    return Learned(_renamed(found[-1], atoms) if found else None, made.wall_ms / 1e3, len(found))


def _line(trace: LabelledTrace, atoms: tuple[str, ...]) -> str:
    return ";".join(",".join(str(int(atom in letter)) for atom in atoms) for letter in trace.letters)


def _renamed(formula: str, atoms: tuple[str, ...]) -> str:
    """Scarlet's letters, p, q, r and so on, as our atoms."""
    return re.sub(r"\b[p-z]\b", lambda found: atoms[ord(found[0]) - ord("p")], formula)
