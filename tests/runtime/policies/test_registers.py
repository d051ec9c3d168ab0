"""Policies of the stealth game for a spec with registers: their networks, files, models and refusals."""

from __future__ import annotations

import json

import pytest

from tests.runtime.policies.examples import card_of, policy_of
from tltl_runtime.policies.card import Card
from tltl_runtime.policies.compatibility import check_policy
from tltl_runtime.policies.file import from_bytes, to_bytes
from tltl_runtime.policies.onnx import metadata, to_onnx
from tltl_runtime.spec.task import load_task
from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.levels.file import load_level
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError

SPEC = """
import stealth
entity exit
spec sneak { limit 400 steps reach near(exit) keep alive keep times(visible) <= 2 }
"""
REGISTERS = ["last visible", "times(visible)"]


@pytest.fixture(name="card", scope="module")
def _card() -> Card:
    return card_of(spec=SPEC)


def test_the_network_takes_the_registers_beside_the_states(card: Card) -> None:
    assert [register.name for register in card.fspa.registers] == REGISTERS
    assert dict(card.shapes)["automaton"] == (len(card.fspa.states) + 2,)
    policy = from_bytes(to_bytes(policy_of(card)), "it")
    assert policy.card == card
    env = make_env(card.level, card.variant, card.fspa, sensors=card.sensors)
    observation, _ = env.reset(seed=7)
    action = policy.choose(observation)
    env.step(action)
    # All else equal, the number of sightings changes what the network computes.
    seen = {**observation, "automaton": observation["automaton"].copy()}
    seen["automaton"][-1] = 1.0
    assert policy.logits(seen).tolist() != policy.logits(observation).tolist()
    env.close()


def test_the_model_takes_the_registers_as_the_policy_does(card: Card) -> None:
    pytest.importorskip("onnxruntime")
    from tests.runtime.policies.test_onnx import check_alike

    policy = policy_of(card)
    check_alike(policy, to_onnx(policy), 2)


def test_the_metadata_of_the_model_name_the_registers(card: Card) -> None:
    inputs = json.loads(metadata(policy_of(card))["inputs"])
    assert inputs["automaton"] == [*(f"state {state.id}" for state in card.fspa.states), *REGISTERS]


def test_a_policy_that_does_not_observe_the_registers_of_its_spec_is_refused(card: Card) -> None:
    states = (len(card.fspa.states),)
    blind = replace(card, shapes=tuple((key, states if key == "automaton" else shape) for key, shape in card.shapes))
    with pytest.raises(TltlError, match=r"TLT0842: .*`card\.shapes` are not those of its spec"):
        from_bytes(to_bytes(policy_of(blind)), "it")


def test_a_spec_whose_registers_differ_is_refused(card: Card) -> None:
    level = load_level("cover_and_hide")
    check_policy(card, level, load_task(SPEC.replace("sneak", "another")).fspa)
    last, times = card.fspa.registers
    for registers in ((last, replace(times, high=9.0)), (last, replace(times, initial=1.0))):
        with pytest.raises(TltlError, match=r"TLT0843: .*the register `times\(visible\)` means something else"):
            check_policy(card, level, replace(card.fspa, registers=registers))
    with pytest.raises(TltlError, match=r"TLT0843: .*its registers are in another order"):
        check_policy(card, level, replace(card.fspa, registers=(times, last)))
