"""Fuzzing of the compiler's readers: each accepts a file, or rejects it with a TltlError."""

from __future__ import annotations

import json
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from random import Random
from typing import Final

import pytest
from hypothesis import given

import tltlc
from tests.fuzzing import NUMBERS, PIECES, SEEDS, VALUES, check, mutated_bytes, mutated_json, mutated_text, times
from tests.interfaces.cli.conftest import ROOT
from tltlc.backends import emit
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.interfaces.playground.protocol import RequestError, answer
from tltlc.io.json_text import loads
from tltlc.io.limits import ARTEFACT
from tltlc.io.project import read_project
from tltlc.monitor import Monitor
from tltlc.monitor.run import outcome, run
from tltlc.monitor.traces import read_trace
from tltlc.pipeline import CompileOptions, compile_source, read_artefact
from tltlc.resolve.options import ResolveOptions
from tltlc.tools.hoa.load import ImportOptions
from tltlc.tools.hoa.load import load as load_hoa
from tltlc.tools.mine.evidence_reader import read_evidence
from tltlc.tools.mine.trace_letters import TraceFile

LIBRARY: Final = SourceFile(
    "library.tltl",
    "signal a: bool\nsignal b: bool\nsignal v in [0, 1]\nparam bound in [0, 2] = 1\n"
    "predicate p in [-1, 1] = v - bound / 2\n",
)
SPECS: Final = tltlc.compile_text(
    f"{LIBRARY.text}spec endless {{ semantics infinite  require G F a & G F p }}\nspec stops = F(a & X p)\n"
)
ARTEFACTS: Final = [
    json.loads(emit("json", fspa)[f"{fspa.name}.fspa.json"])
    for fspa in (*SPECS, *tltlc.compile_file(ROOT / "examples" / "cover_and_hide.tltl"))
]
AUTOMATA: Final = [
    *(str(next(iter(emit("hoa", fspa).values()))) for fspa in SPECS),
    'HOA: v1\nStates: 2\nStart: 0\nAP: 2 "a" "b"\nAlias: @x 0 & !1\nacc-name: Buchi\nAcceptance: 1 Inf(0)\nproperties: '
    'deterministic\n--BODY--\nState: 0 "first"\n[@x] 1 {0}\n[!@x | f] 0\nState: [t] 1 {0}\n1\n--END--\n',
]
PROJECT: Final = (
    'libraries = ["library"]\ntargets = ["json", "dot"]\n\n[style]\nnotation = "ascii"\nformatting = "words"\n\n'
    '[lint]\nallow = ["TLT0419"]\nwarning = ["TLT0420"]\n'
)
TRACES: Final = (
    "a,v,x\n" + "".join(f"{step % 2},{step / 7:.3f},{step}\n" for step in range(8)),
    "".join(json.dumps({"a": step % 2 == 0, "v": step / 7, "x": step}) + "\n" for step in range(8)),
    "".join(
        json.dumps(line) + "\n"
        for line in (
            {"tape": 1, "game": "it", "seed": 1, "clock_hz": 10, "signals": {"a": {"type": "bool"}, "v": {}, "x": {}}},
            *({"action": [step], "signals": {"a": step % 2 == 0, "v": step / 7, "x": step}} for step in range(8)),
        )
    ),
)
REQUEST: Final = {
    "text": f"{LIBRARY.text}spec s = F a & F p",
    "spec": "s",
    "letters": [["a"], {"a": 1, "b": 0, "v": 0.5}],
    "notation": "english",
}


@given(seed=SEEDS)
@times(200)
def test_artefacts_are_read_or_rejected(seed: int) -> None:
    random = Random(seed)
    text = mutated_json(random, random.choice(ARTEFACTS))

    def read() -> None:
        fspa = read_artefact(SourceFile("it.fspa.json", text))
        Monitor(fspa)
        emit("json", fspa)
        emit("python", fspa)

    check(read)


@given(seed=SEEDS)
@times(200)
def test_hoa_files_are_read_or_rejected(seed: int) -> None:
    random = Random(seed)
    text = mutated_text(random, random.choice(AUTOMATA))
    options = ImportOptions(state_budget=500, work=200_000)
    check(lambda: load_hoa(SourceFile("it.hoa", text), LIBRARY, options))


@pytest.fixture(name="folder", scope="module")
def _folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("project")
    (folder / "library").mkdir()
    return folder


@given(seed=SEEDS)
@times(200)
def test_mutated_project_files_never_crash_the_reader(seed: int, folder: Path) -> None:
    path = folder / "tltl.toml"
    path.write_text(mutated_text(Random(seed), PROJECT), encoding="utf-8", errors="replace")
    check(lambda: read_project(path))


