"""Load files of ``torch.save`` that may be damaged or malicious, with bounded memory.

``torch.load`` with ``weights_only`` executes nothing in the file. But it unpacks compressed members
of any size, makes tensors that are larger than their storage, and lets one list occur in many
places. This module refuses all three.
"""

from __future__ import annotations

import pickletools
import zipfile
from collections.abc import Iterable, Mapping
from io import BytesIO
from typing import Any, Final

import torch
from torch import Tensor

from tltlc.api import fileio

_GLOBALS: Final = {
    "collections OrderedDict",
    "torch._utils _rebuild_tensor_v2",
    *(f"torch {kind}Storage" for kind in ("Float", "Double", "Half", "BFloat16", "Long", "Int", "Short", "Char")),
    *(f"torch {kind}Storage" for kind in ("Byte", "Bool")),
}
"""The only classes and functions that a file of plain data and tensors may name."""
_PICKLE: Final = "data.pkl"
_MARK, _TUPLE, _ORDERED, _OTHER = "mark", "tuple", "class OrderedDict", "other"
"""The kinds of values on the stack of a pickle. An empty tuple counts as ``_OTHER``."""
_PROTOCOL: Final = 2
"""The pickle protocol of ``torch.save``."""
_OPCODES: Final = 20
"""An upper bound of the pickle operations per value or tensor."""


class TorchArchiveError(ValueError):
    """Raised for bytes that are not a valid file of ``torch.save``; the message says why."""


def read_torch(data: bytes) -> Any:
    """Load the bytes of a ``torch.save`` file that contains only plain data and tensors.

    All tensors are put on the CPU. Raises TorchArchiveError if the bytes are something else, are
    damaged, or exceed :data:`tltlc.io.limits.CHECKPOINT`.
    """
    archive = _checked_archive(data)
    try:
        content = torch.load(BytesIO(archive), map_location="cpu", weights_only=True)
    except Exception as error:
        # torch raises exceptions of many classes for invalid files.
        raise TorchArchiveError(f"it is damaged, or not a checkpoint ({type(error).__name__})") from None
    _check_values(content)
    return content


def _checked_archive(data: bytes) -> bytes:
    """Check the members of an archive; return the archive written again.

    Members must be uncompressed and undamaged, and their pickles may call only functions that make
    plain data. The archive is written again, because in a malicious archive torch may find other
    members than Python does.
    """
    # torch reads a file with another beginning in its older format, even if an archive follows.
    if not data.startswith(b"PK\x03\x04"):
        raise TorchArchiveError("it is damaged, or not a checkpoint (BadZipFile)")
    try:
        with zipfile.ZipFile(BytesIO(data)) as archive:
            members = archive.infolist()
            if any(member.compress_type != zipfile.ZIP_STORED for member in members):
                raise TorchArchiveError("its parts are compressed, but torch never compresses them")
            if sum(member.file_size for member in members) > len(data):
                raise TorchArchiveError("its parts are larger than the file")
            if archive.testzip():
                raise TorchArchiveError("it is damaged")
            contents = {member.filename: archive.read(member) for member in members}
        for name, content in contents.items():
            if name.rpartition("/")[2] == _PICKLE:
                _check_calls(content)
        return _archive(contents)
    except TorchArchiveError:
        raise
    except Exception as error:
        # Invalid archives and pickles also raise exceptions of many classes.
        raise TorchArchiveError(f"it is damaged, or not a checkpoint ({type(error).__name__})") from None


def _archive(contents: Mapping[str, bytes]) -> bytes:
    archive = BytesIO()
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_STORED) as members:
        for name, content in contents.items():
            members.writestr(name, content)
    return archive.getvalue()


