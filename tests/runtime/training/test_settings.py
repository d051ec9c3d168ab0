"""Settings of trainings: the defaults, and files that override some of them."""

from __future__ import annotations

import os
from pathlib import Path
from typing import get_type_hints

import pytest

from tltl_runtime.policies.network import Network
from tltl_runtime.training.files.settings import (
    TrainingSettings,
    default_text,
    read_settings,
    rsl_config,
    settings_text,
)
from tltl_runtime.training.files.settings_file import KINDS, read_values
from tltlc.core.record import replace
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.diagnostics.render import render
from tltlc.monitor import RewardOptions

GOLDEN = Path(__file__).parents[2] / "golden" / "training"

WRONG = {
    "TLT0860": "[ppo]\ngamma = \n",
    "TLT0861": "[ppo]\nlearning_rat = 1e-4\n[roll]\n",
    "TLT0861_elsewhere": 'gamma = 0.9\n[ppo]\ndevice = "cpu"\nsteps = 9\n',
    "TLT0862": '[ppo]\ngamma = 1.5\nepochs = true\nlearning_rate = 0\n[network]\nhidden = []\nactivation = "rely"\n',
    "TLT0862_table": 'ppo = 3\ndevice = "gpu"\n[classes]\nrunner = "my runner"\n[stop]\nminutes = nan\n',
    "TLT0862_minibatches": "[rollout]\nenvs = 1\nsteps = 2\n",
}

OTHER = """\
method = "imitation"
device = "cuda:1"
threads = 2
checkpoint_s = 0.5
[ppo]
learning_rate = 1e-5
entropy = 0.0
entropy_schedule = "fixed"
sharpening = 3.0
clip = 0.3
lam = 0.9
gamma = 0.5
epochs = 1
minibatches = 2
value_loss = 0.5
max_gradient = 10.0
warm_up = 3
[rollout]
envs = 4
steps = 16
workers = 2
pool = "ray"
[network]
hidden = [64]
activation = "relu"
channels = [8, 8, 8]
kernel = 5
stride = 1
[exploration]
ways = 0
steps = 1000
parts = 1
imitation = 0
[imitation]
demonstrations = 5
cloning = 0.5
encoding = 32
discriminator_rate = 1e-5
gradient_penalty = 0.0
strength = 1.0
terminal = 0.5
[reward]
mode = "potential"
termination = "paper"
terminal_penalty = "undiscounted"
penalty_schedule = "fixed"
[stop]
windows = 1
episodes = 2
confirmation = 3
steps = 100
minutes = 0.25
[classes]
runner = "mine.\U0001d4de:Runner"
algorithm = "mine.algorithm:PPO"
"""
"""Another value for each setting."""


def _read(tmp_path: Path, text: str) -> TrainingSettings:
    file = tmp_path / "settings.toml"
    file.write_text(text, encoding="utf-8")
    return read_settings(file)


def test_the_defaults_are_from_the_paper() -> None:
    settings = read_settings()
    ppo = settings.ppo
    assert (ppo.learning_rate, ppo.entropy, ppo.clip, ppo.lam, ppo.gamma) == (3e-4, 0.01, 0.2, 0.95, 0.99)
    assert settings.network.hidden == (512, 512)
    assert settings.reward.options == RewardOptions(terminal_penalty="discounted", gamma=0.99)
    assert settings.reward.penalty_rises
    assert (settings.stop.windows, settings.stop.episodes, settings.stop.confirmation) == (2, 50, 300)


def test_the_default_file_has_exactly_all_settings() -> None:
    values = read_values(SourceFile("settings.toml", default_text()))
    assert {table: set(keys) for table, keys in values.items()} == {table: set(keys) for table, keys in KINDS.items()}
    for name, kind in get_type_hints(TrainingSettings).items():
        # Rewards use the discount of the algorithm.
        fields = set(getattr(kind, "__match_args__", ())) - ({"gamma"} if name == "reward" else set())
        assert fields == set(KINDS.get(name, {})), name
    assert {name for name in get_type_hints(TrainingSettings) if name not in KINDS} == set(KINDS[""])


def test_the_comments_on_settings_hold_for_other_values_too(tmp_path: Path) -> None:
    printed = settings_text(_read(tmp_path, '[ppo]\nentropy_schedule = "fixed"\n'))
    assert "with their defaults" not in printed
    comment = '# "fading": the weight falls as the pass rate rises, to 0 at 1; or "fixed"'
    assert f'entropy_schedule = "fixed"          {comment}' in printed.splitlines()


