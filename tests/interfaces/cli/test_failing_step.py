"""What `tltlc monitor` says of a trace that fails: the step, the clause, the atoms, and what remained."""

from __future__ import annotations

import json
import os
import pty
import sys
from pathlib import Path

import pytest

from tltlc.interfaces.cli.step_table import StepTable
from tltlc.monitor.monitor import Monitor
from tltlc.monitor.run import run
from tltlc.pipeline import compile_text

SPEC = """\
signal boss_door: bool
signal sword: bool
signal health in [0, 100]

spec boss {
    reach boss_door
    avoid boss_door and not once sword
    keep health > 20
}
"""


@pytest.fixture(autouse=True)
def spec(inside: Path) -> None:
    Path("boss.tltl").write_text(SPEC)


def trace(*rows: str) -> str:
    Path("run.csv").write_text("\n".join(["boss_door,sword,health", *rows, ""]))
    return "run.csv"


def test_the_step_the_atoms_and_the_clause_are_named(tltlc) -> None:  # type: ignore[no-untyped-def]
    judged = tltlc("monitor", "boss.tltl", trace("0,0,50", "0,0,30", "1,0,50", "1,1,50"))
    assert judged.status == 1
    assert judged.out.splitlines()[-4:] == [
        "boss.tltl:7: avoid boss_door and not once sword",
        "at step 3: boss_door is true, sword now or before is false",
        "what remained before: Reach boss_door; and keep not boss_door or sword now or before throughout, and keep "
        "health > 20 throughout.",
        "not accepted: violated at step 3 of 4: `boss_door` without `sword now or before`, clause 2",
    ]


def test_a_comparison_is_told_with_the_value_that_was_measured(tltlc) -> None:  # type: ignore[no-untyped-def]
    out = tltlc("monitor", "boss.tltl", trace("0,0,50", "0,0,12.3456")).out
    assert "boss.tltl:8: keep health > 20\nat step 2: health is 12.3\n" in out
    assert out.endswith("not accepted: violated at step 2 of 2: `health <= 20`, clause 3\n")


def test_the_json_document_has_the_failure_in_fields(tltlc) -> None:  # type: ignore[no-untyped-def]
    document = json.loads(tltlc("monitor", "boss.tltl", trace("0,0,50", "1,0,50"), "--json").out)
    failure = document["failure"]
    assert failure.pop("unmet").startswith("Reach boss_door; ")
    assert failure == {
        "failed_step": 2,
        "failed_clause": "avoid boss_door and not once sword",
        "failed_atom": "once sword",
        "clause": 2,
        "file": "boss.tltl",
        "line": 7,
        "atoms": {"boss_door": 1.0, "once sword": -1.0},
    }
    assert [row["failed_step"] for row in document["rows"]] == [None, 2]
    accepted = json.loads(tltlc("monitor", "boss.tltl", trace("0,1,50", "1,0,50"), "--json").out)
    assert (accepted["accepted"], accepted["failure"]) == (True, None)


def test_an_error_later_in_the_trace_does_not_hide_the_failure(tltlc) -> None:  # type: ignore[no-untyped-def]
    name = trace("1,0,50", "1,x,50")
    judged = tltlc("monitor", "boss.tltl", name)
    assert judged.out.endswith(
        "before the error: violated at step 1: `boss_door` without `sword now or before`, clause 2\n"
    )
    assert "error[TLT0622]" in judged.err
    document = json.loads(tltlc("monitor", "boss.tltl", name, "--json").out)
    assert (document["accepted"], document["verdict"], document["failure"]["failed_step"]) == (None, None, 1)


def test_an_artefact_knows_the_clauses_but_not_their_lines(tltlc) -> None:  # type: ignore[no-untyped-def]
    assert tltlc("compile", "boss.tltl", "-t", "json").status == 0
    out = tltlc("monitor", "boss.fspa.json", trace("1,0,50")).out
    assert "clause 2: avoid boss_door and not once sword\n" in out
    assert out.endswith("violated at step 1 of 1: `boss_door` without `sword now or before`, clause 2\n")


def test_what_remains_is_told_of_a_trace_that_is_too_short(tltlc) -> None:  # type: ignore[no-untyped-def]
    *_, remains, last = tltlc("monitor", "boss.tltl", trace("0,1,50")).out.splitlines()
    assert (remains, last) == (
        "what remains: Reach boss_door; and keep not boss_door or sword now or before throughout, and keep health > 20 "
        "throughout.",
        "not accepted: pending after 1 step",
    )


def test_a_test_that_expects_another_verdict_says_why_the_trace_fails(tltlc) -> None:  # type: ignore[no-untyped-def]
    test = '\ntest "a way in" for boss {\n    step boss_door\n    expect holding\n}\n'
    Path("boss.tltl").write_text(SPEC + test)
    assert "help: violated at step 1: `boss_door` without `sword now or before`, clause 2" in tltlc("test").err


def test_a_table_has_three_digits_and_says_what_is_to_do(tltlc) -> None:  # type: ignore[no-untyped-def]
    out = tltlc("monitor", "boss.tltl", trace("0,1,51.23456", "1,0,50"), "--table").out
    assert out.splitlines() == [
        "to do: Reach boss_door; and keep not boss_door or sword now or before throughout, and keep health > 20 "
        "throughout.",
        " step  verdict    progress     reward  boss_door  once sword  health > 20  sword",
        "    1  pending           0          0         no         yes         0.39    yes",
        "    2  holding           1          1        yes         yes        0.375     no",
        "to do: Keep not boss_door or sword now or before throughout, and keep health > 20 throughout.",
        "accepted: holding after 2 steps",
    ]


def test_a_table_leaves_out_atoms_for_which_there_is_no_room() -> None:
    (fspa,) = compile_text(SPEC)
    table = StepTable(fspa, width=60)
    (row,) = run(Monitor(fspa), [{"boss_door": True, "sword": True, "health": 50}])
    assert table.left_out == 2
    assert all(len(line) <= 60 for line in table.rows(row) if not line.startswith("to do"))


@pytest.mark.skipif(sys.platform == "win32", reason="there are no pseudo-terminals")
def test_the_table_is_the_default_on_a_terminal() -> None:
    name = trace("0,1,50", "1,0,50")
    parent, child = pty.openpty()
    process = os.fork()
    if process == 0:  # pragma: no cover
        os.dup2(child, 1)
        os.execv(sys.executable, [sys.executable, "-m", "tltlc", "monitor", "boss.tltl", name])
    os.close(child)
    out = b""
    while chunk := _read(parent):
        out += chunk
    assert os.waitstatus_to_exitcode(os.waitpid(process, 0)[1]) == 0
    assert b"to do: Reach boss_door" in out


def _read(terminal: int) -> bytes:
    try:
        return os.read(terminal, 4096)
    except OSError:  # the other end is closed
        return b""
