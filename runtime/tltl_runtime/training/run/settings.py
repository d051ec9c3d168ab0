"""How a training is run: the settings of ``settings.toml`` beside this module, unless a file says otherwise."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from math import inf
from pathlib import Path
from typing import Any, Final, Literal

from tltl_runtime.policies.network import Network, Shapes, model_config
from tltl_runtime.training.exploration.search import Exploration
from tltl_runtime.training.run.choices import EntropySchedule, Method, PenaltySchedule, Pool
from tltl_runtime.training.run.settings_file import read_values
from tltlc.core.record import record, replace
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.files import read_source
from tltlc.monitor import RewardOptions
from tltlc.monitor.reward import Mode, TerminalPenalty, Termination

DEFAULTS: Final = Path(__file__).with_name("settings.toml")

_PPO: Final = "PPO"
_GAIL: Final = "tltl_runtime.training.imitation.gail:Gail"
_HEADING: Final = re.compile(r"\[(\w+)\]")
_SETTING: Final = re.compile(r"(?P<head>(?P<key>\w+) = [^#]*?)\s*(?P<comment>#.*)?$")


@record
class Ppo:
    """rsl-rl's PPO; learning rate, entropy, clip, lambda and gamma are by default the paper's (section VI).

    As the pass rate rises from a half to 1, the actor's logits are multiplied by up to ``sharpening``.
    A training that begins with a policy has a critic that knows nothing: in its first ``warm_up`` updates the critic
    learns alone, lest the policy follow what it says then.
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
    """``envs`` environments take ``steps`` decisions between updates, stepped by ``workers`` processes (0: as many as
    there are cores), of this machine or of a Ray cluster.
    """

    envs: int
    steps: int
    workers: int
    pool: Pool


@record
class Imitation:
    """The imitation baseline (paper, section VI): behavioural cloning for a share ``cloning``, then GAIL.

    The share is of the limit that comes first, of steps or of minutes.  ``demonstrations`` of the expert are recorded
    where none are named.  The discriminator has two layers of width ``encoding`` and the learning rate
    ``discriminator_rate``; its reward counts ``strength`` times, and an episode ends with plus or minus ``terminal``.
    See :mod:`tltl_runtime.training.imitation.gail`.
    """

    demonstrations: int
    cloning: float
    encoding: int
    discriminator_rate: float
    gradient_penalty: float
    strength: float
    terminal: float


@record
class Reward:
    """How steps are rewarded: the fields of :class:`~tltlc.monitor.reward.RewardOptions`, and what changes meanwhile.

    With the ``penalty_schedule`` ``rising`` a ``discounted`` terminal penalty of mode ``progress`` becomes the
    undiscounted one as the pass rate rises from a half to 1.
    """

    mode: Mode
    termination: Termination
    terminal_penalty: TerminalPenalty
    penalty_schedule: PenaltySchedule
    gamma: float

    @property
    def options(self) -> RewardOptions:
        """How the environments reward."""
        return RewardOptions(self.mode, self.termination, self.terminal_penalty, self.gamma)

    @property
    def rises(self) -> bool:
        """Whether what a violation costs changes in the training."""
        return self.penalty_schedule == "rising" and (self.mode, self.terminal_penalty) == ("progress", "discounted")


@record
class Stop:
    """Training ends when the spec was met throughout ``windows`` successive windows of ``episodes`` each, and then by
    the policy in as many fresh episodes as ``confirmation`` says; or after ``steps`` decisions of all environments, or
    after ``minutes`` of training (0: no such limit).
    """

    windows: int
    episodes: int
    confirmation: int
    steps: int
    minutes: float

    def is_late(self, seconds: float) -> bool:
        """Whether a training of so many seconds has reached the limit of minutes."""
        return 0 < self.minutes * 60 <= seconds

    def reached(self, steps: int, seconds: float) -> Literal["steps", "minutes"] | None:
        """The limit that a training of so many steps and seconds has reached, None: neither."""
        if steps >= self.steps:
            return "steps"
        return "minutes" if self.is_late(seconds) else None


@record
class Classes:
    """Names of classes, as :func:`rsl_rl.utils.resolve_callable` takes them."""

    runner: str
    algorithm: str


