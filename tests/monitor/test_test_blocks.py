from __future__ import annotations

import pytest

from tests.calls import calls
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.monitor.spec_tests import run_tests
from tltlc.pipeline import compile_source

SPEC = """
signal a: bool
signal b: bool
signal p: bool
exclusive a, b
spec s { limit 100 steps  reach a then b  keep p }
"""


def failures(*blocks: str) -> list[Diagnostic | None]:
    text = SPEC + "\n".join(f'test "{index}" for s {{ {block} }}' for index, block in enumerate(blocks))
    compiled = compile_source(SourceFile("specs.tltl", text))
    return [result.failure for result in run_tests(compiled.program, compiled.automata)]


@pytest.mark.parametrize(
    "block",
    [
        "step p  expect pending",
        "step p, a  step p, b  expect holding",
        "step 3x p, a  expect progress >= 0.5  step p, b  expect progress >= 1",
        "step a  expect violated  step p, a, not b  expect violated",
        'step p, a  expect state "F b & G p"',
        'step p, a  expect state "◇b ∧ □p"',
        "step p  expect progress < 0.1  step p, a  expect progress <= 0.5 expect progress > 0.4",
    ],
)
def test_correct_expectations_pass(block: str) -> None:
    assert failures(block) == [None]


def test_repeated_steps_that_change_nothing_are_skipped() -> None:
    block = "step 99999x p  " * 100 + "expect pending  step p, a  step 5x p, b  expect holding"
    assert failures(block) == [None]
    # Ten million steps would take more than ten million calls.  Measured: 37,426.
    assert calls(lambda: failures(block)) < 1_000_000


@pytest.mark.parametrize(
    ("block", "remark", "marked"),
    [
        ("step p  expect holding", "it is pending", "expect holding"),
        ("step p, a  expect progress >= 0.75", "the progress is 0.5", "expect progress >= 0.75"),
        ('step p  expect state "G p"', "the state is `F(a & X F b) & G p`", 'expect state "G p"'),
        ("expect pending  step p", "a trace has at least one sample", "expect pending"),
    ],
)
def test_a_failed_expectation_is_labelled(block: str, remark: str, marked: str) -> None:
    (failure,) = failures(block)
    assert failure is not None
    (label,) = failure.labels
    assert (failure.code, label.message) == ("TLT0640", remark)
    assert label.source.slice(label.span) == marked


def test_an_impossible_step_is_an_error() -> None:
    (failure,) = failures("step p  step p, a, b  expect pending")
    assert failure is not None
    assert (failure.code, failure.title) == ("TLT0614", "step 2: `a` and `b` hold at once, against `exclusive a, b`")


def test_tests_run_in_order_and_independently() -> None:
    results = failures("step p, a  step p, b  expect holding", "step p, b  expect holding", "step p  expect pending")
    assert [failure is None for failure in results] == [True, False, True]


MEMORY = """
clock 10 Hz
signal a: bool
spec s { keep times(a) <= 2  reach time_holding(a) >= 1 s }
"""


@pytest.mark.parametrize(
    "block",
    [
        "step 10x a  expect pending  step a  expect holding",
        "step a  step not a  step a  step not a  step a  expect violated",
        "step 100000x a  step not a  step a  expect holding",
    ],
)
def test_counts_and_times_are_computed_from_the_steps(block: str) -> None:
    compiled = compile_source(SourceFile("specs.tltl", f'{MEMORY} test "t" for s {{ {block} }}'))
    assert [result.failure for result in run_tests(compiled.program, compiled.automata)] == [None]
