"""The corpus covers every operator, every error and every shape of automaton, and is the same in
each run."""

from __future__ import annotations

import csv
import io
import json
import math
import subprocess
import sys
from functools import cache
from pathlib import Path, PurePosixPath
from typing import get_args

import pytest

from tests.calls import calls
from tests.interfaces.cli.conftest import ROOT
from tltlc.automaton.fspa import Fspa
from tltlc.backends import emit
from tltlc.core.source import SourceFile
from tltlc.expression.tree import ArithmeticOp, Condition, ConditionOp, Const, Op, ParamValue, When, nodes
from tltlc.io.writing import write_files
from tltlc.monitor import Monitor
from tltlc.monitor.traces import read_trace
from tltlc.pipeline import CompileOptions, compile_text, read_artefact
from tltlc.tools.conformance import borders
from tltlc.tools.conformance.corpus import CASES, files
from tltlc.tools.conformance.draw import Draw
from tltlc.tools.conformance.expected_output import COLUMNS, RejectionKind
from tltlc.tools.conformance.traces import random_trace

FLAGS = ("true", "false")


@cache
def corpus() -> dict[str, bytes]:
    return {name: text.encode() if isinstance(text, str) else text for name, text in files().items()}


def texts(ending: str) -> dict[str, str]:
    return {name: text.decode() for name, text in corpus().items() if name.endswith(ending)}


@cache
def automata() -> tuple[Fspa, ...]:
    return tuple(read_artefact(SourceFile(name, text)) for name, text in texts(".fspa.json").items())


def rows() -> list[dict[str, str]]:
    return [row for text in texts(".expected.csv").values() for row in csv.DictReader(io.StringIO(text, newline=""))]


@pytest.mark.slow
def test_the_command_writes_the_same_bytes_in_every_process(tmp_path: Path) -> None:
    """The second process writes over the files of the first, one of which was changed."""
    for seed in ("1", "2"):
        command = [sys.executable, "-m", "tltlc", "conformance", "-o", str(tmp_path / "corpus")]
        environment = {"PYTHONHASHSEED": seed, "PYTHONPATH": str(ROOT), "HOME": str(tmp_path)}
        process = subprocess.run(command, capture_output=True, text=True, env=environment)
        assert process.returncode == 0, process.stderr
        assert f"wrote {len(CASES)} cases" in process.stderr
        written = {
            path.relative_to(tmp_path / "corpus").as_posix(): path.read_bytes()
            for path in (tmp_path / "corpus").rglob("*")
            if path.is_file()
        }
        assert written == corpus()
        (tmp_path / "corpus" / "check.py").write_text("changed")


def test_predicates_are_compiled_once_for_a_random_trace() -> None:
    # The measured value is 150 calls for each sample; compiling the predicates takes 1300.
    fspa = CASES["cover_and_hide"]().fspa
    assert calls(lambda: random_trace(fspa, Draw(1), 400)) < 400 * 400


def test_a_folder_holds_a_case_and_the_index_lists_all_files() -> None:
    index = json.loads(corpus()["index.json"])
    assert [case["name"] for case in index["cases"]] == list(CASES)
    assert len({name.lower() for name in CASES}) == len(CASES), "some file systems know one case of letters"
    listed = {"README.md", "check.py", "index.json"}
    for case in index["cases"]:
        assert case["about"]
        listed |= {case["artefact"], case["source"]} - {None}
        for trace in case["traces"]:
            stem = trace["trace"].removesuffix(".csv")
            assert trace["expected"] == f"{stem}.expected.csv"
            listed |= {trace["trace"], trace["expected"]} | ({f"{stem}.error.txt"} if trace["error"] else set())
            assert trace["rows"] == len(corpus()[f"{stem}.expected.csv"].splitlines()) - 1 or "names" in stem
    assert listed == set(corpus())


