"""Tapes are read as the traces of their plays, and wrong lines are refused."""

from __future__ import annotations

import gzip
import io
import json
import re
from typing import Any

import jsonschema
import pytest

from tests.docs.blocks import ROOT
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.io.limits import TAPE
from tltlc.monitor.parquet import as_text
from tltlc.monitor.tapes import TapeDigest, TapeHeader
from tltlc.monitor.traces import read_trace
from tltlc.resolve.spec import Signal
from tltlc.resolve.units import TYPES

SCHEMA = json.loads((ROOT / "tltlc" / "monitor" / "tape.schema.json").read_text(encoding="utf-8"))
SIGNALS = (Signal("speed", "number", None, None), Signal("seen", "bool", 0.0, 1.0))
HEADER = {
    "tape": 1,
    "game": "walk",
    "scene": "crypt",
    "variant": "v0",
    "seed": 7,
    "spec": None,
    "versions": {"python": "3.11"},
    "clock_hz": 10,
    "signals": {"speed": {"range": [0, None]}, "seen": {"type": "bool"}},
}
STEP = {"action": 2, "signals": {"speed": 1.5, "seen": False}}


def tape(*steps: dict[str, Any], **header: Any) -> bytes:
    return "".join(json.dumps(line) + "\n" for line in ({**HEADER, **header}, *steps)).encode()


def read(data: bytes, clock_s: float | None = None) -> list[dict[str, float]]:
    return [*read_trace(io.BytesIO(data), "play.tape.jsonl", SIGNALS, clock_s)]


def message(data: bytes, clock_s: float | None = None) -> tuple[str, str, str]:
    """Return the code, the title and the label of the error."""
    with pytest.raises(TltlError) as caught:
        read(data, clock_s)
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.help
    return diagnostic.code, diagnostic.title, diagnostic.labels[0].message if diagnostic.labels else ""


def test_a_tape_is_read_as_the_trace_of_its_play() -> None:
    other = {"action": [0, {"jump": True}], "signals": {"seen": True, "speed": -2}, "more": 1}
    assert read(tape(STEP, other)) == [{"speed": 1.5, "seen": 0.0}, {"speed": -2.0, "seen": 1.0}]
    packed = gzip.compress(tape(STEP, other))
    assert read(as_text(packed, "play.tape.jsonl.gz", SIGNALS)) == read(tape(STEP, other))


def test_a_signal_called_tape_makes_no_tape() -> None:
    signals = (Signal("tape", "number", None, None),)
    lines = b'{"tape": 1, "signals": 3}\n{"tape": 2, "signals": null}\n'
    assert [*read_trace(io.BytesIO(lines), "trace", signals)] == [{"tape": 1.0}, {"tape": 2.0}]


def test_steps_are_read_lazily() -> None:
    samples = read_trace(io.BytesIO(tape(STEP, {"action": 1})), "play.tape.jsonl", SIGNALS)
    assert next(samples) == {"speed": 1.5, "seen": 0.0}
    with pytest.raises(TltlError, match="line 3"):
        next(samples)


def test_the_clock_of_a_tape_is_compared_with_that_of_the_spec() -> None:
    assert len(read(tape(STEP, STEP), 0.1)) == 2
    assert len(read(tape(STEP, STEP, clock_hz=None), 0.5)) == 2
    code, title, _ = message(tape(STEP, STEP), 0.5)
    assert (code, title) == ("TLT0623", "the time in line 3 of the trace is wrong")


@pytest.mark.parametrize(
    ("header", "label"),
    [
        ({"tape": 2}, "this is version 2 of the format of tapes, and this tltlc reads version 1"),
        ({"tape": True}, "this is version True of the format of tapes, and this tltlc reads version 1"),
        ({"game": None}, "`game` must be a text"),
        ({"variant": 1}, "`variant` must be a text"),
        ({"scene": 1}, "`scene` must be a text or null"),
        ({"spec": 1}, "`spec` must be a text or null"),
        ({"seed": -1}, "`seed` must be a whole number from 0 to 9007199254740991, or null"),
        ({"seed": 0.5}, "`seed` must be a whole number from 0 to 9007199254740991, or null"),
        ({"seed": 1 << 53}, "`seed` must be a whole number from 0 to 9007199254740991, or null"),
        ({"seed": 10**400}, "`seed` must be a whole number from 0 to 9007199254740991, or null"),
        ({"clock_hz": 0}, "`clock_hz` must be a number above 0, or null"),
        ({"clock_hz": True}, "`clock_hz` must be a number above 0, or null"),
        ({"versions": {"python": 3}}, "`versions` must map names to texts"),
        ({"signals": {"x": 1}}, 'the signal `x` must have a declaration such as {} or {"type": "bool"}'),
        ({"signals": {"x": {"type": []}}}, 'the signal `x` must have a declaration such as {} or {"type": "bool"}'),
    ],
)
def test_a_wrong_header_is_refused(header: dict[str, Any], label: str) -> None:
    assert message(tape(STEP, **header)) == ("TLT0622", "line 1 of the trace cannot be read", label)
    assert not jsonschema.Draft202012Validator(SCHEMA).is_valid({**HEADER, **header})


