"""The properties that the levels of all games have."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from tltl_runtime.game.geometry import Box, Region
from tltl_runtime.game.sensors import Sensors
from tltlc.api import Diagnostic, TltlError, record

if TYPE_CHECKING:
    from tltl_runtime.game.game import Game


@record
class LevelSpec:
    """The spec that a level is made for: the spec called ``name`` in ``file``.

    ``name`` is empty if only the file is known. In a recorded level, ``file`` has no folder.
    """

    file: Path
    name: str

    @property
    def text(self) -> str:
        """The spec as the argument ``FILE.tltl:NAME`` of commands and functions."""
        return f"{self.file}:{self.name}" if self.name else str(self.file)


def parse_level_spec(text: str) -> LevelSpec | None:
    """Parse ``FILE.tltl:NAME`` or ``FILE.tltl``, as level files and recordings name a spec.

    Return None for an empty text.
    """
    file, colon, name = text.rpartition(":")
    if not text:
        return None
    return LevelSpec(Path(file), name) if colon else LevelSpec(Path(text), "")


class Level(Protocol):
    """A level in one of its variants, loaded and ready to be played."""

    @property
    def game(self) -> Game[Any, Any]:
        """The game that the level belongs to."""

    @property
    def name(self) -> str:
        """The name of the level."""

    @property
    def variant(self) -> str:
        """The name of the variant, and the names of overlays added to it: ``v0`` or ``v0+OVERLAY``."""

    @property
    def spec(self) -> LevelSpec | None:
        """The spec that the level is made for; None if there is none."""

    @property
    def sensors(self) -> Sensors:
        """The sensors that an agent has by default."""

    @property
    def files(self) -> tuple[tuple[str, str], ...]:
        """The name and the SHA-256, in hexadecimal, of each file that the level was read from."""

    @property
    def bounds(self) -> Box | None:
        """The box that encloses everything in the level; None if the game does not say."""

    @property
    def regions(self) -> tuple[Region, ...]:
        """The named parts of the level. Where regions overlap, a place has the name of the first one."""


@record
class UnreachableEntity:
    """An entity of a spec that no player can reach.

    ``diagnostic`` says so and explains why. ``obstacles`` are the things that the explanation names.
    """

    name: str
    obstacles: tuple[str, ...]
    diagnostic: Diagnostic


def default_spec(level: Level) -> str:
    """Return the spec that a level is made for, as the argument ``FILE.tltl:NAME``.

    Raises:
        TltlError: TLT0721, the level is made for no spec.
    """
    if level.spec is None:
        title, help_ = f"the level `{level.name}` does not name a spec", "name one: `FILE.tltl:NAME`"
        raise TltlError([Diagnostic("TLT0721", title, help=help_)])
    return level.spec.text
