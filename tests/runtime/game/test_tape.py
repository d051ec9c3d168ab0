"""Tapes are written and read back, and what is no tape is refused."""

from __future__ import annotations

import gzip
import json
from collections.abc import Callable
from math import nan
from pathlib import Path
from random import Random

import jsonschema
import pytest
from hypothesis import given

from tests.docs.blocks import ROOT
from tests.fuzzing import SEEDS, check, mutated_bytes, mutated_text, times
from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tltl_runtime import Tape, read_tape, write_tape
from tltl_runtime.game.tape import TapeHeader, TapeStep
from tltlc import TltlError
from tltlc.api import fileio, replace

HEADER = TapeHeader(
    "walk", {"near(a, b)": {}, "seen": {"type": "bool"}}, "crypt", "v1", 7, "0f" * 32, {"walk": "1.4"}, 60
)
TAPE = Tape(
    HEADER,
    tuple(TapeStep({"move": [0.1, step]}, {"near(a, b)": step / 3, "seen": step == 99}) for step in range(100)),
)


@pytest.mark.parametrize("name", ["play.tape.jsonl", "play.tape.jsonl.gz"])
def test_a_tape_is_read_as_it_was_written(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    write_tape(path, TAPE)
    assert read_tape(path) == TAPE
    data = path.read_bytes()
    write_tape(path, TAPE)
    assert path.read_bytes() == data
    lines = (gzip.decompress(data) if name.endswith(".gz") else data).decode().splitlines()
    schema = json.loads((ROOT / "tltlc" / "monitor" / "tape.schema.json").read_text(encoding="utf-8"))
    for line in lines:
        jsonschema.Draft202012Validator(schema).validate(json.loads(line))
    assert [number for number, line in enumerate(lines) if "digest" in json.loads(line)] == [60]


@pytest.mark.parametrize(
    "signals",
    [{"near(a, b)": nan, "seen": False}, {"seen": False}, {"near(a, b)": 1, "seen": 0}, {"near(a, b)": 1, "see": True}],
)
def test_a_wrong_step_is_not_written(tmp_path: Path, signals: dict[str, float]) -> None:
    with pytest.raises(ValueError, match=r"step 2 has other (types of )?signals|Out of range float"):
        write_tape(tmp_path / "x.tape.jsonl", replace(TAPE, steps=(TAPE.steps[0], TapeStep(0, signals))))
    assert not [*tmp_path.iterdir()]


def test_a_step_without_an_action_is_not_written(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="step 1 has no action"):
        write_tape(tmp_path / "x.tape.jsonl", replace(TAPE, steps=(TapeStep(None, TAPE.steps[0].signals),)))
    assert not [*tmp_path.iterdir()]


def test_a_tape_without_steps_is_neither_written_nor_read(tmp_path: Path) -> None:
    path = tmp_path / "x.tape.jsonl"
    with pytest.raises(TltlError) as written:
        write_tape(path, Tape(HEADER, ()))
    assert not [*tmp_path.iterdir()]
    write_tape(path, TAPE)
    path.write_bytes(path.read_bytes().partition(b"\n")[0])
    with pytest.raises(TltlError) as read:
        read_tape(path)
    assert written.value.diagnostics == read.value.diagnostics


def test_a_tape_that_is_too_large_can_be_judged_once_it_is_unpacked(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    tltlc: Callable[..., Outcome],  # noqa: F811
) -> None:
    monkeypatch.setattr(fileio.limits, "TAPE", replace(fileio.limits.TAPE, size=1000))
    monkeypatch.setattr("tltlc.monitor.packed.TAPE", replace(fileio.limits.TAPE, unpacked=1000))
    for path in (tmp_path / "x.tape.jsonl", tmp_path / "x.tape.jsonl.gz"):
        write_tape(path, Tape(HEADER, TAPE.steps[:20]))
        with pytest.raises(TltlError) as caught:
            read_tape(path)
        (diagnostic,) = caught.value.diagnostics
        assert diagnostic.code == "TLT0004"
        assert diagnostic.help == (
            "record shorter plays, or fewer signals; to judge this one, unpack it if it is packed: "
            "`tltlc monitor SPEC TAPE` reads an unpacked tape of any size"
        )
    (tmp_path / "walk.tltl").write_text("signal seen: bool\nspec walk = G !seen\n", encoding="utf-8")
    result = tltlc("monitor", str(tmp_path / "walk.tltl"), str(tmp_path / "x.tape.jsonl"))
    assert (result.status, result.out.count(",holding,")) == (0, 20), result.out


def test_what_is_no_tape_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "x.tape.jsonl"
    write_tape(path, TAPE)
    header, *_ = path.read_text(encoding="utf-8").splitlines()
    for text, error in (
        ("", r"TLT0620.*the tape `.*` is empty"),
        (header, r"TLT0620.*contains no step"),
        ('{"near(a, b)": 1, "seen": true}\n', r"TLT0622.*line 1"),
        ("seen\n1\n", r"TLT0622.*line 1"),
        ("[]\n", r"TLT0622.*line 1"),
    ):
        path.write_text(text, encoding="utf-8")
        with pytest.raises(TltlError, match=error):
            read_tape(path)
    with pytest.raises(TltlError, match="TLT0001"):
        read_tape(tmp_path / "none")
    monkeypatch.setattr(fileio.limits, "TAPE", replace(fileio.limits.TAPE, size=100))
    write_tape(path, TAPE)
    with pytest.raises(TltlError, match=r"TLT0004.*is larger than"):
        read_tape(path)


@given(seed=SEEDS)
@times(100)
def test_damaged_tapes_are_read_or_refused(seed: int, tmp_path_factory: pytest.TempPathFactory) -> None:
    random = Random(seed)
    path = tmp_path_factory.getbasetemp() / "damaged.tape.jsonl.gz"
    write_tape(path, TAPE)
    packed = path.read_bytes()
    text = mutated_text(random, gzip.decompress(packed).decode()).encode("utf-8", "surrogatepass")
    path.write_bytes(mutated_bytes(random, packed) if seed % 4 == 0 else text)
    check(lambda: read_tape(path))
