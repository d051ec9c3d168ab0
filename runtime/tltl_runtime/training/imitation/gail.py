"""The imitation baseline: behavioural cloning, then PPO on the rewards of a discriminator (GAIL).

Gutiérrez-Sánchez et al., IEEE Trans. Games 2024, section VI: "we bootstrap a neural network with an
architecture identical to the one of the TL model using behavioral cloning (first 5% of training
steps), and then run training using a GAIL-generated reward signal (learning rate = 0.0003, encoding
size = 128, γ = 0.99) and adding a terminal reward at the end of each episode of +1 if the
specification was successfully completed and -1 otherwise".

The paper leaves some points open. This implementation decides them as follows:

- The observations are the same as for the agent that learns from the automaton's rewards, and
  include the automaton state, because the architecture is identical. The agent gets none of the
  automaton's rewards. All that it learns about the spec is whether an episode succeeded.
- Cloning ends after 5 % of the limit of steps or 5 % of the limit of minutes, whichever comes
  first.
- During cloning, the actor plays episodes with sampled actions. These steps count towards the
  limit. The critic and the discriminator learn from them, so that GAIL begins with a trained
  critic. The actor learns from the demonstrations alone.
- A cloning update makes as many passes over all demonstrations as PPO makes over a rollout, at
  PPO's learning rate.
- The discriminator sees observations with actions, as in Ho and Ermon's paper. It has its own
  convolutions, with the policy's architecture, then two layers of the encoding's width. It makes
  one pass over each rollout, against equally many decisions of demonstrations, with a gradient
  penalty as in ML-Agents, the toolkit of the paper.
- The discriminator's reward is -log(1 - D), as in ML-Agents, which is never negative. It is
  multiplied by ``strength``, one hundredth by default. One critic estimates the return of this
  reward and the terminal reward together. With gamma 0.99, the value of an endless episode is then
  -log(1 - D). This value is 0.69 if the discriminator cannot tell the agent's decisions from
  demonstrated ones (D = 1/2). It is less than the reward of a success, 1, until D exceeds
  1 - 1/e = 0.63. The discriminator's reward is not clipped beyond that.
- An episode that reaches the limit is a failure, and its return is not bootstrapped.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import torch
from rsl_rl.algorithms import PPO
from rsl_rl.utils import reduce_gradients_in_buckets
from tensordict import TensorDict
from torch import Tensor, nn

from tltl_runtime.training.exploration.self_imitation import BATCH, imitate
from tltl_runtime.training.imitation.discriminator import Decisions, Discriminator
from tltl_runtime.training.imitation.imitation_data import ImitationData
from tltl_runtime.training.imitation.space_discriminator import SpaceDiscriminator

_Losses = dict[str, float]


class Gail(PPO):
    """rsl-rl's PPO with rewards from a discriminator, after behavioural cloning.

    ``gail`` has the settings, from the entry ``gail`` of
    :func:`~tltl_runtime.training.files.settings.rsl_config`. The environment must have
    ``imitation_data``. The extras of its steps must have ``successes``: bools [num_envs] that say
    which episodes ended in success.

    The losses are those of PPO, or during cloning:

    - ``value``: the loss of the critic;
    - ``cloning``: the mean negative log-likelihood of the demonstrations, in nats per decision.

    Further losses in both phases describe the discriminator, which predicts the probability that a
    decision is from a demonstration:

    - ``discriminator``: its loss;
    - ``discriminator_theirs``: the mean of its predictions for decisions of demonstrations;
    - ``discriminator_agents``: the mean of its predictions for decisions of the agent.
    """

    imitation_data: ImitationData

    def __init__(self, actor: Any, critic: Any, storage: Any, *, gail: Mapping[str, Any], **ppo: Any) -> None:
        super().__init__(actor, critic, storage, **ppo)
        self._strength, self._terminal = float(gail["strength"]), float(gail["terminal"])
        self._penalty = float(gail["gradient_penalty"])
        self.steps = 0
        """The number of decisions, of all processes, that the algorithm has learned from."""
        self.seconds = 0.0
        """The training time so far, in seconds; the caller sets it."""
        self.cloning_steps, self.cloning_s = int(gail["cloning_steps"]), float(gail["cloning_s"])
        """The actor is cloned until this many steps or seconds of the training are over.

        The limit that is reached first counts. Both are computed from the limits when the training
        begins, and stay if the limits change later.
        """
        self.discriminator = _discriminator(gail, storage.observations[0].to("cpu")).to(self.device)
        if not self.is_multi_gpu:
            self.discriminator.to(memory_format=torch.channels_last)  # type: ignore[call-overload]
        self._discriminator_optimizer = torch.optim.Adam(self.discriminator.parameters(), lr=gail["discriminator_rate"])

    @staticmethod
    def construct_algorithm(obs: Any, env: Any, cfg: dict[str, Any], device: str) -> Gail:
        """Construct the algorithm like rsl-rl, with the imitation data of ``env``."""
        algorithm: Any = PPO.construct_algorithm(obs, env, cfg, device)
        algorithm.imitation_data = env.imitation_data.to(device)
        return algorithm  # type: ignore[no-any-return]

    @property
    def is_cloning(self) -> bool:
        """Whether the actor is still being cloned."""
        return self.steps < self.cloning_steps and self.seconds < self.cloning_s

    def process_env_step(self, obs: Any, rewards: Tensor, dones: Tensor, extras: dict[str, Tensor]) -> None:
        """Record a step of the environments; replace ``rewards`` [num_envs] by terminal rewards.

        An episode that ends gets plus ``terminal`` (a setting) if it succeeded, minus ``terminal``
        if not. All other rewards become 0. Time-outs are not passed on to PPO, so that no return is
        bootstrapped.
        """
        successes = extras["successes"].to(rewards.device)
        terminal_rewards = torch.where(successes, self._terminal, -self._terminal) * dones.to(torch.float32)
        super().process_env_step(obs, terminal_rewards, dones, {})

    def compute_returns(self, obs: Any) -> None:
        """Add the discriminator's rewards to the rollout; compute its returns and advantages."""
        rewards = self.discriminator.reward(self._rollout())
        self.storage.rewards += self._strength * rewards.view(self.storage.rewards.shape)
        super().compute_returns(obs)

    def update(self) -> _Losses:
        """Train all networks on the rollout; return the mean losses by name.

        Train the discriminator first. Then, during cloning, train the critic and clone the actor;
        after cloning, update both by PPO.
        """
        storage = self.storage
        discriminator_losses = self._train_discriminator()
        losses = self._clone() if self.is_cloning else super().update()
        storage.clear()
        self.steps += storage.num_envs * storage.num_transitions_per_env * self.gpu_world_size
        return {**losses, **discriminator_losses}

    def save(self) -> dict[str, Any]:
        """Return everything that is needed to resume, as rsl-rl's algorithms do."""
        return {
            **super().save(),
            "discriminator_state_dict": self.discriminator.state_dict(),
            "discriminator_optimizer_state_dict": self._discriminator_optimizer.state_dict(),
            "steps": self.steps,
            "cloning_steps": self.cloning_steps,
            "cloning_s": self.cloning_s,
        }

    def load(self, loaded_dict: dict[str, Any], load_cfg: dict[str, Any] | None, strict: bool) -> bool:
        """Restore what :meth:`save` returned.

        ``load_cfg`` selects which parts of PPO are restored, as in rsl-rl. The discriminator is
        always restored.
        """
        self.discriminator.load_state_dict(loaded_dict["discriminator_state_dict"], strict=strict)
        self._discriminator_optimizer.load_state_dict(loaded_dict["discriminator_optimizer_state_dict"])
        self.steps, self.cloning_steps = loaded_dict["steps"], loaded_dict["cloning_steps"]
        self.cloning_s = loaded_dict["cloning_s"]
        return bool(super().load(loaded_dict, load_cfg, strict))

    def train_mode(self) -> None:
        """Set all networks to training mode."""
        super().train_mode()
        self.discriminator.train()

    def eval_mode(self) -> None:
        """Set all networks to evaluation mode."""
        super().eval_mode()
        self.discriminator.eval()

    def broadcast_parameters(self) -> None:
        """Copy the weights of the first process to all processes."""
        super().broadcast_parameters()
        for tensor in self.discriminator.state_dict().values():
            torch.distributed.broadcast(tensor, src=0)

    def _rollout(self) -> tuple[TensorDict, Tensor]:
        return self.storage.observations.flatten(0, 1), self.storage.actions.flatten(0, 1)

    def _train_discriminator(self) -> _Losses:
        """Train the discriminator with one pass over the rollout, in as many minibatches as PPO.

        Each minibatch is compared with equally many decisions of demonstrations.
        """
        observations, actions = self._rollout()
        self.discriminator.update_normalization((observations, actions))
        losses, demonstration_probabilities, agent_probabilities = [], [], []
        for rows in torch.randperm(len(actions), device=self.device).tensor_split(self.num_mini_batches):
            agent_decisions: Decisions = observations[rows], actions[rows]
            result = self.discriminator.loss(self.imitation_data.sample(len(rows)), agent_decisions, self._penalty)
            self._discriminator_optimizer.zero_grad()
            result.loss.backward()
            if self.is_multi_gpu:
                parameters = self.discriminator.parameters()
                reduce_gradients_in_buckets(parameters, self.gpu_world_size, self.grad_reduce_bucket_mb)
            self._discriminator_optimizer.step()
            losses.append(result.loss.item())
            demonstration_probabilities.append(result.demonstration_probability)
            agent_probabilities.append(result.agent_probability)
        return {
            "discriminator": _mean(losses),
            "discriminator_theirs": _mean(demonstration_probabilities),
            "discriminator_agents": _mean(agent_probabilities),
        }

    def _clone(self) -> _Losses:
        """Train the critic and clone the actor; first update their input scales from the rollout."""
        observations, _ = self._rollout()
        self.actor.update_normalization(observations)
        self.critic.update_normalization(observations)
        return {**self._train_critic(), **self._clone_actor()}

    def _train_critic(self) -> _Losses:
        """Train the critic on the rollout, and leave the actor as it is; return the loss as ``value``."""
        losses = []
        for batch in self.storage.mini_batch_generator(self.num_mini_batches, self.num_learning_epochs):
            loss = (batch.returns - self.critic(batch.observations)).square().mean()
            self.optimizer.zero_grad()
            (self.value_loss_coef * loss).backward()
            if self.is_multi_gpu:
                self.reduce_parameters()
            nn.utils.clip_grad_norm_(self.critic.parameters(), self.max_grad_norm)
            self.optimizer.step()
            losses.append(loss.item())
        return {"value": _mean(losses)}

    def _clone_actor(self) -> _Losses:
        """Train the actor to imitate the demonstrations; return the mean loss as ``cloning``.

        Make as many passes over the demonstrations as PPO makes over a rollout.
        """
        total = 0.0
        for _ in range(self.num_learning_epochs):
            for observations, actions in self.imitation_data.shuffled_batches(BATCH):
                total += imitate(self, observations, actions) * BATCH
        return {"cloning": total / (self.num_learning_epochs * len(self.imitation_data.actions))}


def _discriminator(gail: Mapping[str, Any], example: TensorDict) -> Discriminator:
    """Return a new discriminator; ``gail`` has its settings, and ``example`` is a batch of observations."""
    if gail["layouts"] is None:
        return Discriminator(example, gail["branches"], gail["discriminator"])
    return SpaceDiscriminator(gail["layouts"], gail["network"])


def _mean(values: list[float]) -> float:
    return sum(values) / len(values)
