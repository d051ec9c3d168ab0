"""The runtime of ``.tltl`` specs: a stealth game, Gymnasium environments, and automata in batches.

The rewards of the environments follow from a spec. Importing this package registers the
environments ``tltl/Navigation-v0``, ``tltl/CoverAndHide-v0`` and ``tltl/Branching-v0``. The import
loads neither torch nor pybullet. The package needs the pip extra ``game`` of tltlc;
:mod:`tltl_runtime.spec.batch` needs the extra ``rl``.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from tltlc.api import OldNames

if TYPE_CHECKING:
    from tltl_runtime.game.tape import Tape as Tape
    from tltl_runtime.game.tape import read_tape as read_tape
    from tltl_runtime.game.tape import write_tape as write_tape
    from tltl_runtime.spec.task import Task as Task
    from tltl_runtime.spec.task import load_task as load_task
    from tltl_runtime.spec.wrapper import TltlEnv as TltlEnv

__all__ = ["Tape", "Task", "TltlEnv", "load_task", "read_tape", "write_tape"]

_HOMES = {
    "Tape": "tltl_runtime.game.tape",
    "Task": "tltl_runtime.spec.task",
    "TltlEnv": "tltl_runtime.spec.wrapper",
    "load_task": "tltl_runtime.spec.task",
    "read_tape": "tltl_runtime.game.tape",
    "write_tape": "tltl_runtime.game.tape",
}

sys.meta_path.insert(
    0,
    OldNames(
        {
            "tltl_runtime.batch": "tltl_runtime.spec.batch",
            "tltl_runtime.stealth.episodes": "tltl_runtime.stealth.recordings",
            "tltl_runtime.stealth.episodes.cause": "tltl_runtime.stealth.recordings.cause",
            "tltl_runtime.stealth.episodes.file": "tltl_runtime.stealth.recordings.file",
            "tltl_runtime.stealth.recording": "tltl_runtime.stealth.episode_recorder",
            "tltl_runtime.training.gail": "tltl_runtime.training.imitation.gail",
        }
    ),
)


def __getattr__(name: str) -> object:
    home = _HOMES.get(name)
    if home is None:
        raise AttributeError(f"module 'tltl_runtime' has no attribute {name!r}")
    from importlib import import_module

    value: object = getattr(import_module(home), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


def _register() -> None:
    from gymnasium import register

    for level in ("navigation", "cover_and_hide", "branching"):
        register(
            f"tltl/{level.title().replace('_', '')}-v0",
            entry_point="tltl_runtime.stealth.env:make_env",
            vector_entry_point="tltl_runtime.vector.level_environments:make_vec",
            kwargs={"level": level},
        )


_register()
