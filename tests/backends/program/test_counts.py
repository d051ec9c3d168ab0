"""Registers that are whole numbers, and read in no other way, are integers of a step that finds only the verdict."""

from __future__ import annotations

import pytest

from tltlc import compile_text
from tltlc.program.build import program
from tltlc.program.counts import CountCandidate, Counts
from tltlc.program.tree import (
    Assign,
    BinaryNumber,
    Choice,
    Compare,
    Declare,
    If,
    Int,
    NumericCall,
    ProgramVariable,
    Real,
    Statement,
)
from tltlc.program.verdict_step import verdict_step

BEFORE, NOW, T, OTHER = (ProgramVariable(name) for name in ("before", "now", "t", "other"))


def kept_types(clauses: str, clock: str = "60 Hz") -> dict[str, str]:
    """Return the types of the registers that a step reads, by the kind of the register."""
    (fspa,) = compile_text(
        f"clock {clock}\nsignal p: bool\nsignal q: bool\nsignal x in [-4, 4]\nspec s {{ {clauses} }}"
    )
    step = verdict_step(program(fspa, (), has_bools=True))
    return {fspa.registers[register.index].kind: register.type for register in step.kept}


@pytest.mark.parametrize(
    ("clauses", "clock", "types"),
    [
        ("keep p implies eventually within 5 s q", "60 Hz", {"waiting": "int", "due": "bool"}),
        ("keep p implies eventually within 5 s q", "varies", {"waiting": "real", "due": "bool"}),
        ("keep times(p) < 3", "60 Hz", {"last": "bool", "times": "int"}),
        ("keep time_holding(p) < 3 s", "60 Hz", {"last": "bool", "time_holding": "int"}),
        ("keep time_holding(p) < 3 s", "varies", {"last": "bool", "time_holding": "real"}),
        ("keep x > previous(x)", "60 Hz", {"first": "bool", "last": "real"}),
        ("keep once x > 3", "60 Hz", {"once": "bool"}),
        ("keep highest(x) > 2", "60 Hz", {"first": "bool", "highest": "real"}),
    ],
)
def test_the_types_of_registers(clauses: str, clock: str, types: dict[str, str]) -> None:
    assert kept_types(clauses, clock) == types


def counts_of(*statements: Statement, magnitude: float = 601.0, **others: list[Statement]) -> Counts:
    return Counts({"now": statements, **others}, [CountCandidate("before", "now", magnitude)])


AGED = (
    Declare("t", "real", None, True),
    If(
        ((Compare(">", BEFORE, Real(0.5)), (Assign("t", BinaryNumber("+", BEFORE, Real(1.0))),)),),
        (Assign("t", Real(0.0)),),
    ),
    Declare("now", "real", NumericCall("min", (T, Real(601.0)))),
)


def test_a_count_and_its_temporary_variables_become_integers() -> None:
    counts = counts_of(*AGED)
    assert counts.names == {"before", "now", "t"}
    assert counts.statements(AGED) == (
        Declare("t", "int", None, True),
        If(
            ((Compare(">", BEFORE, Int(0)), (Assign("t", BinaryNumber("+", BEFORE, Int(1))),)),),
            (Assign("t", Int(0)),),
        ),
        Declare("now", "int", Choice(Compare("<", Int(601), T), Int(601), T)),
    )


@pytest.mark.parametrize(
    ("op", "limit", "whole"),
    [(">", 2.5, 2), (">=", 2.5, 3), ("<", 2.5, 3), ("<=", 2.5, 2), ("==", 2.0, 2), ("<", -0.5, 0)],
)
def test_borders_between_whole_numbers_become_whole(op: str, limit: float, whole: int) -> None:
    test = Compare(op, NOW, Real(limit))  # type: ignore[arg-type]
    counts = counts_of(*AGED, late=[Declare("late", "bool", test)])
    assert counts.statements([Declare("late", "bool", test)]) == (
        Declare("late", "bool", Compare(test.op, NOW, Int(whole))),
    )


def test_a_register_read_as_a_number_is_no_count() -> None:
    for value in (
        BinaryNumber("/", NOW, Real(2.0)),
        NumericCall("min", (NOW, OTHER)),
        NOW,
        Choice(Compare(">", OTHER, NOW), NOW, OTHER),
    ):
        assert not counts_of(*AGED, share=[Declare("share", "real", value)]).names & {"now", "before"}


def test_a_register_that_may_be_no_whole_number_or_too_great_is_no_count() -> None:
    assert not counts_of(Declare("now", "real", BinaryNumber("+", BEFORE, Real(0.5)))).names
    assert not counts_of(Declare("now", "real", BinaryNumber("+", BEFORE, OTHER))).names
    assert not counts_of(*AGED, magnitude=2.0**31 - 1).names & {"now", "before"}
    assert counts_of(*AGED, magnitude=2.0**31 - 2).names == {"now", "before", "t"}