@pytest.mark.parametrize(
    ("step", "label"),
    [
        ({"signals": STEP["signals"]}, "this step has no `action`"),
        ({"action": 1}, "this step has no `signals`, an object with a value for each signal"),
        ({"action": 1, "signals": {"seen": True}}, "the signal `speed` of the header is missing here"),
        ({**STEP, "signals": {"seen": True, "speed": 1, "x": 1}}, "the header does not declare the signal `x`"),
        ({**STEP, "signals": {"seen": 1, "speed": 1}}, "the value of the signal `seen` must be true or false"),
        ({**STEP, "signals": {"seen": True, "speed": True}}, "the value of the signal `speed` must be a finite number"),
        (
            {**STEP, "signals": {"seen": True, "speed": 1e999}},
            "the value of the signal `speed` must be a finite number",
        ),
        ({**STEP, "digest": "00000001"}, "the signals up to here have the digest 2b5e026f, and the tape says 00000001"),
    ],
)
def test_a_wrong_step_is_refused(step: dict[str, Any], label: str) -> None:
    code, title, printed = message(tape(STEP, step))
    assert (code, title) == ("TLT0622", "line 3 of the trace cannot be read")
    assert printed == label


def test_each_sixtieth_step_has_the_digest_of_all_signals_so_far() -> None:
    header = TapeHeader("walk", HEADER["signals"])  # type: ignore[arg-type]
    digest = TapeDigest()
    steps = []
    for number in range(1, 121):
        signals = {"speed": number / 3, "seen": number % 2 == 0}
        digest.add(header, signals)
        steps.append({"action": 1, "signals": signals, **({} if number % 60 else {"digest": digest.text})})
    assert len(read(tape(*steps))) == 120
    missing = [*steps[:59], {**steps[59], "digest": None}]
    assert message(tape(*missing))[2] == "step 60 has no digest; each 60th step must have one"
    steps[70] = {"action": 1, "signals": {"speed": 23.7, "seen": False}}
    code, title, label = message(tape(*steps))
    assert (code, title) == ("TLT0622", "line 121 of the trace cannot be read")
    assert label.startswith("the signals up to here have the digest ")


def test_minus_zero_counts_as_zero() -> None:
    header = TapeHeader("walk", HEADER["signals"])  # type: ignore[arg-type]
    digests = []
    for zero in (0, 0.0, -0.0):
        digest = TapeDigest()
        digest.add(header, {"speed": zero, "seen": False})
        digests.append(digest.text)
    assert len(set(digests)) == 1


def test_a_damaged_or_large_packed_tape_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    packed = gzip.compress(tape(STEP))
    for data in (packed[:-9], packed[:20] + b"\0" + packed[21:], b"\x1f\x8b"):
        with pytest.raises(TltlError, match=r"TLT0622.*`x.gz` cannot be unpacked: it is cut off or damaged"):
            as_text(data, "x.gz", SIGNALS)
    assert TAPE.unpacked is not None
    with pytest.raises(TltlError) as caught:
        as_text(gzip.compress(b" " * (TAPE.unpacked + 1)), "my play.jsonl", SIGNALS)
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == "TLT0004"
    assert diagnostic.title == "`my play.jsonl` has more than 64 MiB when it is unpacked"
    assert diagnostic.help == (
        "unpack it with `gunzip < 'my play.jsonl' > whole.jsonl`, and judge it alone: "
        "`tltlc monitor SPEC whole.jsonl` reads any size"
    )


def test_the_schema_is_valid_and_has_the_types_of_signals() -> None:
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    declaration = SCHEMA["$defs"]["header"]["properties"]["signals"]["additionalProperties"]
    assert set(declaration["properties"]["type"]["enum"]) == set(TYPES)
    for line in (HEADER, STEP):
        jsonschema.Draft202012Validator(SCHEMA).validate(line)


def test_the_examples_of_the_page_are_right(capsys: pytest.CaptureFixture[str]) -> None:
    page = (ROOT / "docs" / "tapes.md").read_text(encoding="utf-8")
    (example,) = re.findall(r"```text\n(.*?)```", page, re.DOTALL)
    signals = (Signal("distance", "length", 0.0, None), Signal("has_key", "bool", 0.0, 1.0))
    samples = [*read_trace(io.BytesIO(example.encode()), "trace", signals, 0.1)]
    assert samples == [{"distance": 8.0, "has_key": 0.0}, {"distance": 7.5, "has_key": 1.0}]
    code, _ = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    exec(code, {})
    digest = TapeDigest()
    for sample in samples:
        digest.add(TapeHeader("keydoor", {signal.name: {} for signal in signals}), sample)
    assert capsys.readouterr().out == f"{digest.text}\n"
    assert f"# {digest.text}\n" in code
