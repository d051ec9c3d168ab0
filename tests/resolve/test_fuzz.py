"""Broken programs give diagnostics, and never raise an exception."""

from __future__ import annotations

import random
import re
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from tests.calls import calls
from tests.fuzzing import times
from tltlc.core.source import SourceFile
from tltlc.grammar.parser import parse
from tltlc.resolve.resolution import resolve

ROOT = Path(__file__).parents[2]
TEXTS = [
    *(path.read_text(encoding="utf-8") for path in sorted((ROOT / "examples").glob("*.tltl"))),
    *(path.read_text(encoding="utf-8") for path in sorted((ROOT / "stdlib_predicates").glob("*.tltl"))),
]
TOKEN = re.compile(r"//[^\n]*|[A-Za-z_][\w.]*|[0-9.]+|\s+|.", re.DOTALL)
PIECES = [
    "inf",
    "near",
    "e",
    "s1",
    "0",
    "-1",
    "1 m",
    "20 steps",
    "F",
    "(",
    ")",
    ",",
    "&",
    "then",
    "distance",
    "x",
    "[",
    "<",
]


@times(60)
@given(number=st.integers(0, len(TEXTS) - 1), seed=st.integers(0, 10_000), edits=st.integers(1, 6))
def test_mutated_programs_raise_no_exception(number: int, seed: int, edits: int) -> None:
    tokens = TOKEN.findall(TEXTS[number])
    rng = random.Random(seed)
    for _ in range(edits):
        place = rng.randrange(len(tokens))
        kind = rng.randrange(4)
        if kind == 0:
            del tokens[place]
        elif kind == 1:
            tokens[place] = rng.choice(PIECES)
        elif kind == 2:
            tokens[place], tokens[rng.randrange(len(tokens))] = tokens[rng.randrange(len(tokens))], tokens[place]
        else:
            tokens.insert(place, rng.choice(tokens))
    module, _ = parse(SourceFile("<fuzz>", "".join(tokens)))
    result = resolve(module)
    program, diagnostics = result.program, result.diagnostics
    assert all(diagnostic.title for diagnostic in diagnostics)
    assert all(spec.parts for spec in program.specs)


def test_suggestions_for_misspelt_names_take_linear_work() -> None:
    def resolve_misspelt_names(names: int) -> None:
        declared = "".join(f"signal player_near_{number}: bool\n" for number in range(names))
        used = "".join(f"spec s{number} = G player_naer_{number}\n" for number in range(names))
        module, _ = parse(SourceFile("<many>", declared + used))
        diagnostics = resolve(module).diagnostics
        assert len(diagnostics) == names
        assert "did you mean `player_near_" in diagnostics[0].labels[0].message

    # If each name were compared with all others, twice as many names would take four times the work.
    assert calls(lambda: resolve_misspelt_names(400)) < 3 * calls(lambda: resolve_misspelt_names(200))
