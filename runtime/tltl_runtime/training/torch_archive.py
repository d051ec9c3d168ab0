"""Read what ``torch.save`` wrote, from a file that may be damaged or malicious, without a blow-up in memory.

``torch.load`` with ``weights_only`` executes nothing of the file, but it unpacks compressed members of any size, makes
tensors that are larger than their storage, and shares one list in many places. This module refuses all three first.
"""

from __future__ import annotations

import pickletools
import zipfile
from collections.abc import Iterable, Mapping
from io import BytesIO
from typing import Any, Final

import torch
from torch import Tensor

from tltlc.limits import CHECKPOINT

_GLOBALS: Final = {
    "collections OrderedDict",
    "torch._utils _rebuild_tensor_v2",
    *(f"torch {kind}Storage" for kind in ("Float", "Double", "Half", "BFloat16", "Long", "Int", "Short", "Char")),
    *(f"torch {kind}Storage" for kind in ("Byte", "Bool")),
}
"""The classes and functions that a file of plain data and tensors names."""
_PICKLE: Final = "data.pkl"


class TorchArchiveError(ValueError):
    """The bytes are not what ``torch.save`` writes for plain data and tensors; the message says why."""


def read_torch(data: bytes) -> Any:
    """The plain data and tensors that ``torch.save`` wrote, on the CPU.

    Raises TorchArchiveError where the bytes are something else, are damaged, or pass :data:`tltlc.limits.CHECKPOINT`.
    """
    _check_archive(data)
    try:
        content = torch.load(BytesIO(data), map_location="cpu", weights_only=True)
    except Exception as error:
        # torch raises exceptions of many classes for files that it does not understand.
        raise TorchArchiveError(f"it is damaged, or no checkpoint ({type(error).__name__})") from None
    _check_values(content)
    return content


def _check_archive(data: bytes) -> None:
    """Check the members of the archive: stored as they are, whole, and with no call but those of plain data."""
    # torch reads a file that begins otherwise as its older format, whatever archive follows.
    if not data.startswith(b"PK\x03\x04"):
        raise TorchArchiveError("it is damaged, or no checkpoint (BadZipFile)")
    try:
        with zipfile.ZipFile(BytesIO(data)) as archive:
            members = archive.infolist()
            if any(member.compress_type != zipfile.ZIP_STORED for member in members):
                raise TorchArchiveError("its parts are compressed, as torch never writes them")
            if sum(member.file_size for member in members) > len(data):
                raise TorchArchiveError("its parts are larger than the file")
            if archive.testzip():
                raise TorchArchiveError("it is damaged")
            pickles = [archive.read(member) for member in members if member.filename.rpartition("/")[2] == _PICKLE]
        for pickled in pickles:
            _check_calls(pickled)
    except TorchArchiveError:
        raise
    except Exception as error:
        # Strange archives and pickles end in exceptions of many classes, too.
        raise TorchArchiveError(f"it is damaged, or no checkpoint ({type(error).__name__})") from None


def _check_calls(pickled: bytes) -> None:
    """Refuse a pickle that names any class or function but those of plain data and tensors."""
    for opcode, argument, _ in pickletools.genops(pickled):
        if opcode.name == "GLOBAL" and argument not in _GLOBALS:
            raise TorchArchiveError(f"it holds more than plain data: {argument:.60}")
        if opcode.name in ("STACK_GLOBAL", "INST", "EXT1", "EXT2", "EXT4"):
            raise TorchArchiveError("it holds more than plain data")


def _check_values(content: object) -> None:
    """Check the size of what was read as it is walked through: a value in two places counts twice."""
    level: list[object] = [content]
    count = 0
    for _ in range(CHECKPOINT.depth or 0):
        following: list[object] = []
        for value in level:
            count += 1
            _check_tensor(value)
            following += _inside(value)
            if count + len(following) > (CHECKPOINT.values or 0):
                raise TorchArchiveError(f"it holds more than {CHECKPOINT.values:,} values")
        if not following:
            return
        level = following
    raise TorchArchiveError(f"it nests deeper than {CHECKPOINT.depth} levels")


def _check_tensor(value: object) -> None:
    if isinstance(value, Tensor) and value.numel() * value.element_size() > value.untyped_storage().nbytes():
        raise TorchArchiveError("a tensor in it is larger than the numbers that are there")


def _inside(value: object) -> Iterable[object]:
    if isinstance(value, Mapping):
        return value.values()
    return value if isinstance(value, (list, tuple, set, frozenset)) else ()
