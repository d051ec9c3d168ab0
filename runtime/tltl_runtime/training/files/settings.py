"""The settings of a training.

The defaults are in ``settings.toml`` beside this module; ``game_settings.toml`` has those that differ
for the scenes of game files.
"""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from math import inf
from pathlib import Path
from typing import Any, Final, Literal

from tltl_runtime.game.level_name import is_scene
from tltl_runtime.policies.network import Network, Shapes, model_config
from tltl_runtime.policies.spaces.layouts import SpaceLayouts
from tltl_runtime.policies.spaces.model_config import space_model_config
from tltl_runtime.training.exploration.search import SearchSettings
from tltl_runtime.training.files.choices import EntropySchedule, Method, PenaltySchedule, Pool
from tltl_runtime.training.files.settings_file import read_values
from tltlc.api import Diagnostic, RewardOptions, TltlError, fileio, monitors, record, replace

DEFAULTS: Final = Path(__file__).with_name("settings.toml")
_GAME_DEFAULTS: Final = Path(__file__).with_name("game_settings.toml")

_PPO: Final = "PPO"
_GAIL: Final = "tltl_runtime.training.imitation.gail:Gail"
_HEADING: Final = re.compile(r"\[(\w+)\]")
_SETTING: Final = re.compile(r"(?P<head>(?P<key>\w+) = [^#]*?)\s*(?P<comment>#.*)?$")


@record
class Ppo:
    """The settings of rsl-rl's PPO.

    The default learning rate, entropy, clip, lambda and gamma are those of Gutiérrez-Sánchez et
    al., IEEE Trans. Games 2024, section VI. The actor's logits are multiplied by a factor. As the
    pass rate rises from one half to 1, this factor rises from 1 to ``sharpening``. A training that
    begins with an earlier policy still has a new critic. So in its first ``warm_up`` updates only
    the critic learns: otherwise the policy would follow the critic's initial errors.
    """

    learning_rate: float
    entropy: float
    entropy_schedule: EntropySchedule
    sharpening: float
    clip: float
    lam: float
    gamma: float
    epochs: int
    minibatches: int
    value_loss: float
    max_gradient: float
    warm_up: int


@record
class Rollout:
    """The settings of rollouts.

    Each of ``envs`` environments takes ``steps`` decisions between updates. ``workers`` processes
    step them (0: one per core), on this machine or on a Ray cluster.
    """

    envs: int
    steps: int
    workers: int
    pool: Pool


@record
class Imitation:
    """The settings of the imitation baseline: behavioural cloning, then GAIL.

    Behavioural cloning ends when the training has used up the share ``cloning`` of its limit of
    steps, or of its limit of minutes. If no demonstrations are given, ``demonstrations`` episodes
    of the expert are recorded. The discriminator has two layers of width ``encoding``, the learning
    rate ``discriminator_rate`` and the weight ``gradient_penalty`` of its gradient penalty. Its
    reward is multiplied by ``strength``. The terminal reward of an episode is plus or minus
    ``terminal``. See :mod:`tltl_runtime.training.imitation.gail`.
    """

    demonstrations: int
    cloning: float
    encoding: int
    discriminator_rate: float
    gradient_penalty: float
    strength: float
    terminal: float


@record
class RewardSettings:
    """The settings of rewards: those of the environments, and a schedule of the terminal penalty.

    The ``penalty_schedule`` ``rising`` matters only if ``mode`` is ``progress`` and
    ``terminal_penalty`` is ``discounted``. Then the penalty begins as the discounted one, and rises
    to the undiscounted one as the pass rate rises from one half to 1. ``gamma`` is the discount
    factor.
    """

    mode: monitors.Mode
    termination: monitors.Termination
    terminal_penalty: monitors.TerminalPenalty
    penalty_schedule: PenaltySchedule
    gamma: float

    @property
    def options(self) -> RewardOptions:
        """The reward options of the environments."""
        return RewardOptions(self.mode, self.termination, self.terminal_penalty, self.gamma)

    @property
    def penalty_rises(self) -> bool:
        """Whether the terminal penalty of failed episodes rises during the training."""
        return self.penalty_schedule == "rising" and (self.mode, self.terminal_penalty) == ("progress", "discounted")


