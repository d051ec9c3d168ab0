"""A policy plays levels and specs that fit its training; others are rejected with the reason."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.runtime.policies.examples import card_of
from tltl_runtime.game.level import LevelSpec
from tltl_runtime.policies.card import OBSERVATION, Card
from tltl_runtime.policies.compatibility import check_policy
from tltl_runtime.policies.identity import spec_hash
from tltl_runtime.spec.task import load_task
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.levels.identity import level_hash
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.diagnostics.render import render

GOLDEN = Path(__file__).parents[2] / "golden" / "policy"
SPEC = """
import stealth
entity s1, s2, exit
exclusive near(s1), near(s2), near(exit)
spec cover_and_hide {
    limit 400 steps
    reach near(s1) then near(s2) then near(exit)
    keep alive
}
"""


@pytest.fixture(name="card", scope="module")
def _card() -> Card:
    return card_of("cover_and_hide")


def spec(old: str = "", new: str = "") -> Fspa:
    assert old in SPEC
    return load_task(SPEC.replace(old, new, 1) if old else SPEC).fspa


def message_of_refusal(card: Card, level: str = "cover_and_hide", fspa: Fspa | None = None) -> str:
    with pytest.raises(TltlError) as caught:
        check_policy(card, load_level(level), fspa)
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == "TLT0843"
    return render([diagnostic])


@pytest.mark.parametrize("variant", ["v0", "v1", "v2"])
def test_any_variant_of_the_level_fits(card: Card, variant: str) -> None:
    check_policy(card, load_level("cover_and_hide", variant), card.fspa)


def test_another_level_with_the_same_sensors_fits(card: Card) -> None:
    fitting_card = replace(card, sensors=replace(card.sensors, entities=("exit",), variables=("health",)))
    check_policy(fitting_card, load_level("navigation"), card.fspa)


def test_the_name_and_the_documentation_of_a_spec_do_not_count(card: Card) -> None:
    same = spec("spec cover_and_hide", "/// Something else.\nspec quite_another")
    assert spec_hash(same) == spec_hash(card.fspa)
    check_policy(card, load_level("cover_and_hide"), same)


CHANGES = {
    "limit": (("limit 400", "limit 401"), "its limit is 401 steps, and was 400 steps"),
    "judge": (
        ("keep alive", "keep alive\n    judge at limit"),
        "it is judged at the limit, and was judged at the goal",
    ),
    "atom": (("keep alive", "keep not visible"), "the atom `visible` is new"),
    "order": (("near(s1) then near(s2)", "near(s2) then near(s1)"), "its atoms are in another order"),
    "shorter": (("near(s1) then", ""), "its automaton has 4 states, and had 5"),
    "exclusive": (("near(s2), near(exit)\n", "near(s2)\n"), "the state"),
}


@pytest.mark.parametrize("name", CHANGES)
def test_another_spec_is_rejected_with_the_difference(card: Card, name: str) -> None:
    change, text = CHANGES[name]
    other_spec = spec(*change)
    assert spec_hash(other_spec) != spec_hash(card.fspa)
    assert text in message_of_refusal(card, fspa=other_spec)


def test_a_spec_with_other_params_has_another_hash() -> None:
    text = "import stealth\nentity s1\nparam far: ratio = {}%\nspec it {{ limit 9 steps\n reach health < far }}"
    first, second = (load_task(text.format(value)).fspa for value in (20, 30))
    card = replace(card_of("cover_and_hide"), fspa=first)
    assert "the param `far` is 0.3, and was 0.2" in message_of_refusal(card, fspa=second)


def test_a_level_hash_depends_only_on_the_content_of_the_level() -> None:
    hashes = {level_hash(load_level(name, variant)) for name in ("navigation", "branching") for variant in ("v0", "v1")}
    assert len(hashes) == 4
    level = load_level("navigation")
    same = replace(level, name="x", variant="y", doc="z", spec=LevelSpec(Path("/somewhere/else.tltl"), "x"), files=())
    assert level_hash(same) == level_hash(level)
    assert level_hash(replace(level, start=replace(level.start, yaw=0.25))) != level_hash(level)


def test_the_hash_of_a_spec_is_stable() -> None:
    assert spec_hash(spec()) == "9b68b2523d10bae1c3ab5338a1df4e1aed753b69b00d454206ddac5c903e4cd6"


# --- messages ---------------------------------------------------------------------------------------

MESSAGES: dict[str, Callable[[Card], Any]] = {
    "TLT0843": lambda card: message_of_refusal(card, "navigation"),
    "TLT0843_spec": lambda card: message_of_refusal(card, fspa=spec(*CHANGES["limit"][0])),
    "TLT0843_other_spec": lambda card: message_of_refusal(card, fspa=card_of("branching").fspa),
    "TLT0843_senses": lambda card: message_of_refusal(replace(card, observation=OBSERVATION + 1)),
    "TLT0843_actions": lambda card: message_of_refusal(replace(card, branches=(3, 3))),
}


@pytest.mark.parametrize("name", MESSAGES)
def test_an_unfit_policy_gives_the_expected_message(card: Card, name: str) -> None:
    message, expected = MESSAGES[name](card), GOLDEN / f"{name}.txt"
    if os.environ.get("UPDATE_GOLDEN") == "1":
        expected.write_text(message, encoding="utf-8")
    assert message == expected.read_text(encoding="utf-8")
