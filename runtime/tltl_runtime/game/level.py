"""What every game says about a level."""

from __future__ import annotations

from typing import Protocol

from tltl_runtime.game.geometry import Box, Region
from tltl_runtime.game.sensors import Sensors
from tltlc.api import Diagnostic, TltlError


class Level(Protocol):
    """One variant of a level."""

    @property
    def name(self) -> str:
        """The name of the level."""

    @property
    def variant(self) -> str:
        """The name of the variant, with those of its added overlays."""

    @property
    def spec(self) -> str:
        """The spec that the level is made for, as ``FILE.tltl:NAME``; empty if there is none."""

    @property
    def sensors(self) -> Sensors:
        """The sensors that an agent has by default."""

    @property
    def files(self) -> tuple[tuple[str, str], ...]:
        """The names of the files that the level was read from, with their SHA-256 in hexadecimal."""

    @property
    def bounds(self) -> Box:
        """The box that encloses everything."""

    @property
    def regions(self) -> tuple[Region, ...]:
        """The named parts of the level.  Where they overlap, the first one gives a place its name."""


def spec_of(level: Level) -> str:
    """Return the path of a level's default spec; raises TltlError, TLT0721, if it has none."""
    if not level.spec:
        title, help_ = f"the level `{level.name}` is made for no spec", "say which one: `FILE.tltl:NAME`"
        raise TltlError([Diagnostic("TLT0721", title, help=help_)])
    return level.spec