def _check_calls(pickled: bytes) -> None:
    """Raise TorchArchiveError if a pickle is too long, or does more than make plain data and tensors.

    Tuples must not be keys of dicts: if each of several nested tuples contains the next one twice,
    the time to hash the outermost doubles with each level.
    """
    stack: list[str] = []
    marks: list[int] = []
    memo: dict[int, str] = {}
    for count, (opcode, argument, _) in enumerate(pickletools.genops(pickled)):
        if count > _OPCODES * (fileio.limits.CHECKPOINT.values or 0):
            raise TorchArchiveError(f"it contains more than {fileio.limits.CHECKPOINT.values:,} values")
        if opcode.proto > _PROTOCOL or opcode.name in ("INST", "OBJ", "EXT1", "EXT2", "EXT4"):
            raise TorchArchiveError("it contains more than plain data")
        if opcode.name == "GLOBAL" and argument not in _GLOBALS:
            raise TorchArchiveError(f"it contains more than plain data: {argument:.60}")
        operands = _pop_operands(stack, marks, opcode)
        keys = operands[1::2] if opcode.name in ("SETITEM", "SETITEMS") else []
        if _TUPLE in keys or (opcode.name == "REDUCE" and operands == [_ORDERED, _TUPLE]):
            raise TorchArchiveError("a key in it is neither a text nor a number")
        if opcode.name in ("BINPUT", "LONG_BINPUT", "PUT"):
            memo[int(str(argument))] = stack[-1]
        elif opcode.name in ("BINGET", "LONG_BINGET", "GET"):
            stack.append(memo[int(str(argument))])
        else:
            if opcode.name == "MARK":
                marks.append(len(stack))
            stack += _pushed_kinds(opcode, argument)


def _pop_operands(stack: list[str], marks: list[int], opcode: pickletools.OpcodeInfo) -> list[str]:
    """Take the operands of a pickle operation from the stack; return their kinds without the mark.

    ``marks`` are the positions on the stack at which MARK operations put marks. Some of these marks
    may no longer be there.
    """
    if opcode.name in ("BINPUT", "LONG_BINPUT", "PUT"):
        return []
    count = len(opcode.stack_before)
    if pickletools.markobject in opcode.stack_before:
        below = opcode.stack_before.index(pickletools.markobject)
        while marks[-1] >= len(stack) or stack[marks[-1]] != _MARK:
            marks.pop()
        mark = marks.pop()
        operands = [*stack[mark - below : mark], *stack[mark + 1 :]]
        del stack[mark - below :]
        return operands
    operands = stack[len(stack) - count :]
    del stack[len(stack) - count :]
    return operands


def _pushed_kinds(opcode: pickletools.OpcodeInfo, argument: object) -> list[str]:
    """Return the kinds of the values that a pickle operation pushes onto the stack."""
    if opcode.name == "MARK":
        return [_MARK]
    if opcode.name in ("TUPLE", "TUPLE1", "TUPLE2", "TUPLE3"):
        return [_TUPLE]
    if argument == "collections OrderedDict" and opcode.name == "GLOBAL":
        return [_ORDERED]
    return [_OTHER] * len(opcode.stack_after)


def _check_values(content: object) -> None:
    """Raise TorchArchiveError if loaded data has too many values, or is nested too deeply.

    A value in two places counts twice. Tensors must not be larger than their storage.
    """
    values: list[object] = [content]
    count = 0
    for _ in range(fileio.limits.CHECKPOINT.depth or 0):
        children: list[object] = []
        for value in values:
            count += 1
            _check_tensor(value)
            children += _children(value)
            if count + len(children) > (fileio.limits.CHECKPOINT.values or 0):
                raise TorchArchiveError(f"it contains more than {fileio.limits.CHECKPOINT.values:,} values")
        if not children:
            return
        values = children
    raise TorchArchiveError(f"it is nested more than {fileio.limits.CHECKPOINT.depth} levels deep")


def _check_tensor(value: object) -> None:
    if isinstance(value, Tensor) and value.numel() * value.element_size() > value.untyped_storage().nbytes():
        raise TorchArchiveError("a tensor in it is larger than its stored numbers")


def _children(value: object) -> Iterable[object]:
    if isinstance(value, Mapping):
        return value.values()
    return value if isinstance(value, (list, tuple, set, frozenset)) else ()
