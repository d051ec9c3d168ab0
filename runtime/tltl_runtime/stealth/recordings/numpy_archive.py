"""Numpy archives (``.npz``) of plain numbers, read from bytes that nobody vouches for."""

from __future__ import annotations

import struct
import zipfile
import zlib
from collections.abc import Collection
from io import BytesIO
from math import prod
from typing import Any, cast

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

_HEADERS = {(1, 0): npy.read_array_header_1_0, (2, 0): npy.read_array_header_2_0}
_DAMAGE = (
    *(OSError, ValueError, RuntimeError, OverflowError, EOFError),
    *(zipfile.BadZipFile, zlib.error, struct.error),
)
"""What zipfile raises for bytes that are no archive, or one that was cut or changed."""


class ArchiveError(ValueError):
    """The bytes are not what they should be; the message says why."""


def read_members(data: bytes, names: Collection[str], most: int) -> dict[str, bytes]:
    """The files ``NAME.npy`` of an archive, unpacked, for those of ``names`` that are in it.

    Raises:
        ArchiveError: it is no whole archive, or these have more than ``most`` bytes.
    """
    try:
        with zipfile.ZipFile(BytesIO(data)) as archive:
            entries = {name: archive.getinfo(f"{name}.npy") for name in names if f"{name}.npy" in archive.namelist()}
            if sum(entry.file_size for entry in entries.values()) <= most:
                return {name: _unpacked(archive, entry) for name, entry in entries.items()}
    except _DAMAGE:
        raise ArchiveError("it is no whole archive") from None
    raise ArchiveError(f"it holds more than {most >> 20} MiB")


def read_array(data: bytes) -> NDArray[Any]:
    """The array of plain numbers that a file ``NAME.npy`` holds, of whatever shape.

    Raises:
        ArchiveError: it holds anything else.
    """
    stream = BytesIO(data)
    try:
        shape, fortran, dtype = _HEADERS[npy.read_magic(stream)](stream)
        start = stream.tell()
        if dtype.kind in "biuf" and min(shape, default=0) >= 0 and start + prod(shape) * dtype.itemsize == len(data):
            array = np.ndarray(shape, dtype, data, start, order="F" if fortran else "C")
            return cast(NDArray[Any], array.copy())  # an array over bytes could not be written to
    except Exception:  # numpy reads the header as Python, and lets through whatever that raises
        raise ArchiveError("it is none of numpy's") from None
    raise ArchiveError("it is none of plain numbers")


def _unpacked(archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> bytes:
    """The bytes of one file, no more than it says that it has, whatever it unpacks to."""
    if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        raise zipfile.BadZipFile
    with archive.open(entry) as file:
        return file.read(entry.file_size)
