"""How a training is run: the paper's settings unless a file says otherwise."""

from __future__ import annotations

from tltl_runtime.policies.network import Network
from tltl_runtime.training.exploration import Exploration
from tltlc.monitor import RewardOptions
from tltlc.record import record


@record
class Ppo:
    """rsl-rl's PPO; learning rate, entropy, clip, lambda and gamma are the paper's (section VI)."""

    learning_rate: float = 3e-4
    entropy: float = 0.01
    clip: float = 0.2
    lam: float = 0.95
    gamma: float = 0.99
    epochs: int = 3
    minibatches: int = 4
    value_loss: float = 1.0
    max_gradient: float = 1.0


@record
class Rollout:
    """``envs`` environments take ``steps`` decisions between updates, stepped by ``workers`` processes (0: as many as
    there are cores).
    """

    envs: int = 32
    steps: int = 128
    workers: int = 0


@record
class Stop:
    """Training ends when the spec was met throughout ``windows`` successive windows of ``episodes`` each, or after
    ``steps`` decisions of all environments, or after ``minutes`` of training (0: no such limit).
    """

    windows: int = 2
    episodes: int = 50
    steps: int = 4_000_000
    minutes: float = 0.0


@record
class Settings:
    """All settings of a training but for its seed; ``checkpoint_s`` are seconds between checkpoints at the most."""

    ppo: Ppo = Ppo()
    rollout: Rollout = Rollout()
    network: Network = Network()
    exploration: Exploration = Exploration()
    reward: RewardOptions = RewardOptions(terminal_penalty="discounted", gamma=0.99)
    stop: Stop = Stop()
    checkpoint_s: float = 60.0
    threads: int = 1
    device: str = "cpu"
