"""``tltlc mine`` with a library whose clock varies: each sample brings its own length."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import Outcome
from tltlc.core.source import SourceFile
from tltlc.resolve.options import ResolveOptions
from tltlc.tools.mine.evidence_reader import read_evidence
from tltlc.tools.mine.search import MiningOptions, SpecSearch
from tltlc.tools.mine.trace_letters import TraceFile
from tltlc.tools.witness.step_lengths import length_of

LIBRARY = """\
clock varies
signal a: bool
signal b: bool
signal h in [0, 10]
predicate high in [-1, 1] = clamp((h - 5) / 5, -1, 1)
predicate long in [-1, 1] = clamp((time_holding(b, 1 s) - 0.125 s) / 1 s, -1, 1)
"""
FIRST = b"time,a,b,h\n0,1,0,1\n0.5,0,1,7\n0.75,0,1,8\n2.0,1,0,1\n2.25,0,1,9\n3.5,0,1,9\n"
SECOND = b"time,a,b,h\n0,0,0,1\n0.25,1,0,2\n0.75,0,1,7\n1,0,1,8\n1.5,1,0,1\n3.25,0,1,9\n4.0,0,1,9\n"

Run = Callable[..., Outcome]


def test_lengths_of_steps_are_no_atoms() -> None:
    files = [TraceFile("first.csv", FIRST), TraceFile("second.csv", SECOND)]
    vocabulary, evidence, _ = read_evidence(files, (), SourceFile("game.tltl", LIBRARY), ResolveOptions())
    assert evidence.atoms() == ("a", "b", "high", "long")
    lengths = [length_of(letter, vocabulary.reader) for letter in evidence.traces[0].letters]
    assert lengths[1:] == [0.5, 0.25, 1.25, 0.25, 1.25]
    assert ["long" in letter for letter in evidence.traces[0].letters] == [False, False, True, False, False, True]
    search = SpecSearch(evidence, MiningOptions())
    for _ in search.run():
        pass
    clauses = {clause.text for conjunction in search.ranking() for clause in conjunction}
    assert clauses
    assert not any("step" in clause for clause in clauses)


@pytest.mark.parametrize("bad", [b"", b"time,a,b,h\n0,0,1,1\n0.1,1,0,2\n0.2,0,0,7\n"])
def test_what_is_mined_compiles_and_passes_its_tests(tltlc: Run, inside: Path, bad: bytes) -> None:
    (inside / "game.tltl").write_text(LIBRARY, encoding="utf-8")
    for name, data in (("first", FIRST), ("second", SECOND), ("bad", bad)):
        (inside / f"{name}.csv").write_bytes(data)
    against = ("--against", "bad.csv") if bad else ()
    outcome = tltlc("mine", "first.csv", "second.csv", *against, "--predicates", "game.tltl", "-o", "mined.tltl")
    assert (outcome.status, outcome.err) == (0, "wrote mined.tltl\n")
    assert "spec mined_1" in (inside / "mined.tltl").read_text(encoding="utf-8")
    assert tltlc("check", "mined.tltl").status == 0
    assert tltlc("test", "mined.tltl").status == 0
