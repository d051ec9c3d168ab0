"""The check of a level against specs, for ``tltlc check --level``."""

from __future__ import annotations

from abc import ABC, abstractmethod

from tltlc.api import Diagnostic, Fspa, Spec, record


@record
class SensedPart:
    """A part of an agent's observation: its ``key``, its ``shape``, and the ``names`` of what it shows."""

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
        """Return what a spec needs and the level lacks, and what of the spec nobody can do.

        ``spec``, from which ``fspa`` was made, gives the places in its source; None if it has none.
        """

    @abstractmethod
    def supplied(self, fspa: Fspa) -> tuple[str, ...]:
        """Return what the level supplies to a spec, for people: ``s1``, ``reach = 1.5 m``."""

    @abstractmethod
    def picture(self) -> bytes:
        """Draw the level as a PNG, with red where nobody can stand."""
