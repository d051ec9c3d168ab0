"""Arithmetic that is too deep or too wide is refused, whichever part of a ``when`` it stands in."""

from __future__ import annotations

import pytest

import tltlc
from tltlc.io.limits import ARITHMETIC

SIGNAL = "signal x in [0, 1]\n"


def code(text: str) -> str:
    with pytest.raises(tltlc.TltlError) as caught:
        tltlc.compile_text(SIGNAL + text)
    return next(each.code for each in caught.value.diagnostics if each.severity == "error")


def test_what_a_condition_compares_counts() -> None:
    # Each spec makes the next predicate known, so that no chain of predicates is followed.
    chain = "".join(
        f"spec s{place} = F p{place} > 0\npredicate p{place + 1} in [-1, 1] = when p{place} < 0.5: 1 otherwise: -1\n"
        for place in range(ARITHMETIC.depth)
    )
    assert code(f"predicate p0 in [-1, 1] = x\n{chain}spec last = F p{ARITHMETIC.depth} > 0\n") == "TLT0317"


def test_cases_are_limited() -> None:
    cases = "".join(f"    when x < {place} / 1000: 1\n" for place in range(ARITHMETIC.parts + 1))
    assert code(f"predicate p in [-1, 1] =\n{cases}    otherwise: -1\nspec s = F p\n") == "TLT0317"


def test_arguments_are_limited() -> None:
    assert (
        code(f"predicate p in [0, 1] = min({', '.join(['x'] * (ARITHMETIC.parts + 1))})\nspec s = F p\n") == "TLT0317"
    )
