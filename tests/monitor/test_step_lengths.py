"""With `clock varies`, each sample brings its time since the sample before, and with a fixed clock none does."""

from __future__ import annotations

import json
from decimal import Decimal
from fractions import Fraction
from math import inf, nan
from typing import Any

import numpy as np
import pytest

from tltlc import compile_text
from tltlc.artefact.consistency import problems
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.expression.tree import Const, Op, StepLength
from tltlc.monitor import Monitor, MonitorError
from tltlc.pipeline import decode_artefact, encode_artefact

SIGNALS = "signal a: bool signal b: bool "
(VARYING,) = compile_text(f"clock varies {SIGNALS} spec s {{ keep within 1 s of a, b keep time_since(a) <= 9 s }}")
(WITHOUT_TIMES,) = compile_text(f"clock varies {SIGNALS} spec s {{ keep a }}")
(FIXED,) = compile_text(f"clock 8 Hz {SIGNALS} spec s {{ keep once within 1 s a }}")
(WITHOUT_CLOCK,) = compile_text(f"{SIGNALS} spec s {{ keep a }}")
SAMPLE = {"a": True, "b": False}


def call(monitor: Monitor, dt: Any, *, by_atoms: bool) -> None:
    """Take a sample with a and without b."""
    if by_atoms:
        names = [atom.name for atom in monitor.fspa.atoms if atom.name in SAMPLE]
        monitor.step_atoms([1.0 if SAMPLE[name] else -1.0 for name in names], dt)
    else:
        monitor.step(SAMPLE, dt)


@pytest.mark.parametrize("by_atoms", [False, True], ids=["signals", "atoms"])
@pytest.mark.parametrize("fspa", [VARYING, WITHOUT_TIMES], ids=["timers", "no timers"])
@pytest.mark.parametrize(
    ("dt", "words"),
    [
        (None, "is missing"),
        (-0.25, "-0.25, not a number of seconds"),
        (-5e-324, "-5e-324, not"),
        (nan, "nan, not"),
        (inf, "inf, not"),
        (-inf, "-inf, not"),
        (10**400, "inf, not"),
        ("0.25", "'0.25', not"),
        ([0.25], "[0.25], not"),
        ({}, "{}, not"),
        (1j, "1j, not"),
        (np.array([0.25]), "array([0.25]), not"),
        (np.array([0.25, 0.5]), "array([0.25, 0.5 ]), not"),
        (np.float32(nan), "nan, not"),
    ],
    ids=str,
)
def test_a_wrong_length_is_an_error_that_changes_nothing(fspa: Fspa, dt: Any, words: str, by_atoms: bool) -> None:
    monitor, steady = Monitor(fspa), Monitor(fspa)
    for count in range(1, 4):
        before = (monitor.state, monitor.steps, monitor.registers, monitor.progress, monitor.values)
        with pytest.raises(MonitorError) as raised:
            call(monitor, dt, by_atoms=by_atoms)
        (diagnostic,) = raised.value.diagnostics
        assert diagnostic.code == "TLT0619"
        assert diagnostic.title.startswith(f"step {count}: its time since the sample before is ")
        assert words in diagnostic.title
        assert (monitor.state, monitor.steps, monitor.registers, monitor.progress, monitor.values) == before
        assert monitor.step(SAMPLE, 0.25) == steady.step(SAMPLE, 0.25)


@pytest.mark.parametrize("by_atoms", [False, True], ids=["signals", "atoms"])
@pytest.mark.parametrize("fspa", [FIXED, WITHOUT_CLOCK], ids=["fixed", "none"])
@pytest.mark.parametrize("dt", [0.125, 0, -1.0, nan, "x"], ids=str)
def test_a_length_with_a_fixed_clock_is_an_error_that_changes_nothing(fspa: Fspa, dt: Any, by_atoms: bool) -> None:
    monitor, steady = Monitor(fspa), Monitor(fspa)
    for _ in range(3):
        registers = monitor.registers
        with pytest.raises(MonitorError, match=r"TLT0619: .*the clock of the spec does not vary"):
            call(monitor, dt, by_atoms=by_atoms)
        assert monitor.registers == registers
        assert monitor.step(SAMPLE) == steady.step(SAMPLE)