def _trace(random: Random) -> bytes:
    data = mutated_text(random, random.choice(TRACES)).encode("utf-8", "surrogatepass")
    return mutated_bytes(random, data) if random.random() < 0.2 else data


@given(seed=SEEDS)
@times(400)
def test_traces_are_read_or_rejected(seed: int) -> None:
    trace = BytesIO(_trace(Random(seed)))
    fspa = SPECS[1]
    check(lambda: outcome(run(Monitor(fspa), read_trace(trace, "it", fspa.signals))))


@given(seed=SEEDS)
@times(100)
def test_traces_to_be_mined_are_read_or_rejected(seed: int) -> None:
    random = Random(seed)
    good, bad = (TraceFile(name, _trace(random)) for name in ("good", "bad"))
    library = random.choice((LIBRARY, None))
    check(lambda: read_evidence([good], [bad], library, ResolveOptions()))


@given(seed=SEEDS)
@times(50)
def test_requests_to_the_playground_are_answered_or_rejected(seed: int) -> None:
    try:
        answered = answer(mutated_json(Random(seed), REQUEST))
    except RequestError:
        return
    assert "a bug in tltlc" not in answered


@pytest.mark.parametrize("value", dict.fromkeys((*NUMBERS, *VALUES, *PIECES)))
def test_params_are_read_or_rejected(value: str) -> None:
    source = SourceFile("it.tltl", f"{LIBRARY.text}spec s = F p\n")
    check(lambda: compile_source(source, CompileOptions(params={"bound": value})))


# --- numbers that are too large for floats --------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("9223372036854775807", 2**63 - 1),
        ("-9223372036854775808", -(2**63)),
        ("9223372036854775808", 2.0**63),
        ("1" + "0" * 400, float("inf")),
        ("-" + "9" * 10_000, float("-inf")),
        ("123", 123),
    ],
    ids=lambda text: str(text)[:25],
)
def test_whole_numbers_of_json_become_int_or_float(text: str, value: float) -> None:
    number = loads(text, ARTEFACT)
    assert (number, type(number)) == (value, type(value))


@pytest.mark.parametrize(
    "number", ["1" + "0" * 400, "9" * 5000, "9223372036854775808", "-9_223_372_036_854_775_809", "0x" + "f" * 17]
)
def test_whole_numbers_of_toml_over_64_bits_are_rejected(number: str, folder: Path) -> None:
    (folder / "tltl.toml").write_text(f"targets = {number}\n", encoding="utf-8")
    with pytest.raises(TltlError, match="is not TOML: a whole number is too large") as error:
        read_project(folder / "tltl.toml")
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.code == "TLT0701"
    assert [label.source.text[label.span.start : label.span.end] for label in diagnostic.labels] == [number]


@pytest.mark.parametrize("number", ["9223372036854775807", "0x7fffffffffffffff", "-9_223_372_036_854_775_808"])
def test_whole_numbers_of_toml_within_64_bits_are_read(number: str, folder: Path) -> None:
    (folder / "tltl.toml").write_text(f"targets = {number}\n", encoding="utf-8")
    with pytest.raises(TltlError, match="TLT0703"):
        read_project(folder / "tltl.toml")


HOA: Final = (
    'HOA: v1\nStates: 1\nStart: 0\nAP: 1 "a"\nAcceptance: 1 Inf(0)\n--BODY--\nState: 0 {0}\n[0] 0\n[!0] 0\n--END--\n'
)


@pytest.mark.parametrize("number", ["1234567890", "2147483648", "9" * 5000])
@pytest.mark.parametrize("place", ["[0]", "Inf(0)", "{0}", "State: 0"])
def test_large_numbers_of_hoa_are_rejected(place: str, number: str) -> None:
    source = SourceFile("it.hoa", HOA.replace(place, place.replace("0", number)))
    with pytest.raises(TltlError) as error:
        load_hoa(source, LIBRARY, ImportOptions())
    assert {diagnostic.code for diagnostic in error.value.diagnostics} == {"TLT0651"}


def test_an_error_in_an_artefact_with_a_large_number_is_reported() -> None:
    text = json.dumps(ARTEFACTS[1]).replace('"spec_size": ', '"more": ' + "9" * 5000 + ', "spec_size": "x", "": ')
    read: Callable[[], object] = lambda: read_artefact(SourceFile("it.fspa.json", text))  # noqa: E731
    assert not check(read)
