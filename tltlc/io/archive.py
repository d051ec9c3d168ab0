"""Unpack archives safely: no path in an archive can make a file outside the target folder."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Final
from unicodedata import normalize

from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.io.files import reason
from tltlc.io.limits import UNPACKED_NAME, UNPACKED_PATH

_IS_WINDOWS: Final = os.name == "nt"
_DEVICES: Final = {
    *("con", "prn", "aux", "nul", "conin$", "conout$"),
    *(f"{port}{digit}" for port in ("com", "lpt") for digit in "0123456789¹²³"),
}
"""The names of devices on Windows, in lower case.

With an extension such as `.txt`, they are still the device.
"""


@record
class Archive:
    """Texts for error messages about an archive.

    ``name`` is the name of the archive. ``damaged_help`` is the help if the archive is damaged or
    was made by hand, ``elsewhere_help`` the help if the archive is valid but this system cannot
    store its files.
    """

    name: str
    damaged_help: str
    elsewhere_help: str


def unpack(folder: Path, files: Iterable[tuple[str, bytes]], archive: Archive) -> None:
    """Write the files of an archive into a folder that exists.

    ``files`` are pairs of a path, relative to the folder and with ``/`` between its parts, and the
    content of the file.

    Raises:
        TltlError: TLT0009 if a path leads out of the folder, is too long, or is not valid on this
            system, or if two paths cannot both exist; TLT0005 if the system refuses to write.
    """
    written: list[str] = []
    for name, content in files:
        path = entry_path(folder, name, archive)
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            # No archive that tltlc makes has two entries of one name, or a file and a folder of one name.
            with path.open("xb") as file:
                file.write(content)
        except (FileExistsError, NotADirectoryError, IsADirectoryError):
            raise _clash_error(name, written, archive) from None
        except (OSError, ValueError) as error:
            title = f"cannot write `{name}` from {archive.name}: {reason(error)}"
            raise TltlError([Diagnostic("TLT0005", title, help="check the free space and the permissions")]) from None
        written.append(name)


def entry_path(folder: Path, name: str, archive: Archive) -> Path:
    """Return the path in ``folder`` at which the entry ``name`` of an archive is unpacked.

    Raises:
        TltlError: TLT0009 the path leads out of the folder, is too long, or is not valid on this
            system.
    """
    check_extent(name, archive)
    parts = name.split("/")
    if _IS_WINDOWS and any(map(_is_invalid_on_windows, parts)):
        raise _archive_error(
            f"{archive.name} contains the path `{name}`, which cannot be a file on Windows", archive.elsewhere_help
        )
    is_plain = not any(part in ("", ".", "..") or "\0" in part for part in parts)
    path = folder.joinpath(*parts) if is_plain else folder
    if path == folder or not Path(os.path.realpath(path.parent)).is_relative_to(os.path.realpath(folder)):
        raise _archive_error(
            f"{archive.name} contains the path `{name}`, which leads out of its folder", archive.damaged_help
        )
    return path


def check_extent(name: str, archive: Archive) -> None:
    """Check the length of a path in an archive.

    Raises:
        TltlError: TLT0009 the path has more bytes or parts than
            :data:`tltlc.io.limits.UNPACKED_PATH` allows, or a part has more bytes than
            :data:`tltlc.io.limits.UNPACKED_NAME` allows.
    """
    depth = UNPACKED_PATH.depth or 0
    if len(name.encode(errors="surrogatepass")) > UNPACKED_PATH.size:
        problem = f"which is longer than {UNPACKED_PATH.size:,} bytes"
    elif name.count("/") >= depth:
        problem = f"which has more than {depth} parts"
    elif any(len(part.encode(errors="surrogatepass")) > UNPACKED_NAME.size for part in name.split("/")):
        title = f"{archive.name} contains the path `{name}`, with a part that is longer than {UNPACKED_NAME.size} bytes"
        raise _archive_error(title, "use a version of it in which this part has a shorter name")
    else:
        return
    raise _archive_error(f"{archive.name} contains the path `{name}`, {problem}", archive.damaged_help)


def _is_invalid_on_windows(part: str) -> bool:
    """Whether Windows does not accept this part of a path as the name of a file or folder."""
    # Windows drops spaces and dots at the end of a name.
    has_odd_end = part not in (".", "..") and part.endswith((".", " "))
    has_reserved_character = any(character in '\\:*?"<>|' or character < " " for character in part)
    return has_odd_end or has_reserved_character or part.partition(".")[0].rstrip(" ").lower() in _DEVICES


def _clash_error(name: str, written: Sequence[str], archive: Archive) -> TltlError:
    """Return the error TLT0009 for a path that cannot exist together with one of the ``written`` paths."""
    earlier = next((earlier for earlier in written if _clash(_fold_case(name), _fold_case(earlier))), name)
    if name == earlier:
        return _archive_error(f"{archive.name} contains two entries for `{name}`", archive.damaged_help)
    title = f"{archive.name} contains `{earlier}` and `{name}`, which cannot both exist"
    if _clash(name, earlier):
        return _archive_error(title, archive.damaged_help)
    return _archive_error(f"{title} in this file system", archive.elsewhere_help)


def _clash(first: str, second: str) -> bool:
    """Whether two paths are the same, or one is inside the other."""
    return f"{first}/".startswith(f"{second}/") or f"{second}/".startswith(f"{first}/")


def _fold_case(name: str) -> str:
    """Return a key that is equal for two names if any file system treats them as one, such as ``A`` and ``a``."""
    return normalize("NFC", normalize("NFD", name).casefold())


def _archive_error(title: str, help_: str) -> TltlError:
    return TltlError([Diagnostic("TLT0009", title, help=help_)])
