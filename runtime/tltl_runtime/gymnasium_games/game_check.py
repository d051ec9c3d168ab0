"""Start a scene, play it, and report what it offers and what is wrong with it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final

import numpy as np
from gymnasium import spaces

from tltl_runtime.gymnasium_games.capabilities import ATTRIBUTES, Capability, capabilities
from tltl_runtime.gymnasium_games.game_errors import RAISES, guarded
from tltl_runtime.gymnasium_games.game_file import GameFile
from tltl_runtime.gymnasium_games.key_actions import key_count_diagnostic
from tltl_runtime.gymnasium_games.plays import (
    SEED,
    PlayDifference,
    PlayedMoment,
    ScenePlay,
    drawn_actions,
    first_difference,
    first_other_observation,
    go_on,
    play,
    unchanged_signals,
)
from tltl_runtime.gymnasium_games.scene_env import SceneEnv, make_base_env
from tltl_runtime.gymnasium_games.silent_faults import silent_faults
from tltl_runtime.gymnasium_games.spec_fit import Supply
from tltl_runtime.gymnasium_games.speed_advice import speed_advice
from tltl_runtime.wire.env import WireEnv
from tltl_runtime.wire.errors import WireError
from tltlc.api import Diagnostic, Label, TltlError, monitors, record, replace

_BEFORE_SNAPSHOT: Final = 20
_AFTER_SNAPSHOT: Final = 50


@record
class SceneReport:
    """What a check found out about a variant of a scene.

    ``supply`` is what the scene supplies to specs. ``steps_per_s`` is the speed of steps, with their
    signals. ``advice`` says what makes a slow game faster; empty if it is fast. ``unchanged`` are the signals that
    no step has changed. ``last_lines`` are the last lines that a game in another process wrote to standard error.
    ``reproducible`` says whether equal seeds and actions give equal signals and observations; None if the
    game was lost. ``restores`` says whether a restored snapshot brings back the state that was saved; None if the
    game has no snapshots, or was lost. ``diagnostics`` says what is wrong with the scene, whatever the spec.
    ``play`` is the longest play.
    """

    scene: str
    variant: str
    observation: spaces.Space[Any]
    action: spaces.Space[Any]
    supply: Supply
    capabilities: tuple[Capability, ...]
    steps_per_s: float
    advice: str
    unchanged: tuple[str, ...]
    last_lines: tuple[str, ...]
    reproducible: bool | None
    restores: bool | None
    diagnostics: tuple[Diagnostic, ...]
    play: ScenePlay


def check_scene(game: GameFile, scene: str, variant: str) -> SceneReport:
    """Start a variant of a scene, and play it twice with the same seed and actions.

    If a game in another process is lost, the check goes on: the next play starts the game again.

    The diagnostics of the report:

    - TLT0783, warning: the plays differ.
    - TLT0784, error: a restored snapshot is not the state that was saved.
    - TLT0784, warning: the game has only one of the methods ``tltl_snapshot`` and ``tltl_restore``.
    - TLT0785, warning: an observation is not in the observation space.
    - TLT0786, warning: no signal changes. TLT0787, warning: a script of the game fails.
    - TLT0791 to TLT0793, error: a game in another process was lost.
    - TLT0803, error: the game file names keys, but not one for each action.

    Raises:
        TltlError: the environment cannot be made, see :func:`make_base_env`; TLT0781, the game
            raises an exception, or says where things are in a way that cannot be used; the game is lost in each
            reset.
    """
    env = make_base_env(game, scene, variant)
    try:
        report = _report(game, env, scene, variant)
        is_lost = isinstance(env.unwrapped, WireEnv) and env.unwrapped.is_lost
    finally:
        env.close()
    # A game that has been closed has written all that it has to say.
    lines = env.unwrapped.last_lines() if isinstance(env.unwrapped, WireEnv) else []
    # A game that was lost has not gone on after an error in a script: the error about the loss has these lines.
    went_on = [] if is_lost else lines
    faults = silent_faults(f"{scene}:{variant}", game.labels["game"], report.play, went_on)
    return replace(report, last_lines=tuple(lines), diagnostics=(*report.diagnostics, *faults))


def _report(game: GameFile, env: SceneEnv, scene: str, variant: str) -> SceneReport:
    label, name = game.labels["game"], f"{scene}:{variant}"
    offered, actions = capabilities(env), drawn_actions(env)
    wrong_keys = [*filter(None, [key_count_diagnostic(game, scene, env.action_space)])]
    params = env.get_wrapper_attr("tltl_params")() if "params" in offered else None
    first, second = play(env, actions), play(env, actions)
    longest = first if first.steps > second.steps else second
    losses = [*_losses(name, (first, second))]
    if not longest.moments:
        raise TltlError(losses)
    differences = [*_differences(name, label, first.moments, second.moments)]
    reproducible = False if differences else None if losses else True
    restored: list[Diagnostic] = []
    is_restored = None
    try:
        _check_places(env)
        if "snapshot" in offered:
            restored += _restored(game, env, name, label, reproducible=bool(reproducible))
            is_restored = not restored
        else:
            restored += _half_snapshot(env, label)
    except WireError as error:
        losses += error.diagnostics
    clock_s, steps_per_s = _clock_s(env), longest.steps / max(longest.seconds, 1e-9)
    return SceneReport(
        scene=scene,
        variant=variant,
        observation=env.observation_space,
        action=env.action_space,
        supply=Supply(scene, longest.moments, params, clock_s),
        capabilities=offered,
        steps_per_s=steps_per_s,
        advice="" if losses else speed_advice(game.wire, steps_per_s, clock_s),
        unchanged=tuple(unchanged_signals(longest.moments)),
        last_lines=(),
        reproducible=reproducible,
        restores=is_restored,
        diagnostics=(
            *wrong_keys,
            *losses,
            *differences,
            *restored,
            *_outside_space(env.observation_space, name, label, longest.moments),
        ),
        play=longest,
    )


def _losses(name: str, plays: Sequence[ScenePlay]) -> Iterator[Diagnostic]:
    """Yield how the game was lost in the plays; once if it was lost at the same step in the same way."""
    titles = set()
    for played in plays:
        if played.loss is not None:
            when = f"in step {played.steps + 1} of a play" if played.moments else "in the reset of a play"
            title = f"{played.loss.title}, {when} of `{name}`"
            if title not in titles:
                yield replace(played.loss, title=title)
            titles.add(title)


def _check_places(env: SceneEnv) -> None:
    """Raise TltlError, TLT0781, if the game gives positions or an outline that cannot be used."""
    env.reset(seed=SEED)
    env.scene_positions()
    env.scene_outline()


def _clock_s(env: SceneEnv) -> float | None:
    return float(env.get_wrapper_attr("tltl_clock_s")) if env.has_wrapper_attr("tltl_clock_s") else None


def _differences(
    name: str, label: Label, first: Sequence[PlayedMoment], second: Sequence[PlayedMoment]
) -> Iterator[Diagnostic]:
    """Yield TLT0783 for the first signal that differs between two plays.

    Also yield it for the first observation that differs, unless a signal differs at that step or before.
    ``name`` is the scene and its variant, ``SCENE:VARIANT``.
    """
    help_ = "draw all random numbers from `self.np_random`, which `super().reset(seed=seed)` seeds"
    difference = first_difference(first, second)
    if difference is not None:
        title = f"equal seeds and actions give different plays in `{name}`: {_difference_text(difference)}"
        yield Diagnostic("TLT0783", title, (label,), help_, "warning")
    step = first_other_observation(first, second)
    if step is not None and (difference is None or step < difference.step):
        title = f"equal seeds and actions give different observations in `{name}`, first {_when(step)}"
        yield Diagnostic("TLT0783", title, (label,), help_, "warning")


def _difference_text(difference: PlayDifference) -> str:
    if not difference.name:
        return f"the episode ends {_when(difference.step)} in one play only"
    first, second = _signal_text(difference.first), _signal_text(difference.second)
    return f"`{difference.name}` is {first} in the first and {second} in the second {_when(difference.step)}"


def _signal_text(value: object) -> str:
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, float, np.number)) and not isinstance(value, np.complexfloating):
        return monitors.number_text(float(value))
    return "missing" if value is None else f"{value!r:.40}"


def _when(step: int) -> str:
    return f"at step {step}" if step else "after the reset"


def _restored(game: GameFile, env: SceneEnv, name: str, label: Label, *, reproducible: bool) -> Iterator[Diagnostic]:
    """Yield TLT0784 if ``tltl_restore`` does not bring back the state that ``tltl_snapshot`` saved.

    The signals must be the same at once. If the game is ``reproducible``, the same actions must also
    give the same signals and observations from there on.
    """
    actions = drawn_actions(env, _BEFORE_SNAPSHOT + _AFTER_SNAPSHOT, seed=SEED + 1)
    env.reset(seed=SEED + 1)
    go_on(env, actions[:_BEFORE_SNAPSHOT])
    before = PlayedMoment(0, None, dict(env.tltl_signals()), False)
    with guarded(game, RAISES, "the game's `tltl_snapshot`", label):
        snapshot = env.get_wrapper_attr("tltl_snapshot")()
    if not isinstance(snapshot, bytes):
        title = f"the game's `tltl_snapshot` returns a {type(snapshot).__name__}, not bytes"
        yield Diagnostic("TLT0784", title, (label,), "return the whole state of the game as bytes")
        return
    expected = _until_end(go_on(env, actions[_BEFORE_SNAPSHOT:]))
    with guarded(game, RAISES, "the game's `tltl_restore`", label):
        env.get_wrapper_attr("tltl_restore")(snapshot)
    help_ = "save everything that changes in an episode, also the state of `self.np_random`"
    difference = first_difference([before], [PlayedMoment(0, None, dict(env.tltl_signals()), False)])
    if difference is not None:
        title = (
            f"`tltl_restore` does not give back what `tltl_snapshot` saved in `{name}`: {_restored_text(difference)}"
        )
        yield Diagnostic("TLT0784", title, (label,), help_)
        return
    if not reproducible:
        return
    played = _until_end(go_on(env, actions[_BEFORE_SNAPSHOT:]))
    difference = first_difference(expected, played)
    step = first_other_observation(expected, played)
    if difference is not None:
        title = f"after `tltl_restore`, equal actions give another play in `{name}`: {_restored_text(difference)}"
        yield Diagnostic("TLT0784", title, (label,), help_)
    elif step is not None:
        title = (
            f"after `tltl_restore`, equal actions give other observations in `{name}`, first after {_steps_text(step)}"
        )
        yield Diagnostic("TLT0784", title, (label,), help_)


def _half_snapshot(env: SceneEnv, label: Label) -> Iterator[Diagnostic]:
    """Yield TLT0784, a warning, if the game can save its state but not restore it, or the other way round."""
    there = [name for name in ATTRIBUTES["snapshot"] if env.has_wrapper_attr(name)]
    for missing in set(ATTRIBUTES["snapshot"]) - set(there) if there else ():
        title = f"the game has `{there[0]}`, but no `{missing}`, so its state cannot be restored"
        yield Diagnostic("TLT0784", title, (label,), f"add `{missing}`, or remove `{there[0]}`", "warning")


def _restored_text(difference: PlayDifference) -> str:
    after = f" after {_steps_text(difference.step)}" if difference.step else ""
    if not difference.name:
        return f"the episode ends{after} in one play only"
    first, second = _signal_text(difference.first), _signal_text(difference.second)
    return f"`{difference.name}` was {first}, and is {second}{after}"


def _steps_text(steps: int) -> str:
    return f"{steps} step{'' if steps == 1 else 's'}"


def _until_end(moments: Sequence[PlayedMoment]) -> list[PlayedMoment]:
    """Return the moments up to the first end of an episode; a snapshot need not determine later episodes."""
    end = next((index for index, moment in enumerate(moments) if moment.ended), len(moments))
    return list(moments[: end + 1])


def _outside_space(
    space: spaces.Space[Any], name: str, label: Label, moments: Sequence[PlayedMoment]
) -> Iterator[Diagnostic]:
    """Yield TLT0785 for the first observation that is not in the observation space."""
    for moment in moments:
        if not space.contains(moment.observation):
            part, value = _outside_part(space, moment.observation)
            title = f"{part} in `{name}` is not in the observation space {_when(moment.step)}: {value}"
            help_ = "give the space the shape, type and bounds of the observations, or convert these"
            yield Diagnostic("TLT0785", title, (label,), help_, "warning")
            return


def _outside_part(space: spaces.Space[Any], observation: Any) -> tuple[str, str]:
    """Return the part of an observation that is not in its space, and what is wrong with it, as texts.

    For example, ``("the observation's `image`", "it is missing")``.
    """
    if isinstance(space, spaces.Dict) and isinstance(observation, Mapping):
        for key, part in space.spaces.items():
            if key not in observation:
                return f"the observation's `{key}`", "it is missing"
            if not part.contains(observation[key]):
                return f"the observation's `{key}`", _value_text(observation[key])
        others = [key for key in observation if key not in space.spaces]
        return "the observation", f"the space has no key `{others[0]}`" if others else "its keys differ"
    return "the observation", _value_text(observation)


def _value_text(value: Any) -> str:
    """Describe a value: the type, shape and bounds of an array, the type and value of anything else."""
    if isinstance(value, np.ndarray) and value.size:
        bounds = f" and values from {value.min()} to {value.max()}" if value.dtype.kind in "iufb" else ""
        return f"it has shape {value.shape}, type {value.dtype}{bounds}"
    return f"it is {value!r:.40}, of type {type(value).__name__}"
