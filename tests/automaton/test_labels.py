"""The work that the labels of states take."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tests.calls import calls
from tests.resolve.helpers import only_spec
from tltlc.automaton.finite.build import build
from tltlc.resolve.spec import Spec


def chain(length: int) -> Spec:
    declared = "".join(f"signal a{number}: bool\n" for number in range(length))
    return only_spec(f"{declared}spec s {{ reach {' then '.join(f'a{number}' for number in range(length))} }}")


def equal_parts(count: int) -> Spec:
    return only_spec(f"signal a: bool\nsignal b: bool\nspec s = {' <-> '.join(['(a U b)'] * count)}")


@pytest.mark.parametrize("spec", [chain, equal_parts])
def test_labels_of_twice_as_many_parts_take_less_than_four_times_the_work(spec: Callable[[int], Spec]) -> None:
    small, large = spec(100), spec(200)
    assert calls(lambda: build(large)) < 3.5 * calls(lambda: build(small))