@record
class Settings:
    """All settings of a training but for its seed.

    By the ``method`` ``imitation`` what ``imitation`` says holds, and neither ``exploration`` nor ``reward`` does.
    A checkpoint follows the first iteration that ends ``checkpoint_s`` seconds or more after the last one; ``threads``
    are those of torch while it learns, and ``device`` is where the network is.
    """

    ppo: Ppo
    rollout: Rollout
    network: Network
    exploration: Exploration
    imitation: Imitation
    reward: Reward
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
        """How the environments reward; by imitation as they do where nothing is said."""
        return RewardOptions() if self.imitates else self.reward.options

    @property
    def searches(self) -> bool:
        """Whether ways are searched before the training, and episodes begin on them."""
        return self.exploration.ways > 0 and not self.imitates


def read_settings(path: Path | None = None) -> Settings:
    """The defaults, with what a TOML file says in place of them.

    Raises:
        TltlError: the file cannot be read (TLT0001 to TLT0004), is not TOML (TLT0860), has a key that there is not
            (TLT0861) or a value that cannot be (TLT0862).
    """
    values = read_values(read_source(DEFAULTS))
    if path is not None:
        given = read_values(read_source(path))
        values = {name: {**known, **given.get(name, {})} for name, known in values.items()}
    ppo, rollout = Ppo(**values["ppo"]), Rollout(**values["rollout"])
    if ppo.minibatches > rollout.envs * rollout.steps:
        title = f"{ppo.minibatches} minibatches are more than there are decisions in a rollout"
        raise TltlError([Diagnostic("TLT0862", title, help=f"give {rollout.envs * rollout.steps} at the most")])
    return Settings(
        ppo=ppo,
        rollout=rollout,
        network=Network(**values["network"]),
        exploration=Exploration(**values["exploration"]),
        imitation=Imitation(**values["imitation"]),
        reward=Reward(**values["reward"], gamma=ppo.gamma),
        stop=Stop(**values["stop"]),
        classes=Classes(**values["classes"]),
        **values[""],
    )


def default_text() -> str:
    """The TOML text of the defaults, with comments: a file to begin one's own with."""
    return DEFAULTS.read_text(encoding="utf-8")


def settings_text(settings: Settings) -> str:
    """These settings as TOML text: that of the defaults, with other values where they differ."""
    table, lines = "", []
    defaults = read_settings()
    for line in default_text().splitlines():
        if heading := _HEADING.match(line):
            table = heading[1]
        if found := _SETTING.match(line):
            value, default = (getattr(getattr(each, table, each), found["key"]) for each in (settings, defaults))
            if value != default:
                line = f"{found['key']} = {_toml(value)}"
                if comment := found["comment"]:
                    line = f"{line:<{found.start('comment') - 1}} {comment}"
        lines.append(line)
    return "\n".join(lines) + "\n"


def _toml(value: object) -> str:
    """A value of a setting as TOML; texts have no signs that TOML would read otherwise than JSON."""
    # Beyond 16 bits JSON's escapes are pairs, which TOML has not.
    return json.dumps(list(value) if isinstance(value, tuple) else value, ensure_ascii=False)


def algorithm_name(settings: Settings) -> str:
    """The name of the class that learns; by imitation the settings' ``PPO`` stands for what makes GAIL of it."""
    name = settings.classes.algorithm
    return _GAIL if settings.imitates and name == _PPO else name


def rsl_config(settings: Settings, shapes: Shapes, branches: Sequence[int]) -> dict[str, Any]:
    """The configuration of rsl-rl's runner for observations of these shapes and actions of these branches."""
    ppo, imitation = settings.ppo, settings.imitation
    groups = list(shapes)
    gail = {
        "branches": tuple(branches),
        "discriminator": model_config(replace(settings.network, hidden=(imitation.encoding,) * 2), shapes),
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
        "actor": model_config(settings.network, shapes, branches),
        "critic": model_config(settings.network, shapes),
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
            # The paper's learning rate stays as it is: `adaptive` would choose another.
            "schedule": "fixed",
            **({"gail": gail} if settings.imitates else {}),
        },
    }
