"""Numbers close to the limits of floating point are errors, and do not become infinities."""

from __future__ import annotations

import pytest

from tests.resolve.helpers import codes

BOOL = "signal a: bool "
Q = "predicate q in [-1, 1] = clamp((p - d) / 3 m, -1, 1) spec s = F q"


@pytest.mark.parametrize(
    ("text", "code"),
    [
        (BOOL + "clock 1e-320 s spec s = eventually within 2 s a", "TLT0314"),
        (BOOL + "clock 1e308 Hz spec s = eventually within 200 s a", "TLT0314"),
        (BOOL + "clock 1e-320 Hz spec s { keep a }", "TLT0314"),
        (BOOL + "clock 20 Hz spec s { limit 1e300 s keep a }", "TLT0312"),
        (BOOL + "spec s { limit 1e300 steps keep a }", "TLT0312"),
        (BOOL + "spec s = F[0,1e300] a", "TLT0312"),
        (BOOL + "spec s = always next after 1e8 steps a", "TLT0315"),
        ("signal d: length in [0 m, 1e308 km] spec s = F d > 1 m", "TLT0109"),
        ("signal d: length in [0 m, 9 m] param p: length = 1e308 km " + Q, "TLT0109"),
    ],
)
def test_an_extreme_number_is_one_error(text: str, code: str) -> None:
    assert codes(text) == [code]


@pytest.mark.parametrize("value", ["1e999", "1e999 m", "1e308 km"])
def test_an_extreme_override_of_a_param_is_an_error(value: str) -> None:
    text = "signal d: length in [0 m, 9 m] param p: length = 3 m " + Q
    assert codes(text, params={"p": value}) == ["TLT0308"]


def test_the_largest_allowed_numbers_are_accepted() -> None:
    assert codes(BOOL + "spec s { limit 1000000000 steps keep a }") == []
    assert codes("signal d in [-1e308, 1e308] spec s = F d > 0.5") == []
