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
    """The task that a policy was trained for, its network, and the record of its training.

    ``level`` and ``variant`` name the level of the training; ``level_hash`` is its
    :meth:`~tltl_runtime.game.game.Game.level_hash`. ``fspa`` is the automaton of the spec, with
    ``params`` in SI units. ``sensors`` are all sensors of the policy. ``shapes`` maps the keys of
    the observation to shapes, in the order of the network's inputs. An action has several branches;
    ``branches`` has the number of choices of each. ``versions`` are the versions of Python and of
    the packages that trained the policy, by name. ``training`` is the record of the training as
    JSON data. ``observation`` is the version of the observations (:data:`OBSERVATION`) that the
    policy was trained with. ``spaces`` are the layouts of observation and action if the network does
    not take and give their values as they are; ``branches`` is then empty.
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
