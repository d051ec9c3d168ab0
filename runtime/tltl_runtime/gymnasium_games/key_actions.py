"""Which keys of the keyboard choose which actions of a scene."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from enum import EnumMeta
from math import isfinite
from textwrap import wrap
from typing import Any, Final

import gymnasium
from gymnasium import spaces

from tltl_runtime.game.capability_error import capability_error
from tltl_runtime.game.hud import LONG
from tltl_runtime.game.level import Level
from tltl_runtime.game.window import Key
from tltl_runtime.gymnasium_games.game_errors import RAISES, guarded
from tltl_runtime.gymnasium_games.game_file import GameFile
from tltl_runtime.gymnasium_games.key_names import named_key
from tltl_runtime.gymnasium_games.space_text import space_text
from tltlc.api import Diagnostic, TltlError, record

_DIGITS: Final = "123456789"
_USUAL_STEP_S: Final = 0.1


@record
class KeyActions:
    """The action of each combination of keys.

    ``idle`` is the action while no key is held, or None. If there is such an action, the game runs in
    real time: a step takes ``step_s`` seconds, and the keys that are held choose its action. If there is
    none, the game waits for keys, and each press of a key is a step. ``lines`` say which key does what.
    """

    actions: Mapping[frozenset[Key], int]
    idle: int | None
    step_s: float
    lines: tuple[str, ...]

    @property
    def keys(self) -> frozenset[Key]:
        """All keys that belong to actions."""
        return frozenset().union(*self.actions)

    def of_held(self, held: Collection[Key]) -> int:
        """Return the action of the largest combination of keys that is held; ``idle`` if there is none."""
        assert self.idle is not None
        possible = [keys for keys in self.actions if keys <= frozenset(held)]
        return self.actions[max(possible, key=len)] if possible else self.idle


def key_actions(env: gymnasium.Env[Any, Any], level: Level) -> KeyActions:
    """Return the keys for the actions of ``env``, an environment of the scene ``level``.

    They are the keys that the game file names; if it names none, those of the environment's method
    ``get_keys_to_action``; without this method, the digits from 1.

    Raises:
        TltlError: TLT0731, keys cannot choose an action; TLT0803, the game file names more or fewer
            keys than there are actions; TLT0781, ``get_keys_to_action`` raises an exception or names a
            wrong action.
    """
    space = env.action_space
    if not isinstance(space, spaces.Discrete):
        lack = f"has no actions that keys can choose: an action is {space_text(space)}, and keys need a Discrete space"
        raise capability_error(level, lack, "let a trained policy play: `tltlc evaluate POLICY --record all --out DIR`")
    game: GameFile = env.get_wrapper_attr("game_file")
    if game.keys:
        wrong_count = key_count_diagnostic(game, level.name, space)
        if wrong_count:
            raise TltlError([wrong_count])
        return _one_by_one(env, space, game.keys)
    own = _own_keys(env, space, game)
    if own:
        return own
    if space.n > len(_DIGITS):
        lack = f"has {space.n} actions, too many for the digits 1 to 9"
        raise capability_error(level, lack, 'name a key for each action in the game file: `keys = ["left", …]`')
    return _one_by_one(env, space, tuple(_DIGITS[: space.n]))


def key_count_diagnostic(game: GameFile, scene: str, space: spaces.Space[Any]) -> Diagnostic | None:
    """Return the error TLT0803 if a game file names keys, but not one for each action of a scene; else None."""
    if not game.keys or (isinstance(space, spaces.Discrete) and len(game.keys) == space.n):
        return None
    count = f"{len(game.keys)} key{'s' * (len(game.keys) != 1)}"
    title = f"`keys` has {count}, but an action of the scene `{scene}` is {space_text(space)}"
    help_ = "leave out `keys`: only a Discrete space has actions for keys"
    if isinstance(space, spaces.Discrete):
        help_ = f"name {space.n} keys, one for each action, in the order of the actions"
    return Diagnostic("TLT0803", title, (game.labels["keys"],), help_)


def _one_by_one(env: gymnasium.Env[Any, Any], space: spaces.Discrete, keys: tuple[str, ...]) -> KeyActions:
    """Return the actions of a game that waits for keys: the first key chooses the first action, and so on."""
    actions: dict[frozenset[Key], int] = {frozenset([key]): int(space.start) + i for i, key in enumerate(keys)}
    return KeyActions(actions, None, step_seconds(env), _lines(env, space, actions))


def _own_keys(env: gymnasium.Env[Any, Any], space: spaces.Discrete, game: GameFile) -> KeyActions | None:
    """Return the keys that an environment's ``get_keys_to_action`` names; None if it names none."""
    if not env.has_wrapper_attr("get_keys_to_action"):
        return None
    label, what = game.labels["game"], "the game's `get_keys_to_action`"
    with guarded(game, RAISES, what, label):
        mapping = env.get_wrapper_attr("get_keys_to_action")()
        combinations = {_combination(keys): int(action) for keys, action in mapping.items()}
    wrong = [action for action in combinations.values() if not space.contains(action)]
    if wrong:
        title = f"{what} names the action {wrong[0]}, which is not in {space_text(space)}"
        raise TltlError([Diagnostic(RAISES, title, (label,), "give each combination of keys an action of the space")])
    idle = combinations.pop(frozenset(), int(space.start))
    if not combinations:
        return None
    return KeyActions(combinations, idle, step_seconds(env), _lines(env, space, combinations))


def _combination(keys: object) -> frozenset[Key]:
    """Return the keys of a combination that an environment names.

    As in Gymnasium, ``keys`` is a number, a text of characters, or a list or tuple of keys.
    """
    return frozenset(map(named_key, keys)) if isinstance(keys, (tuple, list, str)) else frozenset([named_key(keys)])  # type: ignore[arg-type]


def step_seconds(env: gymnasium.Env[Any, Any]) -> float:
    """Return the length of a step in seconds, for a game that runs in real time.

    This is the game's clock; without a clock, the time of a frame; without both, 0.1.
    """
    if env.has_wrapper_attr("tltl_clock_s"):
        return float(env.get_wrapper_attr("tltl_clock_s"))
    rate = (env.metadata or {}).get("render_fps")
    return 1.0 / rate if isinstance(rate, (int, float)) and isfinite(rate) and rate > 0 else _USUAL_STEP_S


def _lines(
    env: gymnasium.Env[Any, Any], space: spaces.Discrete, actions: Mapping[frozenset[Key], int]
) -> tuple[str, ...]:
    names = _action_names(env, space)
    texts = []
    for keys, action in actions.items():
        held = "+".join(sorted(key if isinstance(key, str) else f"key {key}" for key in keys))
        texts.append(f"{held}: {names[action - int(space.start)]}")
    # No-break spaces keep a key and its action in one line.
    joined = "   ".join(text.replace(" ", "\N{NO-BREAK SPACE}") for text in texts)
    return tuple(line.replace("\N{NO-BREAK SPACE}", " ") for line in wrap(joined, LONG))


def _action_names(env: gymnasium.Env[Any, Any], space: spaces.Discrete) -> list[str]:
    """Return a name for each action: the environment's own, or ``action N`` if it does not name each action."""
    names: list[str] = []
    if env.has_wrapper_attr("get_action_meanings"):
        names = [str(name).lower() for name in env.get_wrapper_attr("get_action_meanings")()]
    elif isinstance(members := getattr(env.unwrapped, "actions", None), EnumMeta):
        names = [str(name) for name in members.__members__]
    return names if len(names) == space.n else [f"action {space.start + number}" for number in range(int(space.n))]