@pytest.mark.slow
def test_the_corpus_checks_monitors_by_itself(tmp_path: Path) -> None:
    """Run the check as its README says, with a correct and with a broken monitor."""
    write_files(tmp_path / "corpus", corpus())
    names = ("functions", "ranges", "trace_lines")
    for name in names:
        fspa = CASES[name]().fspa
        write_files(tmp_path / "build", emit("python", fspa))
    command = [sys.executable, "corpus/check.py", "--only", ",".join(names), sys.executable, "build/{name}_monitor.py"]
    process = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    count = sum(len(CASES[name]().traces) for name in names)
    assert (process.returncode, process.stdout) == (0, f"{count} traces, 0 of them not as expected\n"), process.stderr
    monitor = tmp_path / "build" / "ranges_monitor.py"
    monitor.write_text(monitor.read_text().replace("reward", "rewards"))
    command[3], count = "ranges,functions", sum(len(CASES[name]().traces) for name in ("ranges", "functions"))
    process = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert process.returncode == 1
    assert process.stdout.endswith(f"{count} traces, 1 of them not as expected\n")
    assert process.stdout.startswith("ranges/ranges.1.csv: ")
    assert subprocess.run(command[:2], cwd=tmp_path, capture_output=True).returncode == 2


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["no-such-program", "{name}"], "cannot start `no-such-program {name}`: "),
        ([sys.executable, "monitor.py"], "the command has no {name}"),
        (["--only", "cells,rang", sys.executable, "{name}"], "no case is called `rang`; there are ranges"),
    ],
)
def test_the_check_rejects_invalid_commands(words: list[str], message: str, tmp_path: Path) -> None:
    write_files(tmp_path, {name: corpus()[name] for name in ("check.py", "index.json")})
    command = [sys.executable, "check.py", *words]
    process = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert (process.returncode, process.stdout) == (2, "")
    assert process.stderr.startswith(f"error: {message}")
    assert process.stderr.count("\n") == 1


def test_cases_without_functions_of_the_library_are_exact() -> None:
    exact = {case["name"]: case["exact"] for case in json.loads(corpus()["index.json"])["cases"]}
    assert {"squares_and_cubes", "roots", "cover_and_hide", "cells"} <= {name for name in exact if exact[name]}
    assert not {"powers", "exponentials", "hyperbolic", "functions"} & {name for name in exact if exact[name]}


def test_expected_rows_match_the_monitor() -> None:
    for fspa in automata():
        monitor = Monitor(fspa)
        name = f"{fspa.name}/{fspa.name}.1"
        if f"{name}.error.txt" in corpus():
            continue
        lines = corpus()[f"{name}.expected.csv"].decode().splitlines()
        assert lines[0] == ",".join(COLUMNS)
        trace = io.BytesIO(corpus()[f"{name}.csv"])
        for number, sample in enumerate(read_trace(trace, name, fspa.signals, clock_varies=fspa.clock_varies), 1):
            step = monitor.step(sample)
            if "names" not in name:
                assert lines[number].startswith(f"{number},{step.state},{step.verdict},")


def test_sources_compile_to_the_artefacts() -> None:
    for name, text in texts(".tltl").items():
        spec = PurePosixPath(name).stem
        (fspa,) = compile_text(text, name, CompileOptions(specs=(spec,)))
        assert fspa in automata()


def test_cases_of_the_paper_equal_the_examples() -> None:
    for name in ("cover_and_hide", "navigation", "branching"):
        assert corpus()[f"{name}/{name}.tltl"] == (ROOT / "examples" / f"{name}.tltl").read_bytes()
        assert corpus()[f"{name}/{name}.1.csv"] == (ROOT / "examples" / f"{name}.csv").read_bytes()


def test_the_corpus_has_every_operator_of_expressions() -> None:
    expressions = [node for fspa in automata() for atom in fspa.atoms for node in nodes(atom.expression)]
    assert {node.op for node in expressions if isinstance(node, Op)} == set(get_args(ArithmeticOp))
    assert {node.op for node in expressions if isinstance(node, Condition)} == set(get_args(ConditionOp))
    powers = [node.args[1] for node in expressions if isinstance(node, Op) and node.op == "^"]
    assert {2.0, 3.0, 0.5, -1.5} <= {power.value for power in powers if isinstance(power, Const)}
    assert any(not isinstance(power, Const) for power in powers)
    whens = [node for node in expressions if isinstance(node, When)]
    assert any(isinstance(inner, When) for node in whens for inner in nodes(node) if inner is not node)
    assert any(isinstance(node, ParamValue) for node in expressions)


def test_the_corpus_has_every_operator_of_formulas() -> None:
    labels = " ".join(str(fspa.formula) for fspa in automata())
    for operator in ("F", "G", "X", "N", " U ", " W ", " R ", " M ", "!", " & ", " | ", " -> ", " <-> "):
        assert operator in labels, operator


