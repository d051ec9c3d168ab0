from __future__ import annotations

import csv
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import EXAMPLE, ROOT
from tests.waiting import HANG_S

TRACE = EXAMPLE.with_suffix(".csv")


def test_rows_and_the_judgement_are_printed(tltlc) -> None:  # type: ignore[no-untyped-def]
    judged = tltlc("monitor", EXAMPLE, TRACE)
    table = list(csv.reader(judged.out.splitlines()))
    assert table[0] == ["step", "state", "verdict", "progress", "reward", "near(s1)", "near(s2)", "near(exit)", "alive"]
    assert len(table) == len(TRACE.read_text().splitlines())
    assert [row[2] for row in table[1:]] == sorted((row[2] for row in table[1:]), reverse=True)
    assert (judged.status, judged.err) == (0, f"accepted: {table[-1][2]} after {len(table) - 1} steps\n")


def test_json_output_is_one_document(tltlc) -> None:  # type: ignore[no-untyped-def]
    judged = tltlc("monitor", f"{EXAMPLE}:cover_and_hide", TRACE, "--json")
    document = json.loads(judged.out)
    assert (document["accepted"], document["verdict"]) == (True, "holding")
    assert document["steps"] == len(document["rows"])
    assert document["rows"][-1]["atoms"].keys() == {"near(s1)", "near(s2)", "near(exit)", "alive"}


