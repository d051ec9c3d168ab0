"""What ``torch.save`` wrote is read; what would fill the memory is refused before it does."""

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

from tltl_runtime.training.run import torch_archive
from tltl_runtime.training.run.torch_archive import TorchArchiveError, read_torch
from tltlc.io.limits import Limit


def saved(value: object) -> bytes:
    data = BytesIO()
    torch.save(value, data)
    return data.getvalue()


def repacked(data: bytes, change: Callable[[str, bytes], bytes], compression: int = zipfile.ZIP_STORED) -> bytes:
    """The archive with other members."""
    out = BytesIO()
    with zipfile.ZipFile(BytesIO(data)) as old, zipfile.ZipFile(out, "w", compression) as new:
        for name in old.namelist():
            new.writestr(name, change(name, old.read(name)))
    return out.getvalue()


def shared(levels: int) -> list[Any]:
    """A list that holds 2 ** levels values, and takes a line each level."""
    value: list[Any] = [1]
    for _ in range(levels):
        value = [value, value]
    return value


class Zeros:
    """Asks for 5 GiB of memory when it is read."""

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


def test_a_small_file_that_unpacks_to_gigabytes_is_refused() -> None:
    data = repacked(saved(torch.zeros(1 << 20)), lambda _, content: content, zipfile.ZIP_DEFLATED)
    assert len(data) < 1 << 16
    with pytest.raises(TorchArchiveError, match="compressed"):
        read_torch(data)


@pytest.mark.parametrize(
    ("value", "why"),
    [
        (torch.zeros(1).expand(1 << 20, 1 << 20), "larger than the numbers that are there"),
        (shared(40), "more than 1,000,000 values"),
        (Zeros(), "plain data: __builtin__ bytearray"),
    ],
    ids=["tensor", "lists", "bytes"],
)
def test_what_would_fill_the_memory_is_refused(value: object, why: str) -> None:
    with pytest.raises(TorchArchiveError, match=why):
        read_torch(saved(value))


def test_a_value_that_nests_too_deep_is_refused() -> None:
    value: list[Any] = []
    for _ in range(40):
        value = [value]
    with pytest.raises(TorchArchiveError, match="nests deeper than 32 levels"):
        read_torch(saved(value))


@pytest.mark.parametrize(
    "pickled",
    [
        b"\x80\x02}" + b")q\x00" + b"h\x00\x86q\x00".join([b"h\x00"] * 60) + b"K\x01s.",
        b"\x80\x02ccollections\nOrderedDict\n])K\x01\x86a\x85R.",
    ],
    ids=["dict", "ordered dict"],
)
def test_keys_that_take_for_ever_to_hash_are_refused(pickled: bytes) -> None:
    data = repacked(saved({}), lambda name, content: pickled if name.endswith("data.pkl") else content)
    with pytest.raises(TorchArchiveError, match="no text and no number"):
        read_torch(data)


def test_more_operations_than_any_checkpoint_takes_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(torch_archive, "CHECKPOINT", Limit(size=1 << 20, depth=32, values=10))
    with pytest.raises(TorchArchiveError, match="more than 10 values"):
        read_torch(saved([None] * 1000))


def test_torch_reads_the_members_that_were_checked() -> None:
    """Python's reader finds the table of contents before the end, torch's where the last record says."""
    good, bad = saved(torch.zeros(10)), repacked(saved(torch.ones(1000)), lambda _, c: c, zipfile.ZIP_DEFLATED)
    start, end = bad.rindex(b"PK\x05\x06"), good.rindex(b"PK\x05\x06")
    where = int.from_bytes(bad[start + 16 : start + 20], "little")
    record = bytearray(good[end:])
    record[16:20] = where.to_bytes(4, "little")
    mixed = bad[:start] + good[:end] + bytes(record)
    try:
        found = read_torch(mixed)
    except TorchArchiveError:
        return
    assert torch.equal(found, torch.zeros(10))


def test_members_that_overlap_are_refused() -> None:
    data = bytearray(saved({"a": torch.zeros(1000), "b": torch.zeros(1000)}))
    with zipfile.ZipFile(BytesIO(data)) as archive:
        (first, second) = [each for each in archive.infolist() if each.file_size == 4000]
    central = data.rindex(second.filename.encode()) - 46
    data[central + 42 : central + 46] = first.header_offset.to_bytes(4, "little")
    # The second entry of the table points at the first member now: reading either says which name it has.
    with pytest.raises(TorchArchiveError):
        read_torch(bytes(data))


@given(place=st.integers(0, 3000), byte=st.integers(0, 255), cut=st.integers(0, 3000))
def test_damaged_bytes_are_read_or_refused(place: int, byte: int, cut: int) -> None:
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
    # It takes two seconds, and with a search through all of the stack for each mark minutes.
    assert monotonic() - began < 60


@pytest.mark.parametrize("pickled", [b"\x80\x02t.", b"\x80\x02(0t.", b"\x80\x02((00t.", b"\x80\x02(N1t."])
def test_a_pickle_that_takes_a_mark_that_is_gone_is_refused(pickled: bytes) -> None:
    data = repacked(saved([]), lambda name, content: pickled if name.endswith("data.pkl") else content)
    with pytest.raises(TorchArchiveError, match="damaged"):
        read_torch(data)
