"""The phrase book: each clause is explained as shown, has no finding of the linter, and has the
shown meaning."""

from __future__ import annotations

import re
from itertools import product

import pytest

import tltlc
from tests.docs.blocks import DOCS, blocks
from tltlc.automaton.compare import are_equivalent
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.text import formula_text
from tltlc.core.source import SourceFile
from tltlc.monitor import Monitor
from tltlc.tools.lint import run

PAGE = DOCS / "guides" / "phrases.md"
(DECLARED,) = (block.text for block in blocks(PAGE) if block.kind == "tltl")
ROWS = [
    [cell.strip() for cell in row.strip("|").split(" | ")]
    for row in PAGE.read_text(encoding="utf-8").splitlines()
    if row.startswith("| ") and "`" in row
]
PHRASES = [(write, read) for _, write, read in ROWS if write.startswith("`") and not read.startswith("`")]
MEASURES = [(declare, ask) for _, declare, ask in ROWS if declare.startswith("`") and ask.startswith("`")]
SLIPS = [(wrong, right) for wrong, _, right in ROWS if wrong.startswith("`")]


def text_of(cell: str) -> str:
    clauses = " ".join(re.findall(r"`([^`]+)`", cell))
    return f"{DECLARED}spec phrase {{\n    limit 60 s\n    {clauses}\n}}\n"


def compile_cell(cell: str) -> Fspa:
    (fspa,) = tltlc.compile_text(text_of(cell))
    return fspa


def test_all_rows_are_found() -> None:
    assert len(PHRASES) >= 20
    assert len(SLIPS) >= 6
    assert len(MEASURES) >= 6
    assert len(PHRASES) + len(MEASURES) + len(SLIPS) == len(ROWS)


@pytest.mark.parametrize(("write", "read"), PHRASES)
def test_a_phrase_is_explained_as_shown(write: str, read: str) -> None:
    assert formula_text(compile_cell(write)) == read


@pytest.mark.parametrize("write", [write for write, _ in PHRASES])
def test_a_phrase_has_no_finding(write: str) -> None:
    """Except that a spec of rules has no goal, and that declarations for other phrases are unused."""
    reported = {finding.diagnostic.code for finding in run.lint(SourceFile("phrase.tltl", text_of(write)))}
    assert reported <= {"TLT0420", "TLT0421"}


@pytest.mark.parametrize(("declare", "ask"), MEASURES)
def test_a_measured_signal_can_be_used_in_a_goal(declare: str, ask: str) -> None:
    entity = "entity gate\n" if "gate" in ask else ""
    text = f"{entity}{declare.strip('`')}\nspec asked {{ limit 9 steps  reach {ask.strip('`')} }}\n"
    (fspa,) = tltlc.compile_text(text)
    assert [len(fspa.atoms), fspa.spec_size] == [1, 1]
    assert not run.lint(SourceFile("asked.tltl", text))


@pytest.mark.parametrize(("wrong", "right"), SLIPS)
def test_a_wrong_phrase_differs_from_the_right_one(wrong: str, right: str) -> None:
    assert not are_equivalent(compile_cell(wrong), compile_cell(right))


ACCEPTED = {
    "`reach near(key)` `reach near(chest)`": (["near(chest)", "near(key)"], ["near(key)", "near(key)"]),
    "`reach near(key) then near(exit)` `reach near(chest) then near(exit)`": (
        ["near(chest)", "near(key)", "near(exit)"],
        ["near(key)", "near(exit)", "near(chest)"],
    ),
    "`require (not near(chest)) weak_until near(key)`": (
        ["", "near(key)", "near(chest)"],
        ["near(chest)", "near(key)"],
    ),
    "`require hidden until near(key)`": (["hidden", "near(key)"], ["hidden", "hidden"]),
    "`require always (alarm implies always not seen)`": (["seen", "alarm"], ["alarm", "seen"]),
    "`require always (alarm implies eventually near(exit))`": (["alarm", "near(exit)"], ["near(exit)", "alarm"]),
    "`require always (alarm implies weak_next hidden)`": (["alarm", "hidden"], ["alarm", ""]),
    "`require (eventually alarm) implies eventually near(exit)`": (["near(exit)", "alarm"], ["alarm", ""]),
    "`require eventually within 5 s near(exit)`": ([*[""] * 50, "near(exit)"], [*[""] * 51, "near(exit)"]),
}
"""For each phrase, a trace that it accepts and one that it rejects, given as the atom of each step."""


@pytest.mark.parametrize("write", ACCEPTED)
def test_a_phrase_accepts_and_rejects_the_listed_traces(write: str) -> None:
    assert write in dict(PHRASES)
    fspa = compile_cell(write)
    for trace, expected in zip(ACCEPTED[write], (True, False), strict=True):
        monitor = Monitor(fspa)
        for letter in trace:
            step = monitor.step_atoms([1.0 if atom.name == letter else -1.0 for atom in fspa.atoms])
        assert step.accepting == expected, trace


def test_staying_by_always_is_met_in_one_step() -> None:
    step = Monitor(compile_cell("`reach (always for 3 s near(vault))`")).step_atoms([1.0])
    assert step.accepting and step.done


def test_a_sequence_is_met_only_in_its_order() -> None:
    fspa = compile_cell("`reach near(key) then near(chest) then near(exit)`")
    for order in product(range(3), repeat=3):
        monitor = Monitor(fspa)
        for place in order:
            step = monitor.step_atoms([1.0 if place == atom else -1.0 for atom in range(len(fspa.atoms))])
        assert step.accepting == (order == (0, 1, 2))
