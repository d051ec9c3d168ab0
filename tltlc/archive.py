"""Unpack archives: write files under paths that somebody else chose, and never outside the folder for them."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.files import reason


def unpack(folder: Path, files: Iterable[tuple[str, bytes]], source: str) -> None:
    """Write files into a folder that exists, each at its path below it, with ``/`` between the parts.

    ``source`` is what messages call the archive.

    Raises:
        TltlError: TLT0009, a path leads out of the folder, or two paths cannot both be there; TLT0005, the system
            refuses to write.
    """
    for name, content in files:
        path = inside(folder, name, source)
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            # Two entries of one name, or a file and a folder of one name, are no archive of ours.
            with path.open("xb") as file:
                file.write(content)
        except (FileExistsError, NotADirectoryError, IsADirectoryError):
            title = f"{source} holds two entries for `{name}`"
            raise TltlError([Diagnostic("TLT0009", title, help="make it again from files that are there")]) from None
        except (OSError, ValueError) as error:
            title = f"cannot write `{name}` of {source}: {reason(error)}"
            raise TltlError([Diagnostic("TLT0005", title, help="check the space and the permissions")]) from None


def inside(folder: Path, name: str, source: str) -> Path:
    """The place of an archive's path below a folder; raises TltlError, TLT0009, where it leads out of it."""
    parts = name.split("/")
    is_plain = not any(part in ("", ".", "..") or "\0" in part for part in parts)
    # Windows has more ways to write a path, and names that mean devices.
    is_foreign = os.name == "nt" and any(character in name for character in '\\:*?"<>|')
    path = folder.joinpath(*parts) if is_plain and not is_foreign else folder
    if path == folder or not Path(os.path.realpath(path.parent)).is_relative_to(os.path.realpath(folder)):
        title = f"{source} holds the path `{name}`, which leads out of its folder"
        raise TltlError([Diagnostic("TLT0009", title, help="do not use it: no tool makes such a path by mistake")])
    return path
