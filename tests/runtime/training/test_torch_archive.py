"""Files of ``torch.save`` are read; files that would fill the memory are rejected first."""

from __future__ import annotations

import zipfile
from collections import OrderedDict
from collections.abc import Callable
from contextlib import suppress
from io import BytesIO
from time import monotonic
from typing import Any

import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st

from tltl_runtime.training.files.torch_archive import TorchArchiveError, read_torch
from tltlc.io.limits import Limit


def saved(value: object) -> bytes:
    data = BytesIO()
    torch.save(value, data)
    return data.getvalue()


def repacked(data: bytes, change: Callable[[str, bytes], bytes], compression: int = zipfile.ZIP_STORED) -> bytes:
    """The archive with changed members."""
    out = BytesIO()
    with zipfile.ZipFile(BytesIO(data)) as old, zipfile.ZipFile(out, "w", compression) as new:
        for name in old.namelist():
            new.writestr(name, change(name, old.read(name)))
    return out.getvalue()


def shared(levels: int) -> list[Any]:
    """A list of 2 ** levels values whose pickle grows only linearly with ``levels``."""
    value: list[Any] = [1]
    for _ in range(levels):
        value = [value, value]
    return value


class Zeros:
    """An object that allocates 5 GiB when it is unpickled."""

    def __reduce__(self) -> tuple[type[bytearray], tuple[int]]:
        return bytearray, (5 << 30,)


def test_plain_data_and_tensors_are_read() -> None:
    kinds = (torch.float32, torch.float64, torch.float16, torch.int64, torch.int32, torch.uint8, torch.bool)
    tensors = [torch.ones(2, dtype=kind) for kind in kinds]
    plain = (1, 2.5, None, "d", [True])
    again = read_torch(saved({"named": OrderedDict(tensor=torch.arange(3.0)), "plain": plain, "tensors": tensors}))
    assert torch.equal(again["named"]["tensor"], torch.arange(3.0))
    assert again["plain"] == plain
    assert [tensor.dtype for tensor in again["tensors"]] == list(kinds)


def test_compressed_members_are_rejected() -> None:
    data = repacked(saved(torch.zeros(1 << 20)), lambda _, content: content, zipfile.ZIP_DEFLATED)
    assert len(data) < 1 << 16
    with pytest.raises(TorchArchiveError, match="compressed"):
        read_torch(data)


@pytest.mark.parametrize(
    ("value", "why"),
    [
        (torch.zeros(1).expand(1 << 20, 1 << 20), "larger than its stored numbers"),
        (shared(40), "more than 1,000,000 values"),
        (Zeros(), "plain data: __builtin__ bytearray"),
    ],
    ids=["tensor", "lists", "bytes"],
)
def test_values_that_would_fill_the_memory_are_rejected(value: object, why: str) -> None:
    with pytest.raises(TorchArchiveError, match=why):
        read_torch(saved(value))


def test_deeply_nested_values_are_rejected() -> None:
    value: list[Any] = []
    for _ in range(40):
        value = [value]
    with pytest.raises(TorchArchiveError, match="nested more than 32 levels deep"):
        read_torch(saved(value))


@pytest.mark.parametrize(
    "pickled",
    [
        b"\x80\x02}" + b")q\x00" + b"h\x00\x86q\x00".join([b"h\x00"] * 60) + b"K\x01s.",
        b"\x80\x02ccollections\nOrderedDict\n])K\x01\x86a\x85R.",
    ],
    ids=["dict", "ordered dict"],
)
def test_keys_that_take_very_long_to_hash_are_rejected(pickled: bytes) -> None:
    data = repacked(saved({}), lambda name, content: pickled if name.endswith("data.pkl") else content)
    with pytest.raises(TorchArchiveError, match="neither a text nor a number"):
        read_torch(data)


def test_pickles_with_too_many_operations_are_rejected(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tltlc.io.limits.CHECKPOINT", Limit(size=1 << 20, depth=32, values=10))
    with pytest.raises(TorchArchiveError, match="more than 10 values"):
        read_torch(saved([None] * 1000))


def test_torch_reads_the_members_that_were_checked() -> None:
    """Python's reader finds the central directory by its end, torch's by the offset in the last record."""
    good, bad = saved(torch.zeros(10)), repacked(saved(torch.ones(1000)), lambda _, c: c, zipfile.ZIP_DEFLATED)
    start, end = bad.rindex(b"PK\x05\x06"), good.rindex(b"PK\x05\x06")
    where = int.from_bytes(bad[start + 16 : start + 20], "little")
    record = bytearray(good[end:])
    record[16:20] = where.to_bytes(4, "little")
    mixed = bad[:start] + good[:end] + bytes(record)
    try:
        value = read_torch(mixed)
    except TorchArchiveError:
        return
    assert torch.equal(value, torch.zeros(10))


def test_overlapping_members_are_rejected() -> None:
    data = bytearray(saved({"a": torch.zeros(1000), "b": torch.zeros(1000)}))
    with zipfile.ZipFile(BytesIO(data)) as archive:
        (first, second) = [member for member in archive.infolist() if member.file_size == 4000]
    central = data.rindex(second.filename.encode()) - 46
    data[central + 42 : central + 46] = first.header_offset.to_bytes(4, "little")
    # The second entry of the central directory now points at the first member, whose name does not match.
    with pytest.raises(TorchArchiveError):
        read_torch(bytes(data))


@given(place=st.integers(0, 3000), byte=st.integers(0, 255), cut=st.integers(0, 3000))
def test_damaged_bytes_are_read_or_rejected(place: int, byte: int, cut: int) -> None:
    data = bytearray(saved({"a": torch.arange(20.0), "b": [1, "x", None], "c": (2.5, True)}))
    data[place % len(data)] = byte
    for damaged in (bytes(data), bytes(data[: cut % len(data)])):
        with suppress(TorchArchiveError):
            read_torch(damaged)


def test_the_time_to_read_a_pickle_grows_with_its_length() -> None:
    count = 300_000
    pickled = b"\x80\x02(" + count * b"N" + count * b"(t" + b"t."
    data = repacked(saved([]), lambda name, content: pickled if name.endswith("data.pkl") else content)
    began = monotonic()
    assert len(read_torch(data)) == 2 * count
    # It takes two seconds; a search through the whole stack for each mark would take minutes.
    assert monotonic() - began < 60


@pytest.mark.parametrize("pickled", [b"\x80\x02t.", b"\x80\x02(0t.", b"\x80\x02((00t.", b"\x80\x02(N1t."])
def test_a_pickle_that_pops_a_missing_mark_is_rejected(pickled: bytes) -> None:
    data = repacked(saved([]), lambda name, content: pickled if name.endswith("data.pkl") else content)
    with pytest.raises(TorchArchiveError, match="damaged"):
        read_torch(data)