def test_a_trace_that_is_not_accepted_exits_with_1(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("part.csv").write_text("\n".join(TRACE.read_text().splitlines()[:3]) + "\n")
    judged = tltlc("monitor", EXAMPLE, "part.csv")
    assert (judged.status, judged.err.splitlines()[-1]) == (1, "not accepted: pending after 2 steps")
    assert json.loads(tltlc("monitor", EXAMPLE, "part.csv", "--json").out)["accepted"] is False


def test_an_artefact_takes_params(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    assert tltlc("compile", EXAMPLE, "-t", "json").status == 0
    artefact = "cover_and_hide.fspa.json"
    assert tltlc("monitor", artefact, TRACE).out == tltlc("monitor", EXAMPLE, TRACE).out
    wide = tltlc("monitor", artefact, TRACE, "--param", "level_size=100 m").out
    assert wide == tltlc("monitor", EXAMPLE, TRACE, "--param", "level_size=100 m").out
    assert wide != tltlc("monitor", EXAMPLE, TRACE).out


def test_json_lines_are_read_from_standard_input(process, inside: Path) -> None:  # type: ignore[no-untyped-def]
    lines = b'{"seen": false}\n{"seen": true}\n'
    assert process("monitor", "hide.tltl", "-", stdin=lines).status == 1
    assert process("monitor", "hide.tltl", "-", stdin=lines[:16]).status == 0
    assert process("monitor", "-", "-", stdin=lines).status == 2
    assert "both be standard input" in process("monitor", "-:hide", "-", stdin=lines).err


@pytest.mark.parametrize("trace", ["nowhere.csv", "."])
def test_an_unreadable_trace_exits_with_3(trace: str, tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    assert tltlc("monitor", "hide.tltl", trace).status == 3


@pytest.mark.parametrize(
    "text", ["", "seen\n", "other\n1\n", "seen\nperhaps\n", "seen\n0\nnan\n", "\0", "{", '{"seen": "x"}']
)
def test_an_invalid_trace_exits_with_1(text: str, tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("trace").write_text(text)
    outcome = tltlc("monitor", "hide.tltl", "trace")
    assert outcome.status == 1
    assert outcome.err.startswith("error[TLT06")
    document = tltlc("monitor", "hide.tltl", "trace", "--json").out
    assert json.loads(document)["accepted"] is None


def test_rows_are_printed_while_the_trace_is_recorded(inside: Path) -> None:
    command = [sys.executable, "-m", "tltlc", "monitor", "hide.tltl", "-"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment
    ) as running:
        assert running.stdin and running.stdout
        running.stdin.write("seen\n0\n")
        running.stdin.flush()
        assert running.stdout.readline().startswith("step,")
        assert running.stdout.readline().startswith("1,0,holding,")
        running.stdin.write("1\n")
        running.stdin.close()
        assert running.stdout.readline().startswith("2,1,violated,")
        assert running.wait(HANG_S) == 1


def test_a_clamped_value_is_reported_once(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("fit.tltl").write_text("signal health in [0, 1]\nspec fit = G health > 0\n")
    Path("trace.csv").write_text("health\n2\n3\n")
    judged = tltlc("monitor", "fit.tltl", "trace.csv")
    assert judged.status == 0
    assert judged.err.count("warning[TLT0615]") == 1


def test_passed_and_failed_tests_are_listed(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    block = 'test "{}" for hide {{\n    step not seen\n    expect {}\n}}\n'
    Path("hide.tltl").write_text(Path("hide.tltl").read_text() + block.format("hidden", "holding"))
    good = tltlc("test", "hide.tltl")
    assert (good.status, good.out, good.err) == (0, "passed  hide.tltl:3  hidden\n1 passed, 0 failed\n", "")
    Path("hide.tltl").write_text(Path("hide.tltl").read_text() + block.format("seen", "violated"))
    bad = tltlc("test", "hide.tltl")
    assert bad.status == 1
    assert bad.out.splitlines()[1:] == ["FAILED  hide.tltl:7  seen", "1 passed, 1 failed"]
    assert "hide.tltl:9:" in bad.err
    assert "TLT0640" in json.dumps(json.loads(tltlc("test", "hide.tltl", "--format", "json").err))


ENDLESS = """
signal a: bool
signal p: bool
spec again { semantics infinite  require G F a  keep p }
spec first { semantics infinite  reach a  require G F not a }
test "waiting is no failure" for again { step p expect holding step a, p expect holding step a expect violated }
test "the first must come" for first { step not a expect pending step a expect holding }
"""


def test_an_infinite_trace_that_ends_in_a_goal_is_accepted(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("endless.tltl").write_text(ENDLESS)
    assert tltlc("test", "endless.tltl").out.endswith("2 passed, 0 failed\n")
    Path("trace.csv").write_text("a,p\n0,1\n0,1\n")
    assert tltlc("compile", "endless.tltl", "-t", "json").status == 0
    for spec in ("endless.tltl:again", "again.fspa.json"):
        judged = tltlc("monitor", spec, "trace.csv")
        assert (judged.status, judged.err.splitlines()[-1]) == (0, "accepted: holding after 2 steps")
    judged = tltlc("monitor", "endless.tltl:first", "trace.csv")
    assert (judged.status, judged.err.splitlines()[-1]) == (1, "not accepted: pending after 2 steps")


def test_a_file_without_tests_is_reported(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("tested.tltl").write_text(Path("hide.tltl").read_text() + 'test "t" for hide { step seen expect violated }')
    Path("none").mkdir()
    Path("none/lib.tltl").write_text("signal a: bool")
    outcome = tltlc("test", "hide.tltl", "tested.tltl", "none")
    assert (outcome.status, outcome.out.splitlines()[-1]) == (0, "1 passed, 0 failed")
    assert [line.partition(";")[0] for line in outcome.err.splitlines()] == [
        "hide.tltl: it contains no test block",
        "none: it contains no test block",
    ]
    assert tltlc("test", ".").err == "", "some file of the folder has one"


def test_an_artefact_has_no_tests(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    assert tltlc("compile", "hide.tltl", "-t", "json").status == 0
    outcome = tltlc("test", "hide.fspa.json", "hide.tltl")
    assert outcome.status == 2
    assert outcome.err.startswith("error[TLT0722]: `hide.fspa.json` is an artefact")
    assert outcome.out == "0 passed, 0 failed, 1 file with errors\n"


def test_tests_of_a_folder_are_run(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("a/.hidden").mkdir(parents=True)
    assert tltlc("test", "a").status == 2
    Path("a/.hidden/broken.tltl").write_text("spec")
    assert tltlc("test", "a").status == 2
    Path("a/one.tltl").write_text(Path("hide.tltl").read_text() + 'test "t" for hide { step seen expect violated }')
    Path("a/broken.tltl").write_text("spec")
    outcome = tltlc("test", "a")
    assert outcome.status == 1
    assert "1 passed, 0 failed" in outcome.out
    assert tltlc("test", "nowhere").status == 3


def test_the_tests_of_libraries_and_examples_pass(tltlc) -> None:  # type: ignore[no-untyped-def]
    outcome = tltlc("test", ROOT / "examples", ROOT / "stdlib_predicates")
    assert (outcome.status, outcome.err) == (0, "")


def test_the_recorded_traces_are_accepted(tltlc) -> None:  # type: ignore[no-untyped-def]
    import tltlc as package

    for trace in sorted((ROOT / "examples").glob("*.csv")):
        source = trace.with_suffix(".tltl")
        first = package.compile_file(source)[0].name
        assert tltlc("monitor", f"{source}:{first}", trace).status == 0, trace
