"""The check of a level against specs, for ``tltlc check --level``."""

from __future__ import annotations

from abc import ABC, abstractmethod

from tltlc.api import Diagnostic, Fspa, Spec, record


@record
class SensedPart:
    """A part of an agent's observation, a Dict: its ``key``, its ``shape``, and the ``names`` of what it shows."""

    key: str
    shape: tuple[int, ...]
    names: tuple[str, ...]


class LevelCheck(ABC):
    """One variant of a level, read and searched, so that it can be checked against specs."""

    name: str
    """The name of the level."""

    spec: str | None
    """The spec that the level is made for, as the argument ``FILE.tltl:NAME``; None if there is none."""

    warnings: tuple[Diagnostic, ...]
    """The warnings about the level itself, whatever the spec."""

    sensed: tuple[SensedPart, ...]
    """The parts of an agent's observation that depend on the level."""

    @abstractmethod
    def diagnostics(self, fspa: Fspa, spec: Spec | None) -> list[Diagnostic]:
        """Return diagnostics for what a spec needs and the level lacks, and for goals that nobody can reach.

        ``spec`` is the source of ``fspa``, into which the diagnostics point; None if there is no source.
        """

    @abstractmethod
    def supplied(self, fspa: Fspa) -> tuple[str, ...]:
        """Return texts that say what the level supplies to a spec, such as ``s1`` and ``reach = 1.5 m``."""

    @abstractmethod
    def picture(self) -> bytes:
        """Draw the level as a PNG, with red where nobody can stand."""
