"""The messages that tltlc sends to a game."""

from __future__ import annotations

from typing import Any

from tltlc.api import record


@record
class ResetRequest:
    """Begin an episode.

    ``scene`` and ``seed`` are None if the game has no scenes or takes no seeds. The answer is a ``state``.
    """

    scene: str | None
    variant: str
    seed: int | None

    def message(self) -> dict[str, Any]:
        """Return the request as a value of JSON."""
        parts = {"scene": self.scene, "variant": self.variant, "seed": self.seed}
        return {"reset": {key: value for key, value in parts.items() if value is not None}}


@record
class StepRequest:
    """Play ``repeat`` ticks with the same action, fewer if the episode ends; the answer is a ``state``."""

    action: Any
    repeat: int = 1

    def message(self) -> dict[str, Any]:
        """Return the request as a value of JSON."""
        if self.repeat == 1:
            return {"step": {"action": self.action}}
        return {"step": {"action": self.action, "repeat": self.repeat}}


@record
class SnapshotRequest:
    """Keep the whole state of the game; the answer is a ``snapshot`` with an id."""

    def message(self) -> dict[str, Any]:
        """Return the request as a value of JSON."""
        return {"snapshot": {}}


@record
class RestoreRequest:
    """Return to the state of a snapshot; the answer is that ``state``."""

    id: int | str

    def message(self) -> dict[str, Any]:
        """Return the request as a value of JSON."""
        return {"restore": {"id": self.id}}


@record
class ReleaseRequest:
    """Let a snapshot go, to which no restore will return; the answer is a ``release`` with its id."""

    id: int | str

    def message(self) -> dict[str, Any]:
        """Return the request as a value of JSON."""
        return {"release": {"id": self.id}}


@record
class ScreenshotRequest:
    """Draw the game; the answer is a ``screenshot`` with an array."""

    def message(self) -> dict[str, Any]:
        """Return the request as a value of JSON."""
        return {"screenshot": {}}


@record
class OutlineRequest:
    """Say what maps of this scene and variant are drawn on; the answer is an ``outline``."""

    def message(self) -> dict[str, Any]:
        """Return the request as a value of JSON."""
        return {"outline": {}}


@record
class Refusal:
    """Refuse the ``hello`` of a game; ``reason`` completes "because it …". The game ends without an answer."""

    reason: str

    def message(self) -> dict[str, Any]:
        """Return the message as a value of JSON."""
        return {"error": {"message": f"tltlc refuses this game, because it {self.reason}"}}


@record
class CloseRequest:
    """End; the game does not answer."""

    def message(self) -> dict[str, Any]:
        """Return the request as a value of JSON."""
        return {"close": {}}
