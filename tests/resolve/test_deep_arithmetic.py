"""Arithmetic that is too deep or too wide is an error, in every part of a ``when``."""

from __future__ import annotations

import pytest

import tltlc
from tltlc.io.limits import ARITHMETIC

SIGNAL = "signal x in [0, 1]\n"


def code(text: str) -> str:
    with pytest.raises(tltlc.TltlError) as caught:
        tltlc.compile_text(SIGNAL + text)
    return next(diagnostic.code for diagnostic in caught.value.diagnostics if diagnostic.severity == "error")


def test_depth_inside_conditions_counts() -> None:
    # Each spec resolves a predicate before the next one uses it, so that resolution does not follow the chain.
    chain = "".join(
        f"spec s{place} = F p{place} > 0\npredicate p{place + 1} in [-1, 1] = when p{place} < 0.5: 1 otherwise: -1\n"
        for place in range(ARITHMETIC.depth)
    )
    assert code(f"predicate p0 in [-1, 1] = x\n{chain}spec last = F p{ARITHMETIC.depth} > 0\n") == "TLT0317"


def test_the_number_of_cases_is_limited() -> None:
    cases = "".join(f"    when x < {place} / 1000: 1\n" for place in range(ARITHMETIC.parts + 1))
    assert code(f"predicate p in [-1, 1] =\n{cases}    otherwise: -1\nspec s = F p\n") == "TLT0317"


def test_the_number_of_arguments_is_limited() -> None:
    assert (
        code(f"predicate p in [0, 1] = min({', '.join(['x'] * (ARITHMETIC.parts + 1))})\nspec s = F p\n") == "TLT0317"
    )
