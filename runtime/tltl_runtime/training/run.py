"""A training as it was asked for, and the file in its folder that keeps this: ``run.json``."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Final

from tltl_runtime.stealth.level import Sensors
from tltl_runtime.training.settings import Settings
from tltlc.automaton.fspa import Fspa
from tltlc.record import record

RUN: Final = "run.json"
CHECKPOINT: Final = "checkpoint.pt"
POLICY: Final = "policy.safetensors"


@record
class Run:
    """What is trained, and where it is kept.

    ``spec`` is the name by which ``fspa`` was asked for, for messages; ``params`` are values of its params in SI units,
    before those that the level offers.  ``level`` is what :func:`~tltl_runtime.stealth.levels.file.load_level` takes.
    """

    folder: Path
    spec: str
    fspa: Fspa
    params: Mapping[str, float]
    level: str
    variant: str
    sensors: Sensors
    settings: Settings
    seed: int
