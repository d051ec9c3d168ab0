"""The card of a policy: the data that a policy file stores with the weights."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from tltl_runtime.game.sensors import Sensors
from tltl_runtime.policies.network import Network
from tltl_runtime.policies.spaces.layouts import SpaceLayouts
from tltlc.api import Fspa, RewardOptions, record

OBSERVATION: Final = 1
"""The version of the observations. It changes whenever the same numbers get another meaning."""


@record
class Card:
    """The metadata of a policy: its task, its network, and the record of its training.

    - ``level`` and ``variant`` name the level of the training; ``level_hash`` is the hash of its
      content (:meth:`~tltl_runtime.game.game.Game.level_hash`).
    - ``fspa`` is the automaton of the spec, and ``params`` are the values of its params, in SI
      units.
    - ``sensors`` say what the policy observes.
    - ``shapes`` has pairs of the key and the shape of each part of an observation, in the order of
      the network's inputs.
    - ``branches`` has the number of choices of each discrete branch of an action.
    - ``versions`` are the versions of Python and of the packages that trained the policy, by name.
    - ``training`` is the record of the training as JSON data, empty until the training ends.
    - ``observation`` is the version of the observations (:data:`OBSERVATION`) that the policy was
      trained with.
    - ``spaces`` say how observations and actions become arrays; ``branches`` is then empty. None if
      the network uses observations and actions without conversion.
    """

    level: str
    variant: str
    level_hash: str
    fspa: Fspa
    params: Mapping[str, float]
    reward: RewardOptions
    sensors: Sensors
    shapes: tuple[tuple[str, tuple[int, ...]], ...]
    branches: tuple[int, ...]
    network: Network
    versions: Mapping[str, str]
    training: Mapping[str, Any]
    observation: int = OBSERVATION
    spaces: SpaceLayouts | None = None