@record
class Stop:
    """The settings that say when a training ends.

    A training ends when its last ``windows * episodes`` episodes have all met the spec, and the
    policy then meets it in ``confirmation`` fresh episodes. It also ends after ``steps`` decisions
    of all environments, or after ``minutes`` of training (0: no such limit).
    """

    windows: int
    episodes: int
    confirmation: int
    steps: int
    minutes: float

    def is_out_of_time(self, seconds: float) -> bool:
        """Whether a training that has taken ``seconds`` has reached the limit of minutes."""
        return 0 < self.minutes * 60 <= seconds

    def reached_limit(self, steps: int, seconds: float) -> Literal["steps", "minutes"] | None:
        """Return the limit that a training has reached after ``steps`` and ``seconds``; None if none."""
        if steps >= self.steps:
            return "steps"
        return "minutes" if self.is_out_of_time(seconds) else None


@record
class Classes:
    """The names of the classes of the runner and of the algorithm that train.

    Names are in the form that :func:`rsl_rl.utils.resolve_callable` reads, such as ``PPO`` or
    ``package.module:Class``.
    """

    runner: str
    algorithm: str


@record
class TrainingSettings:
    """All settings of a training except its seed.

    The settings ``imitation`` apply only with the ``method`` ``imitation``, and ``exploration`` and
    ``reward`` only with ``automaton``. A checkpoint is written after the first iteration that ends
    ``checkpoint_s`` seconds or more after the last checkpoint. ``threads`` is the number of torch's
    threads during updates, ``device`` the device of the network.
    """

    ppo: Ppo
    rollout: Rollout
    network: Network
    exploration: SearchSettings
    imitation: Imitation
    reward: RewardSettings
    stop: Stop
    classes: Classes
    method: Method
    checkpoint_s: float
    threads: int
    device: str

    @property
    def imitates(self) -> bool:
        """Whether the agent learns from demonstrations."""
        return self.method == "imitation"

    @property
    def rewards(self) -> RewardOptions:
        """The reward options of the environments; with imitation, the default ones."""
        return RewardOptions() if self.imitates else self.reward.options

    @property
    def searches(self) -> bool:
        """Whether the training first searches for demonstrations.

        Episodes of the training may then begin in these demonstrations.
        """
        return self.exploration.ways > 0 and not self.imitates


def read_settings(path: Path | None = None, level: str = "") -> TrainingSettings:
    """Return the default settings; if ``path`` is given, settings in this TOML file replace them.

    ``level`` is what the agent plays: a scene of a game file has some other defaults than a level.

    Raises:
        TltlError: the file cannot be read (TLT0001 to TLT0004), is not TOML (TLT0860), has an
            unknown key (TLT0861) or an invalid value (TLT0862).
    """
    values = read_values(fileio.read_source(DEFAULTS))
    for file in (_GAME_DEFAULTS if is_scene(level) else None, path):
        overrides = {} if file is None else read_values(fileio.read_source(file))
        values = {name: {**defaults, **overrides.get(name, {})} for name, defaults in values.items()}
    ppo, rollout = Ppo(**values["ppo"]), Rollout(**values["rollout"])
    if ppo.minibatches > rollout.envs * rollout.steps:
        decisions = rollout.envs * rollout.steps
        title = f"a rollout has {decisions} decisions, too few for {ppo.minibatches} minibatches"
        raise TltlError([Diagnostic("TLT0862", title, help=f"set `minibatches` to at most {decisions}")])
    return TrainingSettings(
        ppo=ppo,
        rollout=rollout,
        network=Network(**values["network"]),
        exploration=SearchSettings(**values["exploration"]),
        imitation=Imitation(**values["imitation"]),
        reward=RewardSettings(**values["reward"], gamma=ppo.gamma),
        stop=Stop(**values["stop"]),
        classes=Classes(**values["classes"]),
        **values[""],
    )