@pytest.mark.parametrize(
    "dt",
    [1, True, -0.0, Fraction(1, 4), Decimal("0.25"), np.float32(0.25), np.int64(2), np.array(0.25), 1e308],
    ids=repr,
)
def test_any_finite_number_from_0_is_a_length(dt: Any) -> None:
    monitor, expected = Monitor(VARYING), Monitor(VARYING)
    for _ in range(3):
        assert monitor.step(SAMPLE, dt) == expected.step(SAMPLE, float(dt))
    assert monitor.registers == expected.registers


def test_the_length_of_the_first_sample_counts_for_nothing() -> None:
    for first in (0.0, 0.5, 1e6):
        monitor = Monitor(VARYING)
        assert [monitor.step(SAMPLE, dt).verdict for dt in (first, 0.5, 0.5, 1e-9)] == [*["pending"] * 3, "violated"]


def test_another_monitor_has_times_of_its_own() -> None:
    first = Monitor(VARYING)
    first.step(SAMPLE, 0.0)
    second = first.another()
    assert second.registers == Monitor(VARYING).registers
    first.step(SAMPLE, 0.75)
    assert [second.step(SAMPLE, dt).verdict for dt in (0.75, 0.75)] == ["pending", "pending"]
    assert [monitor.step(SAMPLE, 0.5).verdict for monitor in (first, second)] == ["violated", "violated"]
    with pytest.raises(MonitorError, match="TLT0619"):
        second.another().step(SAMPLE)


def test_a_last_sample_may_have_a_length() -> None:
    step = Monitor(VARYING).step({"a": True, "b": True}, 0.5, last=True)
    assert (step.done, step.accepting) == (True, True)


def document_of(fspa: Fspa) -> dict[str, Any]:
    document: dict[str, Any] = json.loads(json.dumps(encode_artefact(fspa)))
    return document


@pytest.mark.parametrize("fspa", [VARYING, WITHOUT_TIMES, FIXED, WITHOUT_CLOCK])
def test_an_artefact_says_whether_the_clock_varies(fspa: Fspa) -> None:
    document = document_of(fspa)
    assert decode_artefact(document, "copy") == fspa
    assert document["spec"].get("clock_varies", False) == fspa.clock_varies
    assert document["version"] == (2 if fspa.clock_varies or fspa.registers else 1)


def test_an_artefact_of_version_1_has_a_fixed_clock() -> None:
    document = document_of(WITHOUT_CLOCK)
    assert "clock_varies" not in document["spec"]
    del document["spec"]["clock_s"]
    assert decode_artefact(document, "old").clock_varies is False


def step_length_in(fspa: Fspa) -> Fspa:
    (register, *rest) = fspa.registers
    return replace(fspa, registers=(replace(register, update=Op("min", (StepLength(), Const(1.0)))), *rest))


@pytest.mark.parametrize(
    ("fspa", "message"),
    [
        (replace(VARYING, clock_s=0.125), "the clock varies, so it has no `clock_s`"),
        (step_length_in(FIXED), "reads the length of a step, but the clock does not vary"),
        (replace(VARYING, clock_varies=False), "reads the length of a step, but the clock does not vary"),
        (replace(FIXED, clock_varies=True, clock_s=None), "counts steps as a time, but the clock varies"),
    ],
)
def test_an_artefact_whose_times_contradict_its_clock_is_an_error(fspa: Fspa, message: str) -> None:
    assert any(message in problem.message for problem in problems(fspa))
    with pytest.raises(TltlError) as raised:
        decode_artefact(document_of(fspa), "wrong")
    assert any(message in diagnostic.title for diagnostic in raised.value.diagnostics), raised.value
    assert {diagnostic.code for diagnostic in raised.value.diagnostics} == {"TLT0604"}


@pytest.mark.parametrize("value", [1, "true", None, []])
def test_whether_the_clock_varies_is_true_or_false(value: object) -> None:
    document = document_of(VARYING)
    document["spec"]["clock_varies"] = value
    with pytest.raises(TltlError):
        decode_artefact(document, "wrong")
