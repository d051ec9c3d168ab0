"""The shipped policies play the levels that they are named after, with the specs of the levels."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tltl_runtime.game.level import default_spec
from tltl_runtime.policies.compatibility import check_policy
from tltl_runtime.policies.file import read_policy, to_bytes
from tltl_runtime.policies.shipped import shipped_policies, shipped_policy
from tltl_runtime.spec.task import load_task
from tltl_runtime.stealth.levels.file import level_names, load_level, variants
from tltl_runtime.stealth.levels.identity import level_hash

RECORD = Path(__file__).parents[3] / "docs" / "training.md"


def test_shipped_policies_are_found_by_the_names_of_levels() -> None:
    assert {"navigation", "cover_and_hide", "branching"} <= set(shipped_policies()) <= set(level_names())
    assert all(shipped_policy(name) == path for name, path in shipped_policies().items())
    assert shipped_policy("../shipped/navigation") is None
    assert shipped_policy("my_level.toml") is None


@pytest.mark.parametrize("name", sorted(shipped_policies()))
def test_a_shipped_policy_fits_its_current_level(name: str) -> None:
    path = shipped_policies()[name]
    policy = read_policy(path)
    level = load_level(name)
    assert policy.card.level == name
    assert policy.card.variant == "v0"
    assert policy.card.level_hash == level_hash(level)
    fspa = load_task(default_spec(level)).fspa
    for variant in variants(name):
        check_policy(policy.card, load_level(name, variant), fspa)
    assert to_bytes(policy) == Path(path).read_bytes()
    assert path.stat().st_size < 2_000_000
    assert policy.card.versions
    section = RECORD.read_text(encoding="utf-8").partition("## The record\n")[2].partition("\n## ")[0]
    documented = re.findall(r"^\| (`.*?`) \|", section, re.M)
    keys = {key for line in documented for key in re.findall(r"`(\w+)`", line)}
    assert set(policy.card.training) <= keys
    assert keys - set(policy.card.training) <= {"format", "version"}
