from __future__ import annotations

import pytest

from tltlc import compile_text
from tltlc.tools.judge.step_values import StepValue, enum_of, signal_value, truths

SPEC = """
entity guards = g1, g2
signal mode(g: entity): (idle, alert, chase)
signal noise in [0, 9]
signal seen: bool
spec s { reach mode(g1) is alert and noise > 3 and seen and once (mode(g2) is chase) }
"""


def test_the_values_of_enums_have_names_and_numbers_have_three_digits() -> None:
    (fspa,) = compile_text(SPEC)
    mode, noise = (next(signal for signal in fspa.signals if signal.base == base) for base in ("mode", "noise"))
    assert signal_value(noise, 2.3456) == "2.35"
    values = {0.0: "idle", 0.9999: "alert", 2.4: "chase", 9.0: "chase", -1.0: "idle", 0.5: "0.5"}
    assert {value: signal_value(mode, value) for value in values} == values


def test_atoms_of_bools_of_enums_and_of_their_memory_are_true_or_false() -> None:
    (fspa,) = compile_text(SPEC)
    names = [fspa.atoms[index].name for index in sorted(truths(fspa))]
    assert names == ["mode(g1) is alert", "seen", "once (mode(g2) is chase)", "mode(g2) is chase"]
    enums = [enum_of(fspa, index) for index in range(len(fspa.atoms))]
    assert [enum and enum.name for enum in enums] == ["mode(g1)", None, None, None, "mode(g2)"]


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (StepValue("mode", "alert"), "mode is alert"),
        (StepValue("mode was alert at the step before"), "mode was alert at the step before"),
        (StepValue("danger", "0.5", (StepValue("mode", "alert"),)), "danger is 0.5 (mode is alert)"),
    ],
)
def test_values_in_words(value: StepValue, text: str) -> None:
    assert value.text == text
