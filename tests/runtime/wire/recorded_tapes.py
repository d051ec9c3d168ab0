"""Check the tapes that the recorder of a client has written: all clients record the same play."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Final

import jsonschema

from tests.docs.blocks import ROOT
from tests.waiting import HANG_S
from tltl_runtime import Tape, read_tape

SCHEMA: Final = jsonschema.Draft202012Validator(
    json.loads((ROOT / "tltlc" / "monitor" / "tape.schema.json").read_text(encoding="utf-8"))
)
STEPS: Final = 130
DIGESTS: Final = {60: "c5894051", 120: "a15886e6"}
"""The digests of the play by the number of their step."""

GDSCRIPT: Final = """\
var recorder = Tltl.Recorder.new("FOLDER", ["near(a, b)", "size", "seen"], 60, "walk")
var sizes = [pow(2, -1074), -0.0, 1e-300, 1e22, -123456.789, 0.1]
recorder.begin("crypt", "v1", 7)
recorder.sample({"near(a, b)": NAN, "size": 2, "seen": false}, 0)
recorder.sample({"near(a, b)": 1, "size": 2, "seen": false}, {"move": [1, NAN]})
for step in range(1, 131):
	var signals = {"near(a, b)": step / 3.0, "size": sizes[step % 6], "seen": false}
	if step == 3:
		signals["near(a, b)"] = true
	if step > 128:
		signals["seen"] = step - 129
	recorder.sample(signals, [step % 3, 1.0 if step % 2 else 1])
recorder.begin()
recorder.sample({"near(a, b)": 1, "size": 2, "seen": false})
print(recorder.sample({"near(a, b)": 1, "size": 2, "seen": false}, 1), recorder.problem)
recorder.begin("crypt", null, 7)
recorder.sample({"near(a, b)": 1, "size": 2, "seen": false}, 1)
recorder.end()"""
"""The body of a function that records the play in Godot, then an episode without actions, and one without a variant.

The recorder refuses the first two samples, and yet the tape says what `begin` was given. In some steps, a number has
a bool as its value, and a bool a number.
"""


def signals(step: int) -> dict[str, float | bool]:
    """Return the signals of the play after a step, from 1: fractions, whole numbers, and numbers of all sizes."""
    sizes = [5e-324, -0.0, 1e-300, 1e22, -123456.789, 0.1]
    return {"near(a, b)": step / 3, "size": sizes[step % 6], "seen": step == STEPS}


def action(step: int) -> list[int]:
    return [step % 3, 1]


def check_tape(path: Path, tmp_path: Path, *, game: str = "walk") -> Tape:
    """Check the tape of the whole play, which was recorded beside its trace, and return it."""
    for line in path.read_text(encoding="utf-8").splitlines():
        SCHEMA.validate(json.loads(line))
    tape = read_tape(path)
    header = tape.header
    assert (header.game, header.scene, header.variant, header.seed) == (game, "crypt", "v1", 7)
    assert (header.clock_hz, header.spec) == (60, None)
    assert [(name, header.is_bool(name)) for name in header.signals] == [
        ("near(a, b)", False),
        ("size", False),
        ("seen", True),
    ]
    assert [step.action for step in tape.steps] == [action(step) for step in range(1, STEPS + 1)]
    assert [step.signals for step in tape.steps] == [signals(step) for step in range(1, STEPS + 1)]
    assert digests(path) == DIGESTS
    _check_verdicts(path, tmp_path)
    return tape


def check_tape_without_a_variant(path: Path) -> None:
    """Check the tape of an episode that ``begin`` was given null as the variant of: it is that of no variant."""
    for line in path.read_text(encoding="utf-8").splitlines():
        SCHEMA.validate(json.loads(line))
    header = read_tape(path).header
    assert (header.scene, header.variant, header.seed) == ("crypt", "v0", 7)


def digests(path: Path) -> dict[int, str]:
    """Return the digests of a tape by the number of their step."""
    lines = path.read_text(encoding="utf-8").splitlines()
    return {
        number: json.loads(line)["digest"]
        for number, line in enumerate(lines)
        if number and "digest" in json.loads(line)
    }


def _check_verdicts(path: Path, tmp_path: Path) -> None:
    """Check that the tape and its trace are judged alike, step by step."""
    spec = tmp_path / "see.tltl"
    spec.write_text(
        "clock 60 Hz\nentity a, b\nsignal near(a, b): number in [0, 50]\nsignal seen: bool\n"
        "spec see {\n  reach near(a, b) > 40 then seen\n  limit 10 s\n}\n",
        encoding="utf-8",
    )
    trace = path.with_name(path.name.replace(".tape.jsonl", ".csv"))
    judged = []
    for file in (path, trace):
        words = [sys.executable, "-m", "tltlc", "monitor", str(spec), str(file), "--table"]
        judged.append(subprocess.run(words, capture_output=True, text=True, timeout=HANG_S, check=False).stdout)
    assert judged[0] == judged[1]
    assert judged[0].endswith(f"accepted: satisfied after {STEPS} steps\n"), judged[0][-200:]
