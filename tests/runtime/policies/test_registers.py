"""Policies for a spec with registers."""

from __future__ import annotations

import pytest

from tests.runtime.policies.examples import card_of
from tltl_runtime.policies.card import Card
from tltl_runtime.policies.compatibility import check_policy
from tltl_runtime.spec.task import load_task
from tltl_runtime.stealth.levels.file import load_level
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError

SPEC = """
import stealth
entity exit
spec sneak { limit 400 steps reach near(exit) keep alive keep times(visible) <= 2 }
"""


@pytest.fixture(name="card", scope="module")
def _card() -> Card:
    return card_of(spec=SPEC)


def test_a_spec_whose_registers_differ_is_refused(card: Card) -> None:
    level = load_level("cover_and_hide")
    check_policy(card, level, load_task(SPEC.replace("sneak", "another")).fspa)
    last, times = card.fspa.registers
    for registers in ((last, replace(times, high=9.0)), (last, replace(times, initial=1.0))):
        with pytest.raises(TltlError, match=r"TLT0843: .*the register `times\(visible\)` means something else"):
            check_policy(card, level, replace(card.fspa, registers=registers))
    with pytest.raises(TltlError, match=r"TLT0843: .*its registers are in another order"):
        check_policy(card, level, replace(card.fspa, registers=(times, last)))
