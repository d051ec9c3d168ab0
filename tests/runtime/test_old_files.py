"""Policies, baselines and recordings of an older version are read, and mean the same, today."""

from __future__ import annotations

import json
from math import prod
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tltl_runtime.game.episode_summary import summary_of
from tltl_runtime.game.recording_check import check
from tltl_runtime.policies.file import read_policy
from tltl_runtime.regression.verdict.baseline import read_baseline, write_baseline
from tltl_runtime.stealth.recordings.cause import cause
from tltl_runtime.stealth.recordings.figures import opened_barriers
from tltl_runtime.stealth.recordings.file import read_episode
from tltl_runtime.stealth.recordings.replay_check import resimulate

OLD = Path(__file__).parents[1] / "old_files"
EXPECTED: dict[str, Any] = json.loads((OLD / "expected.json").read_text(encoding="utf-8"))


def observation(shape: tuple[int, ...]) -> NDArray[Any]:
    """The observation of which the old version computed the logits."""
    if len(shape) == 3:
        return (np.arange(prod(shape)).reshape(shape) % 2).astype(np.uint8)
    return np.linspace(-1, 1, prod(shape), dtype=np.float32).reshape(shape)


def test_an_old_policy_computes_the_same_logits() -> None:
    policy = read_policy(OLD / "navigation.safetensors")
    logits = policy.logits({key: observation(shape) for key, shape in policy.card.shapes})
    assert logits.tolist() == pytest.approx(EXPECTED["policy_logits"], abs=1e-3)


def test_an_old_baseline_is_read_whole(tmp_path: Path) -> None:
    references = read_baseline(OLD / "room.baseline.json")
    assert [[episode.summary.success for episode in reference.episodes] for reference in references] == [
        [False, True, True, True],
        [True],
    ]
    write_baseline(tmp_path / "again.json", references)
    again, old = (json.loads(path.read_bytes()) for path in (tmp_path / "again.json", OLD / "room.baseline.json"))
    assert read_baseline(tmp_path / "again.json") == references
    assert _without_new_keys(again, old) == old


def _without_new_keys(new: object, old: object) -> object:
    """Return a JSON value without the keys that the objects of an older one do not have."""
    if isinstance(new, dict) and isinstance(old, dict):
        return {key: _without_new_keys(value, old[key]) for key, value in new.items() if key in old}
    if isinstance(new, list) and isinstance(old, list):
        return [_without_new_keys(*pair) for pair in zip(new, old, strict=True)]
    return new


def test_an_old_recording_is_judged_and_played_alike() -> None:
    episode = read_episode(OLD / "navigation.episode.npz")
    summary, expected = summary_of(episode), dict(EXPECTED["episode"])
    assert cause(episode).kind == expected.pop("cause")
    assert opened_barriers(episode) == tuple(expected.pop("opened"))
    assert {name: getattr(summary, name) for name in expected} == expected
    assert check(episode) == ()
    assert resimulate(episode) is None
