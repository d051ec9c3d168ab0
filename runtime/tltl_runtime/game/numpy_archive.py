"""Read numpy archives (``.npz``) of plain numbers from untrusted bytes."""

from __future__ import annotations

import struct
import zipfile
import zlib
from collections.abc import Collection
from functools import lru_cache
from io import BytesIO
from math import prod
from typing import Any, cast

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

_HEADERS = {(1, 0): npy.read_array_header_1_0, (2, 0): npy.read_array_header_2_0}
_SIZES = {b"\1\0": struct.Struct("<H"), b"\2\0": struct.Struct("<I")}
"""How the size of the header is stored after the magic text and the version, by the bytes of the version.

The source is NEP 1, the definition of the format.
"""
_DAMAGE = (
    *(OSError, ValueError, RuntimeError, OverflowError, EOFError),
    *(zipfile.BadZipFile, zlib.error, struct.error),
)
"""The exceptions of zipfile for bytes that are not an archive, or are truncated or changed."""


class ArchiveError(ValueError):
    """Raised if bytes are not a valid archive or array; the message says why."""


def read_members(data: bytes, names: Collection[str], most: int) -> dict[str, bytes]:
    """Return the bytes of the file ``NAME.npy`` for each of ``names`` that an archive contains.

    Raises:
        ArchiveError: the archive is damaged, or these files have more than ``most`` bytes in all.
    """
    try:
        with zipfile.ZipFile(BytesIO(data)) as archive:
            entries = {name: archive.getinfo(f"{name}.npy") for name in names if f"{name}.npy" in archive.namelist()}
            if sum(entry.file_size for entry in entries.values()) <= most:
                return {name: _unpack(archive, entry) for name, entry in entries.items()}
    except _DAMAGE:
        raise ArchiveError("it is not a whole archive") from None
    raise ArchiveError(f"it contains more than {most >> 20} MiB")


def read_array(data: bytes) -> NDArray[Any]:
    """Read an array of plain numbers, of any shape, from the bytes of a file ``NAME.npy``.

    Raises:
        ArchiveError: the bytes are not exactly one such array.
    """
    try:
        size = _SIZES[data[6:8]]
        start = 8 + size.size + size.unpack_from(data, 8)[0]
        shape, fortran, dtype = _header(data[:start])
        if dtype.kind in "biuf" and min(shape, default=0) >= 0 and start + prod(shape) * dtype.itemsize == len(data):
            array = np.ndarray(shape, dtype, data, start, order="F" if fortran else "C")
            return cast(NDArray[Any], array.copy())  # a copy, because an array over bytes is read-only
    except Exception:  # numpy parses the header as Python, which may raise anything
        raise ArchiveError("it is not an array of numpy") from None
    raise ArchiveError("it is not an array of plain numbers")


@lru_cache(maxsize=1024)
def _header(text: bytes) -> tuple[tuple[int, ...], bool, np.dtype[Any]]:
    """Return the shape of an array, whether its order is Fortran's, and its type.

    ``text`` is all that comes before the numbers. numpy parses it as Python, which takes longer than to
    read a small array, and the arrays of equal recordings have equal headers.
    """
    stream = BytesIO(text)
    return _HEADERS[npy.read_magic(stream)](stream)


def _unpack(archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> bytes:
    """Unpack one file; read no more bytes than its entry in the archive declares."""
    if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        raise zipfile.BadZipFile
    with archive.open(entry) as file:
        return file.read(entry.file_size)