def test_the_default_network_is_the_network_of_policies() -> None:
    assert read_settings().network == Network()


def test_a_file_overrides_settings(tmp_path: Path) -> None:
    settings = _read(tmp_path, 'threads = 2\n[ppo]\ngamma = 0.9\n[network]\nhidden = [64]\n[reward]\nmode = "sparse"\n')
    default = read_settings()
    assert settings == replace(
        default,
        threads=2,
        ppo=replace(default.ppo, gamma=0.9),
        network=replace(default.network, hidden=(64,)),
        reward=replace(default.reward, mode="sparse", gamma=0.9),
    )
    assert isinstance(_read(tmp_path, "checkpoint_s = 5\n").checkpoint_s, float)


def test_scenes_of_game_files_have_other_defaults(tmp_path: Path) -> None:
    level, scene = read_settings(level="navigation"), read_settings(level="lake.game.toml:small")
    assert level == read_settings()
    assert scene == replace(
        level,
        ppo=replace(level.ppo, epochs=10, minibatches=32),
        rollout=replace(level.rollout, envs=16),
        network=replace(level.network, hidden=(128, 128)),
    )
    file = tmp_path / "settings.toml"
    file.write_text("[ppo]\nepochs = 5\n")
    assert read_settings(file, "lake.game.toml:small") == replace(scene, ppo=replace(scene.ppo, epochs=5))
    file.write_text(settings_text(scene))
    assert read_settings(file) == read_settings(file, "lake.game.toml:small") == scene


def test_printing_and_reading_the_defaults_changes_nothing(tmp_path: Path) -> None:
    assert _read(tmp_path, default_text()) == _read(tmp_path, "") == read_settings()


def test_printed_settings_are_read_unchanged(tmp_path: Path) -> None:
    values, defaults = (read_values(SourceFile("settings.toml", text)) for text in (OTHER, default_text()))
    assert [(table, key) for table in KINDS for key in KINDS[table] if values[table][key] == defaults[table][key]] == []
    settings = _read(tmp_path, OTHER)
    printed = settings_text(settings)
    assert _read(tmp_path, printed) == settings
    assert 'runner = "mine.\U0001d4de:Runner"' in printed.splitlines()
    assert "threads = 2             # threads of torch while it learns; " in printed


def test_the_config_of_rsl_rl_has_all_settings(tmp_path: Path) -> None:
    config = rsl_config(_read(tmp_path, "[ppo]\nclip = 0.3\n"), {"automaton": (6,), "map": (3, 11, 11)}, (3, 2))
    assert config["actor"]["class_name"] == config["critic"]["class_name"] == "CNNModel"
    assert config["actor"]["distribution_cfg"]["branches"] == (3, 2)
    assert config["algorithm"]["clip_param"] == 0.3
    assert rsl_config(read_settings(), {"automaton": (6,)}, (3, 2))["actor"]["class_name"] == "MLPModel"


@pytest.mark.parametrize(
    ("minutes", "steps", "seconds", "limit"),
    [
        (0.0, 99, 10.0**6, None),
        (0.0, 100, 0.0, "steps"),
        (2.0, 99, 119.0, None),
        (2.0, 99, 120.0, "minutes"),
        (2.0, 100, 120.0, "steps"),
    ],
)
def test_the_limit_that_a_training_has_reached_is_returned(
    minutes: float, steps: int, seconds: float, limit: str | None
) -> None:
    stop = replace(read_settings().stop, steps=100, minutes=minutes)
    assert stop.reached_limit(steps, seconds) == limit
    assert stop.is_out_of_time(seconds) == (minutes > 0 and seconds == 120.0)


@pytest.mark.parametrize("name", WRONG)
def test_the_message_is_as_expected(tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("settings.toml").write_text(WRONG[name], encoding="utf-8")
    with pytest.raises(TltlError) as caught:
        read_settings(Path("settings.toml"))
    compare(name, caught.value)


def compare(name: str, error: TltlError) -> None:
    compare_text(name, render(error.diagnostics))


def compare_text(name: str, message: str) -> None:
    expected = GOLDEN / f"{name}.txt"
    if os.environ.get("UPDATE_GOLDEN") == "1":
        expected.write_text(message, encoding="utf-8")
    assert message == expected.read_text(encoding="utf-8")
    assert name[:7] in message