def default_text() -> str:
    """Return the TOML text of the defaults, with comments: a template for settings files."""
    *names, last = monitors.MODES
    return DEFAULTS.read_text(encoding="utf-8").replace("{modes}", f"{', '.join(names)} or {last}")


def settings_text(settings: TrainingSettings) -> str:
    """Return settings as TOML: the default text with its comments, and the values of ``settings``."""
    table, lines = "", []
    defaults = read_settings()
    for line in default_text().splitlines():
        if heading := _HEADING.match(line):
            table = heading[1]
        if match := _SETTING.match(line):
            value, default = (getattr(getattr(source, table, source), match["key"]) for source in (settings, defaults))
            if value != default:
                line = f"{match['key']} = {_toml(value)}"
                if comment := match["comment"]:
                    line = f"{line:<{match.start('comment') - 1}} {comment}"
        lines.append(line)
    return "\n".join(lines) + "\n"


def _toml(value: object) -> str:
    """Return the value of a setting as TOML.

    The text is written as JSON: no setting has characters that TOML and JSON write differently.
    """
    # `ensure_ascii` off: JSON escapes characters beyond 16 bits as surrogate pairs, which TOML does not allow.
    return json.dumps(list(value) if isinstance(value, tuple) else value, ensure_ascii=False)


def algorithm_name(settings: TrainingSettings) -> str:
    """Return the name of the algorithm's class, from the setting ``classes.algorithm``.

    With imitation, the default ``PPO`` becomes
    :class:`~tltl_runtime.training.imitation.gail.Gail`.
    """
    name = settings.classes.algorithm
    return _GAIL if settings.imitates and name == _PPO else name


def rsl_config(
    settings: TrainingSettings, shapes: Shapes, branches: Sequence[int], layouts: SpaceLayouts | None = None
) -> dict[str, Any]:
    """Return rsl-rl's configuration of the runner, the networks and the algorithm.

    ``shapes`` are the shapes of the parts of an observation, by key. An action has several discrete
    branches; ``branches`` has the number of choices of each. If ``layouts`` is given, the networks
    are built for these layouts of observation and action, and ``branches`` is not used.
    """
    ppo, imitation = settings.ppo, settings.imitation
    groups = list(shapes)
    discriminator = replace(settings.network, hidden=(imitation.encoding,) * 2)
    gail = {
        "branches": tuple(branches),
        "discriminator": model_config(discriminator, shapes),
        "layouts": layouts,
        "network": discriminator,
        "discriminator_rate": imitation.discriminator_rate,
        "gradient_penalty": imitation.gradient_penalty,
        "strength": imitation.strength,
        "terminal": imitation.terminal,
        "cloning_steps": int(imitation.cloning * settings.stop.steps),
        "cloning_s": imitation.cloning * settings.stop.minutes * 60 if settings.stop.minutes else inf,
    }
    return {
        "imitation": settings.exploration.imitation,
        "num_steps_per_env": settings.rollout.steps,
        "threads": settings.threads,
        "obs_groups": {"actor": groups, "critic": groups},
        **_model_configs(settings.network, shapes, branches, layouts),
        "algorithm": {
            "class_name": algorithm_name(settings),
            "num_learning_epochs": ppo.epochs,
            "num_mini_batches": ppo.minibatches,
            "clip_param": ppo.clip,
            "gamma": ppo.gamma,
            "lam": ppo.lam,
            "value_loss_coef": ppo.value_loss,
            "entropy_coef": ppo.entropy,
            "learning_rate": ppo.learning_rate,
            "max_grad_norm": ppo.max_gradient,
            # A constant learning rate, as in the paper. rsl-rl's `adaptive` would change it.
            "schedule": "fixed",
            **({"gail": gail} if settings.imitates else {}),
        },
    }


def _model_configs(
    network: Network, shapes: Shapes, branches: Sequence[int], layouts: SpaceLayouts | None
) -> dict[str, Any]:
    if layouts is None:
        return {"actor": model_config(network, shapes, branches), "critic": model_config(network, shapes)}
    return {name: space_model_config(network, layouts, is_actor=name == "actor") for name in ("actor", "critic")}
