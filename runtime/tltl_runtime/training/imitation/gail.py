"""The imitation baseline: behavioural cloning first, then PPO on the rewards of a discriminator (GAIL).

Gutiérrez-Sánchez et al., IEEE Trans. Games 2024, section VI: "we bootstrap a neural network with an architecture
identical to the one of the TL model using behavioral cloning (first 5% of training steps), and then run training using
a GAIL-generated reward signal (learning rate = 0.0003, encoding size = 128, γ = 0.99) and adding a terminal reward at
the end of each episode of +1 if the specification was successfully completed and -1 otherwise".

What the paper leaves open is decided so:

- the agent senses what the other one does, the automaton's state included, since the architecture is identical; of the
  automaton's rewards it gets nothing, and a success or failure is all that it is told of the spec;
- the 5 % are of the limit that comes first, that of steps or that of minutes, so that any training has its share;
- while the actor is cloned, it plays episodes, sampled, which count; the critic and the discriminator learn from these,
  so that GAIL does not begin with an ignorant critic, and the actor from the demonstrations alone;
- an update clones as many passes over all demonstrations as PPO makes over a rollout, at PPO's learning rate;
- the discriminator sees decisions, observations with actions, as in Ho and Ermon's paper; it has the policy's
  convolutions of its own, then two layers of the encoding's width; it makes a pass over each rollout, against as many
  decisions of demonstrations, with a penalty on its gradients as in ML-Agents, by which the paper trains;
- its reward is -log(1 - D), ML-Agents' form, which is never negative; it counts a hundredth (``strength``), and one
  critic values it together with the terminal reward.  At gamma 0.99, to live on for ever is then worth -log(1 - D):
  0.69 where decisions cannot be told from demonstrated ones, D = 1/2, and less than a success until D is above
  1 - 1/e = 0.63; beyond, nothing cuts it;
- an episode that reaches the limit ends in failure: nothing is estimated of what would have come.
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
from tltl_runtime.training.imitation.imitation_data import Demonstrated

_Losses = dict[str, float]


class Gail(PPO):
    """rsl-rl's PPO with the rewards of a discriminator in place of the environment's, after behavioural cloning.

    ``gail`` is what :func:`~tltl_runtime.training.run.settings.rsl_config` makes of the settings.  The environment it
    is
    constructed for has ``demonstrated`` decisions, and says in the extras of a step where an episode ended in success.
    Beside PPO's, losses are ``cloning``, the mean negative log-likelihood of the demonstrations in nats a decision;
    ``discriminator``; and the mean probabilities that the discriminator gives decisions to be demonstrated:
    ``discriminator_theirs`` for those that are, ``discriminator_agents`` for the agent's.
    """

    demonstrated: Demonstrated

    def __init__(self, actor: Any, critic: Any, storage: Any, *, gail: Mapping[str, Any], **ppo: Any) -> None:
        super().__init__(actor, critic, storage, **ppo)
        self._strength, self._terminal = float(gail["strength"]), float(gail["terminal"])
        self._penalty = float(gail["gradient_penalty"])
        self.steps = 0
        """Decisions of all processes that it has learned from."""
        self.seconds = 0.0
        """How long it has trained, in seconds; who drives it says so."""
        self.cloning_steps, self.cloning_s = int(gail["cloning_steps"]), float(gail["cloning_s"])
        """Before so many steps, and so many seconds, the actor is cloned: shares of the limits that a training is begun
        with, whatever they are later."""
        example = storage.observations[0].to("cpu")
        self.discriminator = Discriminator(example, gail["branches"], gail["discriminator"]).to(self.device)
        if not self.is_multi_gpu:
            self.discriminator.to(memory_format=torch.channels_last)  # type: ignore[call-overload]
        self._discriminating = torch.optim.Adam(self.discriminator.parameters(), lr=gail["discriminator_rate"])

    @staticmethod
    def construct_algorithm(obs: Any, env: Any, cfg: dict[str, Any], device: str) -> Gail:
        """As rsl-rl does, with the demonstrations of ``env``."""
        made: Any = PPO.construct_algorithm(obs, env, cfg, device)
        made.demonstrated = env.demonstrated.to(device)
        return made  # type: ignore[no-any-return]

    @property
    def clones(self) -> bool:
        """Whether the actor is cloned as yet."""
        return self.steps < self.cloning_steps and self.seconds < self.cloning_s

    def process_env_step(self, obs: Any, rewards: Tensor, dones: Tensor, extras: dict[str, Tensor]) -> None:
        """Record a step of the environment, of whose ``rewards`` nothing counts; and no end is a mere interruption."""
        met = extras["successes"].to(rewards.device)
        ends = torch.where(met, self._terminal, -self._terminal) * dones.to(torch.float32)
        super().process_env_step(obs, ends, dones, {})

    def compute_returns(self, obs: Any) -> None:
        """Add what the discriminator gives for the rollout, and compute its returns and advantages."""
        given = self.discriminator.reward(self._rollout())
        self.storage.rewards += self._strength * given.view(self.storage.rewards.shape)
        super().compute_returns(obs)

    def update(self) -> _Losses:
        """Teach the discriminator on the rollout; then clone the actor, or take PPO's steps; the mean losses."""
        storage = self.storage
        told = self._discriminate()
        losses = {**self._value(), **self._clone()} if self.clones else super().update()
        storage.clear()
        self.steps += storage.num_envs * storage.num_transitions_per_env * self.gpu_world_size
        return {**losses, **told}

    def save(self) -> dict[str, Any]:
        """All that it takes to go on."""
        return {
            **super().save(),
            "discriminator_state_dict": self.discriminator.state_dict(),
            "discriminator_optimizer_state_dict": self._discriminating.state_dict(),
            "steps": self.steps,
            "cloning_steps": self.cloning_steps,
            "cloning_s": self.cloning_s,
        }

    def load(self, loaded_dict: dict[str, Any], load_cfg: dict[str, Any] | None, strict: bool) -> bool:
        """Take up what :meth:`save` gave; rsl-rl's choice of parts is of those of PPO."""
        self.discriminator.load_state_dict(loaded_dict["discriminator_state_dict"], strict=strict)
        self._discriminating.load_state_dict(loaded_dict["discriminator_optimizer_state_dict"])
        self.steps, self.cloning_steps = loaded_dict["steps"], loaded_dict["cloning_steps"]
        self.cloning_s = loaded_dict["cloning_s"]
        return bool(super().load(loaded_dict, load_cfg, strict))

    def train_mode(self) -> None:
        """Set all networks to learning."""
        super().train_mode()
        self.discriminator.train()

    def eval_mode(self) -> None:
        """Set all networks to being used."""
        super().eval_mode()
        self.discriminator.eval()

    def broadcast_parameters(self) -> None:
        """Give all processes the first one's weights."""
        super().broadcast_parameters()
        for tensor in self.discriminator.state_dict().values():
            torch.distributed.broadcast(tensor, src=0)

    def _rollout(self) -> tuple[TensorDict, Tensor]:
        return self.storage.observations.flatten(0, 1), self.storage.actions.flatten(0, 1)

    def _discriminate(self) -> _Losses:
        """A pass over the rollout in as many parts as PPO's, each against as many decisions of demonstrations."""
        observations, actions = self._rollout()
        losses, theirs, agents = [], [], []
        for chosen in torch.randperm(len(actions), device=self.device).tensor_split(self.num_mini_batches):
            played: Decisions = observations[chosen], actions[chosen]
            judged = self.discriminator.judged(self.demonstrated.drawn(len(chosen)), played, self._penalty)
            self._discriminating.zero_grad()
            judged.loss.backward()
            if self.is_multi_gpu:
                parameters = self.discriminator.parameters()
                reduce_gradients_in_buckets(parameters, self.gpu_world_size, self.grad_reduce_bucket_mb)
            self._discriminating.step()
            losses.append(judged.loss.item())
            theirs.append(judged.theirs)
            agents.append(judged.agents)
        return {
            "discriminator": _mean(losses),
            "discriminator_theirs": _mean(theirs),
            "discriminator_agents": _mean(agents),
        }

    def _value(self) -> _Losses:
        """Teach the critic alone, on the rollout of an actor that is cloned."""
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

    def _clone(self) -> _Losses:
        """Take the actor towards the demonstrations, as many passes over them as PPO makes over a rollout."""
        total = 0.0
        for _ in range(self.num_learning_epochs):
            for observations, actions in self.demonstrated.shuffled(BATCH):
                total += imitate(self, observations, actions) * BATCH
        return {"cloning": total / (self.num_learning_epochs * len(self.demonstrated.actions))}


def _mean(values: list[float]) -> float:
    return sum(values) / len(values)
