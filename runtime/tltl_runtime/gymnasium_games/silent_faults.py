"""Find out whether a game only seems to play: its signals stand still, or its scripts fail while it answers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Final

from tltl_runtime.gymnasium_games.plays import STEPS, ScenePlay, observation_changes, unchanged_signals
from tltl_runtime.wire.error_lines import script_error
from tltlc.api import Diagnostic, Label

_PLAYS: Final = (
    "the observation changes, so the game plays: check that the signals can change; if only play with a plan changes "
    "them, a training searches more easily with `tltl_positions`, or with a signal that changes on the way"
)
_STANDS: Final = (
    "check that each step plays the game and reads its signals anew: the observation does not change either; if it "
    "does, random actions get nowhere: add a signal that changes on the way, such as the distance to the goal"
)


def silent_faults(name: str, label: Label, play: ScenePlay, lines: Sequence[str]) -> Iterator[Diagnostic]:
    """Yield warnings about a game that answers, but seems not to play.

    - TLT0786: no signal has changed in a whole play.
    - TLT0787: an error in a script is among the ``lines`` of the game's standard error.

    ``name`` is the scene and its variant, ``SCENE:VARIANT``. ``label`` is a place in the game file.
    """
    error = script_error(lines)
    if error:
        title = f"`{name}` went on after an error in a script of the game: {error}"
        yield Diagnostic(
            "TLT0787", title, (label,), "correct the script: a part of the game may stand still", "warning"
        )
    unchanged = unchanged_signals(play.moments)
    if unchanged and play.steps == STEPS and len(unchanged) == len(play.moments[0].sample):
        counted = f"none of the {len(unchanged)} signals changed" if len(unchanged) > 1 else "the signal did not change"
        title = f"{counted} in {STEPS} random steps in `{name}`"
        yield Diagnostic(
            "TLT0786", title, (label,), _PLAYS if observation_changes(play.moments) else _STANDS, "warning"
        )
