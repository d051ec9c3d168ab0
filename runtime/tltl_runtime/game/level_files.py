"""The files of a game's levels."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from pathlib import Path, PurePosixPath
from typing import Final, Generic, Literal, TypeVar

from tltl_runtime.game.level import Level
from tltl_runtime.game.level_name import Variant

LevelT = TypeVar("LevelT", bound=Level)
FileKind = Literal["level", "asset", "overlay"]
"""What a file of a level is: its own file, an asset that levels may share, or an overlay that changes assets."""

_FOLDERS: Final[dict[FileKind, str]] = {"level": "", "asset": "assets", "overlay": "overlays"}


def listed_name(kind: FileKind, file_name: str) -> str:
    """Return the name of a level's file as ``Level.files`` lists it, for example ``assets/guard.toml``."""
    return str(PurePosixPath(_FOLDERS[kind], file_name))


def file_kind(name: str) -> FileKind:
    """Return the kind of a level's file, given its listed name: ``assets/guard.toml`` is an asset."""
    folders = PurePosixPath(name).parts[:-1]
    return next((kind for kind, folder in _FOLDERS.items() if folders == (folder,)), "level")


class LevelFiles(ABC, Generic[LevelT]):
    """Finds and reads the files of levels.

    In all methods, ``name`` is the name of a level that comes with the game, or the path of a file.
    """

    @abstractmethod
    def names(self) -> tuple[str, ...]:
        """Return the names of the levels that come with the game."""

    @abstractmethod
    def path(self, name: str) -> Path:
        """Return the path of a level's file, which may not exist.

        Raises:
            TltlError: TLT0800, no level of the game has that name.
        """

    def level_name(self, name: str) -> str:
        """Return ``Level.name`` of a level, even if its file has errors or does not exist.

        Raises:
            TltlError: TLT0800, no level of the game has that name.
        """
        return self.path(name).stem

    @abstractmethod
    def variants(self, name: str) -> tuple[str, ...]:
        """Return the variants of a level, in the order of its file; raises the errors of loading it."""

    @abstractmethod
    def overlays(self, name: str) -> tuple[str, ...]:
        """Return the names of the overlays that can be added to the variants of a level."""

    @abstractmethod
    def load_with_changes(self, name: str, variant: Variant) -> tuple[LevelT, tuple[str, ...]]:
        """Load a level in one of its variants; also return descriptions of what the variant's overlays change.

        Raises:
            TltlError: there is no such level or variant, or its file is invalid.
        """

    def description(self, name: str, variant: Variant) -> str:
        """Say what the overlays of a variant change in the level.

        The text is empty if there are no overlays, or a game describes the level instead. Raises the
        errors of :meth:`load_with_changes`.
        """
        return " ".join(self.load_with_changes(name, variant)[1])

    @abstractmethod
    def dependencies(self, name: str, variant: Variant) -> Iterator[Path]:
        """Yield the paths of the files that a level depends on, among them its spec.

        If a file has errors, use what can be read of it. Also yield the paths where a new file would take
        precedence over an existing one.
        """

    @abstractmethod
    def candidates(self, name: str, variant: Variant, file_name: str) -> Iterator[Path]:
        """Yield the paths at which a file of a level may be; the first path with a file is the one that is read.

        ``file_name`` is the name of the file in ``Level.files``, such as ``assets/guard.toml``.
        """
