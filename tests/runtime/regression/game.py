"""A small game for the tests of regression: a suite with its own level and untrained policies."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.runtime.evaluation.untrained import SOON, untrained
from tests.runtime.regression.handmade import ROOM
from tltl_runtime.policies.file import write_policy
from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode
from tltl_runtime.regression.suite.suite import Case, Suite, baseline_path, read_suite
from tltl_runtime.regression.verdict.baseline import write_baseline
from tltl_runtime.regression.verdict.baseline_run import record_baseline
from tltl_runtime.stealth.levels.default_spec import LEVELS
from tltl_runtime.training.files.settings import read_settings
from tltlc.core.record import replace

EASY = """\
import stealth
spec easy { limit 20 steps  reach alive }
"""
"""A spec that is met at the first step."""

NEVER = SOON.replace("limit 20 steps", "limit 4 steps")
"""A spec that no player can meet: its limit is too short to reach the exit."""

SUITE = """\
seed = 3
episodes = 50
[[case]]
level = "room.toml"
policy = "easy.safetensors"
[[case]]
level = "room.toml"
variant = "v1"
policy = "easy.safetensors"
[[case]]
level = "room.toml"
policy = "soon.safetensors"
name = "hopeless"
"""
"""The text of a suite: two cases that pass, and one whose policy never meets its spec."""

GUARD = (LEVELS / "assets" / "guard.toml").read_text(encoding="utf-8")
"""The asset `guard` that comes with tltlc."""

VARIANTS = '[variants]\nv0 = []\nv1 = ["guard_alert"]\n'


def write_game(folder: Path, suite: str = SUITE) -> Path:
    """Write the files of the level, the policies and the suite into ``folder``.

    ``suite`` is the text of the suite's file. Return the path of this file.
    """
    folder.mkdir(exist_ok=True)
    (folder / "room.toml").write_text(ROOM + VARIANTS, encoding="utf-8")
    for name, spec in (("easy", EASY), ("soon", SOON)):
        write_policy(folder / f"{name}.safetensors", untrained(spec, str(folder / "room.toml")))
    path = folder / "game.toml"
    path.write_text(suite, encoding="utf-8")
    return path


def with_baseline(path: Path) -> Suite:
    """Record the baseline of the suite; return the suite."""
    suite = read_suite(path)
    write_baseline(baseline_path(path), tuple(case.reference for case in record_baseline(suite, 1, lambda *_: None)))
    return suite


class Played:
    """A callback that counts the episodes played for each case."""

    def __init__(self) -> None:
        self.counts: dict[str, int] = {}

    def __call__(self, case: Case, count: int, last: ExplainedEpisode) -> None:
        assert count == self.counts.get(case.name, 0) + 1
        assert last.summary.index == count - 1
        self.counts[case.name] = count


def with_few_environments(patch: pytest.MonkeyPatch) -> None:
    """Let retraining use 4 environments, so that an iteration is short."""
    settings = read_settings()
    few = replace(settings, rollout=replace(settings.rollout, envs=4))
    patch.setattr("tltl_runtime.regression.retrain.retrain.read_settings", lambda level: few)


def edit(name: str, old: str, new: str) -> None:
    """Replace the first occurrence of ``old`` in a file; fail if there is none."""
    text = Path(name).read_text(encoding="utf-8")
    assert old in text
    Path(name).write_text(text.replace(old, new, 1), encoding="utf-8")
