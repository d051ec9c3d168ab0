"""Errors for observation and action spaces that policies do not support."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from gymnasium import spaces

from tltlc.api import Diagnostic, TltlError

ADDED_KEYS: Final = ("automaton", "progress")
"""The keys that :class:`~tltl_runtime.spec.wrapper.TltlEnv` adds to an observation."""

_POSSIBLE: Final = "Box, Discrete, MultiDiscrete, MultiBinary, or a Dict or Tuple of these"


class SpaceRefusedError(Exception):
    """Raised for a part of a space that policies do not support.

    ``path`` has the keys and indices that lead to the part. ``reason`` completes the sentence that
    begins with the name of the part, such as "is a Text space, which no network can read".
    """

    def __init__(self, path: tuple[str, ...], reason: str) -> None:
        super().__init__(reason)
        self.path = path
        self.reason = reason


def name_of(path: Sequence[str]) -> str:
    """Return a path as a name, with slashes between its parts: ``("arm", "0")`` -> ``arm/0``.

    In a part, ``~`` becomes ``~0`` and ``/`` becomes ``~1``, as in JSON Pointer (RFC 6901). So
    different paths have different names.
    """
    return "/".join(key.replace("~", "~0").replace("/", "~1") for key in path)


def observation_error(space: spaces.Space[object], refusals: Sequence[SpaceRefusedError]) -> TltlError:
    """Return the error TLT0844 for an observation space, with a diagnostic for each unsupported part."""
    return TltlError([_diagnostic("observation", refusal, _observation_help(space, refusals)) for refusal in refusals])


def action_error(refusals: Sequence[SpaceRefusedError]) -> TltlError:
    """Return the error TLT0844 for an action space, with a diagnostic for each unsupported part."""
    help_ = f"wrap the environment, so that its actions are {_POSSIBLE}"
    return TltlError([_diagnostic("action", refusal, help_) for refusal in refusals])


def _diagnostic(what: str, refusal: SpaceRefusedError, help_: str) -> Diagnostic:
    part = f"`{name_of(refusal.path)}` of the {what}" if refusal.path else f"the {what}"
    return Diagnostic("TLT0844", f"{part} {refusal.reason}", help=help_)


def _observation_help(space: spaces.Space[object], refusals: Sequence[SpaceRefusedError]) -> str:
    refused = {refusal.path[0] for refusal in refusals if refusal.path}
    keys = list(space.spaces) if isinstance(space, spaces.Dict) else []
    kept = [key for key in keys if key not in refused and key not in ADDED_KEYS]
    if kept:
        listed = ", ".join(f'"{key}"' for key in kept)
        return f"leave it out: write `observation = [{listed}]` in the game file"
    return f"wrap the environment, so that its observations are {_POSSIBLE}"
