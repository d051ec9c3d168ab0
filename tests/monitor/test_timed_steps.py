"""Steps of a test that take a time: one sample after it where the clock varies, else all samples in it."""

from __future__ import annotations

import pytest

from tltlc import compile_text
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.monitor.spec_tests import run_tests
from tltlc.pipeline import Session, compile_source
from tltlc.tools.fmt import STYLES, format_text

SPEC = """signal a: bool
signal b: bool
spec s { keep within 2 s of a, b }
"""


def text_of(clock: str, block: str) -> str:
    return f'{clock}\n{SPEC}test "t" for s {{ {block} }}\n'


def failure(clock: str, block: str) -> Diagnostic | None:
    compiled = compile_source(SourceFile("specs.tltl", text_of(clock, block)))
    (result,) = run_tests(compiled.program, compiled.automata)
    return result.failure


def error(clock: str, block: str) -> str:
    with pytest.raises(TltlError) as raised:
        Session(SourceFile("<test>", text_of(clock, f"{block} expect pending"))).compiled()
    (diagnostic,) = raised.value.diagnostics
    assert diagnostic.labels
    return diagnostic.code


@pytest.mark.parametrize("clock", ["clock varies", "clock 8 Hz", "clock 60 Hz"])
@pytest.mark.parametrize(
    "block",
    [
        "step a  step for 1.75 s not b  expect pending  step for 0.5 s not b  expect violated",
        "step a  step for 2 s b  expect holding",
        "step a  step 3x for 0.5 s not b  expect pending  step for 0.5 s b  expect holding",
        "step a  step 3x for 0.5 s not b  expect pending  step for 0.75 s not b  expect violated",
        "step a  step for 1500 ms not b  expect pending  step for 0.5 s b  expect holding",
        "step a, b  step for 1 min not a  expect holding",
    ],
)
def test_a_time_means_the_same_on_both_kinds_of_clock(clock: str, block: str) -> None:
    assert failure(clock, block) is None


@pytest.mark.parametrize(
    ("block", "fails"),
    [
        # The time goes by before the sample: b may come as late as 2 s after a.
        ("step a  step for 2 s b  expect holding", False),
        ("step a  step for 2.001 s b  expect holding", True),
        ("step a  step 2x for 1 s not b  step b  expect holding", False),
        ("step a  step 3x for 1 s not b  expect pending", True),
        ("step a  step 9999x not b  expect pending", False),
        ("step a  step for 0 s not b  expect pending", False),
        # The time of the first step counts for nothing.
        ("step for 100 s a  step for 2 s b  expect holding", False),
    ],
)
def test_a_step_for_a_time_is_one_sample_where_the_clock_varies(block: str, fails: bool) -> None:
    found = failure("clock varies", block)
    assert (found is not None) == fails
    assert found is None or found.code == "TLT0640"


def test_a_long_step_is_not_skipped_before_its_deadline() -> None:
    # 99,999 steps of 1 ms reach the deadline, although each of them looks like the one before.
    assert failure("clock varies", "step a  step 1900x for 1 ms not b  expect pending") is None
    assert failure("clock varies", "step a  step 99999x for 1 ms not b  expect violated") is None


def test_a_step_for_a_time_is_as_many_samples_as_a_fixed_clock_has() -> None:
    # The last sample at which b is in time is the 16th after a.
    for fifteen in ("step 15x", "step for 1.875 s", "step for 1.8 s", "step 3x for 0.6 s", "step for 15 steps"):
        assert failure("clock 8 Hz", f"step a  {fifteen} not b  expect pending  step not b  expect violated") is None
    assert failure("clock 8 Hz", "step a  step for 2 s not b  expect violated") is None


@pytest.mark.parametrize(
    ("clock", "block", "code"),
    [
        ("clock varies", "step for 2 steps a", "TLT0323"),
        ("clock varies", "step for 2 m a", "TLT0312"),
        ("clock varies", "step for 2e9 s a", "TLT0312"),
        ("clock 8 Hz", "step for 2 m a", "TLT0312"),
        ("clock 8 Hz", "step for 0 s a", "TLT0217"),
        ("clock 8 Hz", "step 0x for 2 s a", "TLT0109"),
        ("clock 8 Hz", "step 99999x for 2 s a", "TLT0217"),
        ("clock 8 Hz", "step for 1e9 s a", "TLT0312"),
    ],
)
def test_a_wrong_time_of_a_step_is_an_error(clock: str, block: str, code: str) -> None:
    assert error(clock, block) == code


def test_a_time_of_a_step_needs_a_clock() -> None:
    with pytest.raises(TltlError) as raised:
        compile_text('signal a: bool spec s { keep a } test "t" for s { step for 2 s a }')
    assert [diagnostic.code for diagnostic in raised.value.diagnostics] == ["TLT0313"]


@pytest.mark.parametrize("style", STYLES)
def test_formatting_keeps_the_clock_and_the_times_of_steps(style: str) -> None:
    text = text_of(
        "clock   varies",
        "\nstep   for 2 s a step 3x   for 0.5   s a,b   step for   250 ms a step for 1e-3 s b expect pending",
    )
    formatted = format_text(text, style)
    assert formatted.startswith("clock varies\n")
    for line in ("step for 2 s a", "step 3x for 0.5 s a, b", "step for 250 ms a", "step for 1e-3 s b"):
        assert f"    {line}\n" in formatted
    assert format_text(formatted, style) == formatted
    assert compile_text(formatted) == compile_text(text)


@pytest.mark.parametrize(
    ("clocks", "agree"),
    [
        ("clock varies clock varies", True),
        ("clock varies clock 8 Hz", False),
        ("clock 8 Hz clock varies", False),
        ("clock 8 Hz clock 0.125 s", True),
        ("clock 8 Hz clock 9 Hz", False),
    ],
)
def test_a_program_has_one_clock(clocks: str, agree: bool) -> None:
    text = f"{clocks} {SPEC}"
    if agree:
        (fspa,) = compile_text(text)
        assert fspa.clock_varies == ("varies" in clocks)
        return
    with pytest.raises(TltlError) as raised:
        compile_text(text)
    assert [diagnostic.code for diagnostic in raised.value.diagnostics] == ["TLT0314"]


def test_varies_may_be_a_name() -> None:
    (fspa,) = compile_text("clock varies signal varies: bool spec s { keep once within 1 s varies }")
    assert [signal.name for signal in fspa.signals] == ["varies"]
