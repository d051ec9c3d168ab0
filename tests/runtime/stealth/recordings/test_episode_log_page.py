"""docs/episode-log.md describes episode files as they are written, and its programs run."""

from __future__ import annotations

import json
import re
from io import BytesIO
from math import inf
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.docs.blocks import DOCS, blocks
from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.episode_recorder import RecordEpisode
from tltl_runtime.stealth.recordings.arrays import ARRAYS, Array
from tltl_runtime.stealth.recordings.file import FORMAT, VERSION, AxisNames, Meta, to_bytes
from tltlc.monitor import RewardOptions

PAGE = DOCS / "episode-log.md"
TEXT = PAGE.read_text(encoding="utf-8")


def table(head: str) -> list[str]:
    return TEXT[TEXT.index(head) :].split("\n\n")[0].splitlines()[2:]


def row(array: Array) -> str:
    shape, dtype = ", ".join(map(str, array.shape)), array.dtype.replace("|", "\\|")
    return (
        f"| `{array.name}` | `{dtype}` | {shape} | {array.unit} | {range_text(array.low, array.high)} | {array.doc} |"
    )


def range_text(low: float, high: float) -> str:
    if high == inf:
        return "" if low == -inf else f"{low:g} and up"
    return f"{low:g} to {high:g}"


def test_the_page_lists_every_array() -> None:
    assert table("| array | type |")[2:] == [row(array) for array in ARRAYS]


def test_a_file_matches_the_table() -> None:
    env = RecordEpisode(make_env("branching"))
    env.reset(seed=1)
    env.step([1, 0, 0, 0, 0])
    with np.load(BytesIO(to_bytes(env.episode))) as arrays:
        meta = json.loads(bytes(arrays["meta"]))
        sizes = {"n": 1, "n + 1": 2, **{name: len(entries) for name, entries in meta["names"].items()}}
        for array in ARRAYS:
            assert arrays[array.name].dtype.str == array.dtype
            assert arrays[array.name].shape == tuple(sizes.get(size, size) for size in array.shape)  # type: ignore[call-overload]
    env.close()
    assert all(meta["names"].values())
    assert set(meta["versions"]) <= set(re.findall(r"`(\w+)`", TEXT))


def test_the_page_lists_every_key_of_meta() -> None:
    rows = [re.findall(r"`([\w-]+)`", line.split("|")[1]) for line in table("| key of `meta` |")]
    fields: Any = Meta.__match_args__  # type: ignore[attr-defined]
    assert [name for names in rows for name in names] == list(fields)
    for kind in (AxisNames, RewardOptions):
        assert all(f"`{name}`" in TEXT for name in kind.__match_args__)  # type: ignore[attr-defined]
    assert f"Format `{FORMAT}`, version {VERSION}." in TEXT


def test_the_programs_on_the_page_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    programs = [block.text for block in blocks(PAGE) if block.kind == "python"]
    names: dict[str, Any] = {}
    for program in programs:
        exec(program, names)
    assert len(programs) == 3
    assert names["health"].shape == names["to_s1"].shape == (21,) and names["episode"].end == "stopped"
