"""What a policy file says beside the weights."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from tltl_runtime.policies.network import Network
from tltl_runtime.stealth.level import Sensors
from tltlc.automaton.fspa import Fspa
from tltlc.core.record import record
from tltlc.monitor import RewardOptions

OBSERVATION: Final = 1
"""The version of what the environments show an agent: another one wherever the same numbers mean something else."""


@record
class Card:
    """What a policy was trained for, and how.

    ``level`` and ``variant`` name where it was trained, ``level_hash`` is that place's
    (:func:`~tltl_runtime.policies.identity.level_hash`); ``fspa`` is the spec's automaton with ``params`` in SI units;
    ``sensors`` are all that it senses.  ``shapes`` are those of the observation by key, in the order in which the
    network takes them, ``branches`` those of the action.  ``training`` is the record of its training, JSON data.
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
