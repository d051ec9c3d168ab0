"""A game in another process as a Gymnasium environment."""

from __future__ import annotations

import json
import secrets
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, Final

import gymnasium
import numpy as np
from gymnasium.error import ResetNeeded
from numpy.typing import NDArray

from tltl_runtime.wire import answers, hello
from tltl_runtime.wire.answers import GameState, Position, StateReader
from tltl_runtime.wire.hello import Hello
from tltl_runtime.wire.outline import outline_from
from tltl_runtime.wire.requests import (
    OutlineRequest,
    ReleaseRequest,
    ResetRequest,
    RestoreRequest,
    ScreenshotRequest,
    SnapshotRequest,
    StepRequest,
)
from tltl_runtime.wire.session import Answer, WireSession
from tltl_runtime.wire.values import value_writer
from tltl_runtime.wire.wire_game import WireGame

_SEEDS: Final = 2**31
_LARGEST_SEED: Final = 2**53
"""Seeds from here on are not exact in languages whose numbers are all floats."""

_METHODS: Final = {
    "tltl_positions": (hello.POSITIONS, "_positions"),
    "tltl_outline": (hello.OUTLINE, "_outline"),
    "tltl_snapshot": (hello.SNAPSHOT, "_snapshot"),
    "tltl_restore": (hello.SNAPSHOT, "_restore"),
    "tltl_release": (hello.RELEASE, "_release"),
}
"""For each optional method, the capability that it needs, and the method that does the work."""


class UnknownSceneError(ValueError):
    """Raised for the name of a scene that a game does not have; ``scenes`` are the names of those that it has."""

    def __init__(self, game: str, scene: str, scenes: tuple[str, ...]) -> None:
        super().__init__(f"the game `{game}` has no scene `{scene}`; it has {', '.join(scenes)}")
        self.scenes = scenes


class NoPicturesError(ValueError):
    """Raised for a ``render_mode`` that a game does not have."""