def test_the_corpus_has_every_shape_of_automata() -> None:
    shapes = {(fspa.semantics, fspa.judge, fspa.limit_steps is None) for fspa in automata()}
    assert len(shapes) == 8, "finite and infinite, at the goal and at the limit, with and without one"
    assert any(fspa.exclusive for fspa in automata())
    assert {0, 1, 2, 3, 4} <= {fspa.spec_size for fspa in automata()}
    assert any(param.low is not None for fspa in automata() for param in fspa.params)
    assert {signal.type for fspa in automata() for signal in fspa.signals} >= {"bool", "number", "length", "ratio"}
    names = "".join(atom.name for fspa in automata() for atom in fspa.atoms)
    assert all(character in names for character in ",\"'\n\\漢𝒰")


@pytest.mark.parametrize(
    ("name", "signal", "values"),
    [("integers", "phase", {0.0, 1.0, 3.0, 4.0, 5.0}), ("enums", "mode(g1)", {0.0, 1.0, 2.0})],
)
def test_the_corpus_has_integers_and_enums(name: str, signal: str, values: set[float]) -> None:
    (fspa,) = (fspa for fspa in automata() if fspa.name == name)
    (declared,) = (each for each in fspa.signals if each.name == signal)
    assert declared.type == "int"
    assert declared.high is not None
    assert [each.values for each in fspa.signals].count(("idle", "alert", "chase")) == (2 if name == "enums" else 0)
    assert fspa.registers
    given, states = [], set()
    for number in (1, 2):
        trace = corpus()[f"{name}/{name}.{number}.csv"].decode()
        given += [float(row[signal]) for row in csv.DictReader(io.StringIO(trace))]
        expected_rows = corpus()[f"{name}/{name}.{number}.expected.csv"].decode()
        states |= {row["state"] for row in csv.DictReader(io.StringIO(expected_rows))}
    assert values <= set(given)
    assert any(not value.is_integer() for value in given), "between two values"
    assert any(value > declared.high for value in given), "out of range"
    assert len(states) > 3


def test_the_corpus_has_every_kind_of_row() -> None:
    expected_rows = rows()
    assert {row["verdict"] for row in expected_rows} == {"satisfied", "holding", "pending", "violated"}
    assert {(row["accepting"], row["done"]) for row in expected_rows} == {(a, d) for a in FLAGS for d in FLAGS}
    numbers = {row[column] for row in expected_rows for column in ("progress", "reward", "robustness")}
    assert "0" in numbers
    assert "-0" not in numbers
    assert {bool(row["limiting"]) for row in expected_rows} == {True, False}
    assert sum(row["done"] == "true" and row["reward"] == "0" for row in expected_rows) > 50, "steps past the end"


def test_the_corpus_has_every_kind_of_error() -> None:
    kinds = [text.splitlines()[0].removeprefix("kind: ") for text in texts(".error.txt").values()]
    assert set(kinds) == set(get_args(RejectionKind))
    cases = json.loads(corpus()["index.json"])["cases"]
    assert any(trace["warnings"] for case in cases for trace in case["traces"] if not trace["error"])


def test_the_corpus_stays_small() -> None:
    assert 40 <= len(CASES) <= 120
    assert all(text.count("\n") < 200 for text in texts(".expected.csv").values())


def test_comparisons_next_to_their_thresholds_are_judged_as_the_exact_ones() -> None:
    cases = {"borders": borders.EXTREMES}
    cases |= {f"borders_{number}": borders.random_borders(Draw(8000 + number), 8) for number in range(1, 4)}
    for name, compared in cases.items():
        rows = csv.DictReader(io.StringIO(corpus()[f"{name}/{name}.1.csv"].decode()))
        verdicts = []
        for row in rows:
            pairs = [(float(row[f"x{n}"]), float(row.get(f"y{n}", "nan"))) for n in range(1, len(compared) + 1)]
            truths = [
                border.holds(x, None if math.isnan(y) else y) for border, (x, y) in zip(compared, pairs, strict=True)
            ]
            verdicts.append("holding" if all(truths) else "pending")
        expected_rows = csv.DictReader(io.StringIO(corpus()[f"{name}/{name}.1.expected.csv"].decode()))
        assert [row["verdict"] for row in expected_rows] == verdicts
        assert {"holding", "pending"} <= set(verdicts)
