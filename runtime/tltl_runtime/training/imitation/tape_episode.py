"""Play tapes again, so that the plays of a person become recorded episodes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from tltl_runtime.game.recorder import EpisodeRecorder, EpisodeT, judging_wrapper
from tltl_runtime.game.tape import Tape
from tltl_runtime.wire.errors import MalformedMessageError
from tltl_runtime.wire.values import value_reader
from tltlc.api import Diagnostic, TltlError

PLAYER: Final = "tape"
"""The name of the player of a tape in recordings."""
_NOT_SAME: Final = "the game must be the one that was recorded, and equal seeds and actions must give equal plays"


def tape_episode(env: EpisodeRecorder[EpisodeT], tape: Tape, name: str) -> EpisodeT:
    """Reset a level with the seed of a tape, take the actions of its steps, and return the recorded episode.

    ``name`` is the name of the tape in messages. The steps after the end of the episode are not played. A signal
    that the game does not give is not compared.

    Raises:
        TltlError: TLT0923, the tape has no seed, is of another scene or variant, has an action that the level
            does not have, or the level gives none of its signals or other values; the errors of the game.
    """
    header, level = tape.header, env.get_wrapper_attr("level")
    if header.seed is None:
        raise _error(name, "it has no seed", "give the seed to `begin` of the recorder, and record the play again")
    scene = level.name if header.scene is None else header.scene
    if (scene, header.variant) != (level.name, level.variant):
        played = f"it is of `{scene}:{header.variant}`, not of `{level.name}:{level.variant}`"
        raise _error(name, played, f"name `{scene}:{header.variant}` in place of `{level.name}:{level.variant}`")
    judge, read = judging_wrapper(env), value_reader(env.action_space, "action")
    env.reset(seed=header.seed)
    if header.signals.keys().isdisjoint(judge.sample):
        raise _error(name, "the level gives none of its signals", _NOT_SAME)
    for number, step in enumerate(tape.steps, 1):
        try:
            action = read(step.action)
        except MalformedMessageError as error:
            raise _error(name, f"step {number} {error}", "record the play in the game as it is now") from None
        _, _, terminated, truncated, _ = env.step(action)
        if signal := _other_signal(step.signals, judge.sample):
            values = f"`{signal}` is {float(judge.sample[signal]):g}, but {float(step.signals[signal]):g} on the tape"
            raise _error(name, f"after step {number}, {values}", _NOT_SAME)
        if terminated or truncated:
            break
    return env.episode


def _other_signal(recorded: Mapping[str, float], sample: Mapping[str, Any]) -> str:
    """Return the name of the first signal with another value than on the tape; empty if there is none."""
    names = (name for name in recorded if name in sample and float(sample[name]) != float(recorded[name]))
    return next(names, "")


def _error(name: str, why: str, help_: str) -> TltlError:
    return TltlError([Diagnostic("TLT0923", f"the tape `{name}` cannot be played again: {why}", help=help_)])