class WireEnv(gymnasium.Env[Any, Any]):
    """A game that speaks the protocol ``tltl/1``; ``game`` says how it is started or found.

    An episode begins in ``scene`` and ``variant``; ``options["scene"]`` and ``options["variant"]`` of
    :meth:`reset` take their place for one episode. The default scene is the game's first one. A
    step plays ``repeat`` ticks of the game with the same action. The reward of a step is 0, because
    rewards come from a spec: wrap the environment in :class:`~tltl_runtime.spec.wrapper.TltlEnv`.

    The environment has these attributes only if the ``hello`` of the game, its first message, declares
    them:

    - ``tltl_clock_s``: the seconds of a step;
    - ``tltl_params``: returns the values that the game gives to the params of specs;
    - ``tltl_positions``: returns the positions of the entities, in metres, by name;
    - ``tltl_outline``: asks the game what maps of the current scene and variant are drawn on, and returns it;
    - ``tltl_snapshot`` and ``tltl_restore``: keep the state of the game, and return to it. A snapshot is
      the id of a state that the game keeps, as bytes; it is valid until it is released, or the game ends;
    - ``tltl_release``: lets a snapshot go, so that the game need not keep it.

    With ``render_mode="rgb_array"``, which the capability ``screenshot`` allows, :meth:`render`
    returns a picture, (height, width, 3).

    If the game hangs, ends, reports an error or breaks the protocol, a method raises
    :class:`~tltl_runtime.wire.errors.WireError`, and the game is ended with its child processes. The
    next :meth:`reset` starts the game again, so only one episode is lost.

    Raises:
        WireError: the game does not start, or its ``hello`` is wrong.
        TltlError: TLT0803, ``game.connect`` is no address.
        UnknownSceneError: there is no such scene.
        NoPicturesError: the game cannot render.
        ValueError: ``repeat`` is below 1.
    """

    tltl_clock_s: float
    tltl_params: Callable[[], dict[str, float]]
    tltl_positions: Callable[[], Mapping[str, Position]]
    tltl_outline: Callable[[], dict[str, Any]]
    tltl_snapshot: Callable[[], bytes]
    tltl_restore: Callable[[bytes], None]
    tltl_release: Callable[[bytes], None]

    def __init__(
        self,
        game: WireGame,
        *,
        scene: str | None = None,
        variant: str = "v0",
        repeat: int = 1,
        render_mode: str | None = None,
    ) -> None:
        if repeat < 1:
            raise ValueError(f"`repeat` must be at least 1, not {repeat}")
        self._game, self._variant, self._repeat = game, variant, repeat
        self._session = WireSession(game)
        self._session_name = secrets.token_hex(8)
        self._state: GameState | None = None
        self.hello = self._session.hello
        try:
            self._scene = self._known_scene(scene)
            self.metadata = {"render_modes": [], "render_fps": self.hello.clock_hz or 30}
            if hello.SCREENSHOT in self.hello.capabilities:
                self.metadata["render_modes"] = ["rgb_array"]
            if render_mode is not None and render_mode not in self.metadata["render_modes"]:
                raise NoPicturesError(f"the game `{game.name}` cannot render `{render_mode}`")
        except ValueError:
            self._session.close()
            raise
        self.render_mode = render_mode
        self.action_space, self.observation_space = self.hello.actions, self.hello.observation
        self._reader = StateReader(self.hello)
        self._write_action = value_writer(self.action_space)
        if self.hello.clock_hz is not None:
            self.tltl_clock_s = repeat / self.hello.clock_hz
        if params := self.hello.params:
            self.tltl_params = lambda: dict(params)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Begin an episode; start the game again if it was lost.

        Raises:
            WireError: the game does not start, is lost, or has no such scene or variant.
            UnknownSceneError: there is no such scene.
            ValueError: the seed is 2^53 or greater.
        """
        super().reset(seed=seed)
        if seed is not None and seed >= _LARGEST_SEED:
            raise ValueError(f"the seed of a game must be less than 2^53, not {seed}")
        options = options or {}
        scene = self._known_scene(options["scene"]) if "scene" in options else self._scene
        if self._session.is_over:
            self._restart()
        takes_seeds = hello.SEED in self.hello.capabilities
        chosen = (int(self.np_random.integers(_SEEDS)) if seed is None else int(seed)) if takes_seeds else None
        self._state = None
        request = ResetRequest(scene, options.get("variant", self._variant), chosen)
        self._state = self._session.ask("reset", request.message(), self._reader.read)
        return self._state.observation, {}

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Play the ticks of one step; the reward is 0, and the episode is never truncated.

        Raises:
            WireError: the game is lost, breaks the protocol, or reports an error.
            ResetNeeded: there is no episode, or it has ended.
            ValueError: the action is not in the action space.
        """
        if self._state is None or self._state.ended:
            raise ResetNeeded("there is no episode to continue: reset first")
        request = StepRequest(self._write_action(action), self._repeat).message()
        self._state = None
        self._state = state = self._session.ask("step", request, self._reader.read)
        return state.observation, 0.0, state.ended, False, {}

    def render(self) -> NDArray[np.uint8] | None:
        """Return a picture of the game, (height, width, 3); None without a ``render_mode``.

        Raises:
            WireError: the game is lost, breaks the protocol, or reports an error.
            ResetNeeded: there is no episode.
        """
        if self.render_mode is None:
            return None
        return self._ask_beside("screenshot", ScreenshotRequest().message(), answers.screenshot)

    def close(self) -> None:
        """End the game."""
        self._session.close()
        self._state = None

    def last_lines(self) -> list[str]:
        """Return the last lines that the game wrote to standard error, those that help to mend it. Close it before."""
        return self._session.last_lines()

    def tltl_signals(self) -> Mapping[str, float]:
        """Return the signals after the last reset or step, by name and in SI units."""
        return self._current().signals

    @property
    def game(self) -> WireGame:
        """How the game is started or found, and its deadlines."""
        return self._game

    @property
    def observation(self) -> Any:
        """The observation after the last reset or step."""
        return self._current().observation

    def tltl_cause(self) -> str | None:
        """Return who or what ended the episode; None if it has not ended, or the game does not say."""
        state = self._current()
        return state.cause if state.ended else None

    @property
    def is_lost(self) -> bool:
        """Whether the game has ended, and no reset has started it again."""
        return self._session.is_over

    @property
    def process_id(self) -> int | None:
        """The id of the process that supervises the game; None for a game that was already running."""
        return self._session.process_id

    def __getattr__(self, name: str) -> Any:
        """Return a method that the environment has only if the game has the capability for it.

        Methods in attributes of the instance would make a cycle of references, so the game would outlive
        the last reference to the environment.
        """
        capability, method = _METHODS.get(name, ("", ""))
        if capability and "hello" in self.__dict__ and capability in self.hello.capabilities:
            return getattr(self, method)
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}", name=name, obj=self)

    def _positions(self) -> Mapping[str, Position]:
        return self._current().positions

    def _outline(self) -> dict[str, Any]:
        return self._ask_beside("outline", OutlineRequest().message(), outline_from)

    def _snapshot(self) -> bytes:
        kept = self._ask_beside("snapshot", SnapshotRequest().message(), answers.snapshot_id)
        return json.dumps({"session": self._session_name, "id": kept}).encode()

    def _restore(self, snapshot: bytes) -> None:
        """Return to a snapshot; raises ValueError if the game that took the snapshot has ended."""
        document = json.loads(snapshot)
        if self._session.is_over or document["session"] != self._session_name:
            raise ValueError("the game that took this snapshot has ended")
        self._state = None
        request = RestoreRequest(document["id"]).message()
        self._state = self._session.ask("restore", request, self._reader.read)

    def _release(self, snapshot: bytes) -> None:
        """Let a snapshot go; do nothing if the game that took it has ended. Raises WireError if the game is lost."""
        document = json.loads(snapshot)
        if self._session.is_over or document["session"] != self._session_name:
            return
        state, self._state = self._state, None
        kept = document["id"]
        self._session.ask("release", ReleaseRequest(kept).message(), partial(answers.released, kept=kept))
        self._state = state

    def _ask_beside(self, kind: str, message: dict[str, Any], read: Callable[[Any], Answer]) -> Answer:
        """Send a request that does not change the state, and return what ``read`` makes of the answer.

        If the game is lost, there is no state any more. Raises WireError, and ResetNeeded if there is no episode.
        """
        state, self._state = self._current(), None
        answer = self._session.ask(kind, message, read)
        self._state = state
        return answer

    def _current(self) -> GameState:
        if self._state is None:
            raise ResetNeeded("there is no episode: reset first")
        return self._state

    def _known_scene(self, scene: str | None) -> str | None:
        scenes = self.hello.scenes
        if scene is None:
            return scenes[0] if scenes else None
        if scenes and scene not in scenes:
            raise UnknownSceneError(self._game.name, scene, tuple(scenes))
        return scene

    def _restart(self) -> None:
        """Start the game again; raises WireError unless it declares the same in its ``hello`` as before."""
        session = WireSession(self._game)
        if not _same(session.hello, self.hello):
            session.refuse("declares other signals, spaces or capabilities than when it was first started")
        self._session, self._session_name = session, secrets.token_hex(8)


def _same(one: Hello, other: Hello) -> bool:
    return all(
        getattr(one, name) == getattr(other, name)
        for name in ("signals", "params", "actions", "observation", "scenes", "capabilities", "clock_hz")
    )
