from __future__ import annotations

import gzip
import json
from collections.abc import Iterator
from pathlib import Path

import pytest

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.interfaces.cli import judged_traces
from tltlc.tools.judge.verdict import JudgedTrace

FETCH = """
clock 10 Hz
signal on_lava: bool
signal has_key: bool
signal at_exit: bool
spec fetch { reach has_key then at_exit  avoid on_lava }
"""
GOOD, LAVA, SHORT = "0,0,0\n0,1,0\n0,1,1\n", "0,0,0\n0,0,0\n1,1,0\n0,1,1\n", "0,1,0\n"


@pytest.fixture
def folder(inside: Path) -> Path:
    Path("fetch.tltl").write_text(FETCH)
    for name, rows in {"a.csv": GOOD, "b.csv": LAVA, "deep/c.csv": SHORT, "deep/d.csv": LAVA}.items():
        path = Path("traces", name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("on_lava,has_key,at_exit\n" + rows)
    return inside / "traces"


def test_a_folder_gives_a_line_for_each_trace_and_a_summary(folder: Path, tltlc) -> None:  # type: ignore[no-untyped-def]
    Path("traces/notes.txt").write_text("lava")
    judged = tltlc("monitor", "fetch.tltl", "traces")
    assert judged.status == 1
    assert judged.out.splitlines() == [
        "traces/a.csv: accepted: holding after 3 steps",
        "traces/b.csv: not accepted: breaks `avoid on_lava` at step 3 of 4",
        "traces/deep/c.csv: not accepted: `reach has_key then at_exit` is not met after 1 step",
        "traces/deep/d.csv: not accepted: breaks `avoid on_lava` at step 3 of 4",
        "1 of 4 accepted; 2 break `avoid on_lava`, at step 3; 1 ends before `reach has_key then at_exit` is met",
    ]
    assert judged.err == "not traces, by their names: traces/notes.txt\n"


def test_a_tape_is_judged_as_its_trace_and_once_in_a_folder(folder: Path, tltlc) -> None:  # type: ignore[no-untyped-def]
    names = ("on_lava", "has_key", "at_exit")
    header = {"tape": 1, "game": "fetch", "clock_hz": 10, "signals": {name: {"type": "bool"} for name in names}}
    for name, rows in (("a", GOOD), ("e", LAVA), ("f", GOOD)):
        values = [[cell == "1" for cell in row.split(",")] for row in rows.split()]
        steps = [{"action": 0, "signals": dict(zip(names, row, strict=True))} for row in values]
        text = "".join(json.dumps(line) + "\n" for line in (header, *steps)).encode()
        (folder / f"{name}.tape.jsonl.gz").write_bytes(gzip.compress(text))
        if name != "f":
            (folder / f"{name}.tape.jsonl").write_bytes(text)
    judged = tltlc("monitor", "fetch.tltl", "traces")
    assert [line.partition(": ")[0] for line in judged.out.splitlines()[:-1]] == [
        "traces/a.csv",
        "traces/b.csv",
        "traces/deep/c.csv",
        "traces/deep/d.csv",
        "traces/e.tape.jsonl",
        "traces/f.tape.jsonl.gz",
    ]
    assert "traces/e.tape.jsonl: not accepted: breaks `avoid on_lava` at step 3 of 4\n" in judged.out
    assert judged.err == ""
    trace, unpacked, packed = (
        tltlc("monitor", "fetch.tltl", f"traces/a{ending}") for ending in (".csv", ".tape.jsonl", ".tape.jsonl.gz")
    )
    assert trace.out == unpacked.out == packed.out
    assert (trace.status, unpacked.status, packed.status) == (0, 0, 0)


def test_the_status_is_0_if_all_traces_are_accepted(folder: Path, tltlc) -> None:  # type: ignore[no-untyped-def]
    Path("again.csv").write_bytes(Path("traces/a.csv").read_bytes())
    judged = tltlc("monitor", "fetch.tltl", "traces/a.csv", "again.csv")
    assert (judged.status, judged.out.splitlines()[-1]) == (0, "2 of 2 accepted")


def test_json_has_each_trace_and_counts_of_the_causes(folder: Path, tltlc) -> None:  # type: ignore[no-untyped-def]
    Path("traces/e.csv").write_text("on_lava\n1\n")
    judged = tltlc("monitor", "fetch.tltl", "traces", "--json")
    document = json.loads(judged.out)
    assert [trace["accepted"] for trace in document["traces"]] == [True, False, False, False, None]
    cause = {"kind": "broken", "step": 3, "clauses": ["avoid on_lava"], "atoms": ["on_lava"]}
    assert document["traces"][1]["cause"] == cause
    assert [diagnostic["code"] for diagnostic in document["traces"][4]["diagnostics"]] == ["TLT0621"]
    assert (document["total"], document["accepted"], document["unread"]) == (5, 1, 1)
    assert document["unread_codes"] == {"TLT0621": 1}
    assert [(group["kind"], group["count"], group["usual_step"]) for group in document["causes"]] == [
        ("broken", 2, 3),
        ("unfinished", 1, 1),
    ]


def test_one_trace_that_cannot_be_judged_keeps_no_other_from_being_judged(folder: Path, tltlc) -> None:  # type: ignore[no-untyped-def]
    Path("traces/b.csv").write_text("on_lava,has_key\n0,0\n")
    judged = tltlc("monitor", "fetch.tltl", "traces")
    assert judged.status == 1
    assert "traces/b.csv: cannot be judged: " in judged.out
    assert judged.out.splitlines()[-1].endswith("; 1 cannot be judged (1 TLT0621)")
    assert "error[TLT0621]" in judged.err


def test_wrong_times_are_reported_for_one_trace_and_for_many(folder: Path, tltlc) -> None:  # type: ignore[no-untyped-def]
    Path("traces/b.csv").write_text("time,on_lava,has_key,at_exit\n0,0,0,0\n0.3,0,0,0\n")
    assert "error[TLT0623]" in tltlc("monitor", "fetch.tltl", "traces").err
    assert "error[TLT0623]" in tltlc("monitor", "fetch.tltl", "traces/b.csv").err


def test_an_artefact_is_enough(folder: Path, tltlc) -> None:  # type: ignore[no-untyped-def]
    tltlc("compile", "fetch.tltl", "-t", "json")
    last = tltlc("monitor", "fetch.fspa.json", "traces").out.splitlines()[-1]
    unmet = "1 ends before `reach has_key, then at_exit` is met"
    assert last == f"1 of 4 accepted; 2 break `avoid on_lava`, at step 3; {unmet}"


def test_many_workers_print_the_same(folder: Path, tltlc) -> None:  # type: ignore[no-untyped-def]
    for number in range(60):
        Path(f"traces/more_{number}.csv").write_bytes(Path("traces/deep/d.csv").read_bytes())
    alone = tltlc("monitor", "fetch.tltl", "traces", "--workers", "1")
    assert tltlc("monitor", "fetch.tltl", "traces", "--workers", "2") == alone
    assert alone.out.splitlines()[-1].startswith("1 of 64 accepted; 62 break `avoid on_lava`, at step 3; ")


def test_parquet_is_read_like_csv(folder: Path, tltlc) -> None:  # type: ignore[no-untyped-def]
    pyarrow = pytest.importorskip("pyarrow", reason="pyarrow is not installed")
    from pyarrow import parquet

    columns = {"on_lava": [False, True], "has_key": [0, 1], "at_exit": [0.0, None], "note": ["a", "b"]}
    parquet.write_table(pyarrow.table(columns), "lava.parquet")
    steps = tltlc("monitor", "fetch.tltl", "lava.parquet")
    assert "error[TLT0612]" in steps.err or "error[TLT0611]" in steps.err
    parquet.write_table(pyarrow.table({**columns, "at_exit": [0.0, 1.0]}), "lava.parquet")
    assert tltlc("monitor", "fetch.tltl", "lava.parquet").err.splitlines()[-1] == (
        "not accepted: violated at step 2 (0.1 s) of 2: `on_lava`, clause 2"
    )
    many = tltlc("monitor", "fetch.tltl", "lava.parquet", "traces/a.csv")
    assert many.out.splitlines()[0] == "lava.parquet: not accepted: breaks `avoid on_lava` at step 2 of 2"
    Path("torn.parquet").write_bytes(Path("lava.parquet").read_bytes()[:-9])
    assert (
        "error[TLT0622]: `torn.parquet` is not a valid Parquet file"
        in tltlc("monitor", "fetch.tltl", "torn.parquet").err
    )


@pytest.mark.parametrize(
    ("arguments", "status", "words"),
    [
        (["traces", "-"], 2, "a summary needs traces in files"),
        (["-", "--summary"], 2, "a summary needs traces in files"),
        (["empty"], 3, "the folder `empty` contains no trace"),
        (["empty", "traces"], 3, "the folder `empty` contains no trace"),
        (["other.tltl", "traces"], 2, "`other.tltl` is a spec, not a trace"),
        (["traces", "nowhere.csv"], 3, "nowhere.csv"),
        (["traces", "--workers", "0"], 2, "--workers"),
        ([], 2, "TRACE"),
    ],
)
def test_wrong_arguments_are_named(arguments: list[str], status: int, words: str, folder: Path, tltlc) -> None:  # type: ignore[no-untyped-def]
    Path("empty").mkdir()
    judged = tltlc("monitor", "fetch.tltl", *arguments)
    assert judged.status == status
    assert words in judged.err


def test_a_folder_without_traces_keeps_no_other_from_being_judged(folder: Path, tltlc) -> None:  # type: ignore[no-untyped-def]
    Path("empty").mkdir()
    assert tltlc("monitor", "fetch.tltl", "empty", "traces").out.splitlines()[-1].startswith("1 of 4 accepted; ")


def test_a_summary_of_a_single_trace_names_the_clause(folder: Path, tltlc) -> None:  # type: ignore[no-untyped-def]
    assert tltlc("monitor", "fetch.tltl", "traces/b.csv", "--summary").out.splitlines() == [
        "traces/b.csv: not accepted: breaks `avoid on_lava` at step 3 of 4",
        "0 of 1 accepted; 1 breaks `avoid on_lava`, at step 3",
    ]


def test_episodes_end_at_the_limit(folder: Path, tltlc) -> None:  # type: ignore[no-untyped-def]
    Path("fetch.tltl").write_text(FETCH.replace("}", "limit 2 steps }"))
    whole = tltlc("monitor", "fetch.tltl", "traces/a.csv", "--summary")
    assert whole.out.splitlines()[-1] == "1 of 1 accepted"
    assert whole.err == (
        "traces/a.csv is longer than the limit of 2 steps and judged whole: `--episodes` ends it there\n"
    )
    episode = tltlc("monitor", "fetch.tltl", "traces/a.csv", "--episodes")
    assert (episode.status, episode.err) == (1, "")
    clause = "`reach has_key then at_exit`"
    assert (
        episode.out.splitlines()[0]
        == f"traces/a.csv: not accepted: {clause} is not met at the limit, after 2 of 3 steps"
    )


@pytest.mark.parametrize(
    ("name", "data", "words"),
    [
        ("a.csv", "on_lava,has_key\n".encode("utf-16"), "it is UTF-16, not UTF-8"),
        ("a.csv", b'[{"on_lava": 0}]\n', "this is a JSON list, not CSV"),
        ("a.parquet", b"on_lava,has_key,at_exit\n0,0,0\n", "`a.parquet` is not a valid Parquet file"),
        ("a.csv", b"sep=,\non_lava,has_key,at_exit\n", "the first line has to name the columns"),
    ],
)
def test_files_that_are_no_traces_are_called_what_they_are(  # type: ignore[no-untyped-def]
    name: str, data: bytes, words: str, folder: Path, tltlc
) -> None:
    Path(name).write_bytes(data)
    assert words in tltlc("monitor", "fetch.tltl", name).err
    assert words in tltlc("monitor", "fetch.tltl", name, "--summary").err


def test_the_json_document_is_complete_although_a_worker_dies(  # type: ignore[no-untyped-def]
    folder: Path, tltlc, monkeypatch: pytest.MonkeyPatch
) -> None:
    def lose(*_: object, **__: object) -> Iterator[JudgedTrace]:
        yield JudgedTrace("traces/a.csv", None, (Diagnostic("TLT0622", "torn"),))
        raise TltlError([Diagnostic("TLT0007", "a process ended")])

    monkeypatch.setattr(judged_traces, "judge_files", lose)
    judged = tltlc("monitor", "fetch.tltl", "traces", "--json")
    document = json.loads(judged.out)
    assert (judged.status, document["total"], len(document["traces"]), document["complete"]) == (1, 4, 1, False)
    assert "error[TLT0007]: a process ended" in judged.err
    assert (
        tltlc("monitor", "fetch.tltl", "traces").out.splitlines()[-1]
        == "0 of 1 accepted; 1 cannot be judged (1 TLT0622); 3 not judged"
    )


def test_names_cannot_control_the_terminal(folder: Path, tltlc) -> None:  # type: ignore[no-untyped-def]
    Path("traces/\x1b[31m\n.csv").write_text("on_lava,has_key,at_exit\n" + GOOD)
    out = tltlc("monitor", "fetch.tltl", "traces").out
    assert "\x1b" not in out
    assert len(out.splitlines()) == 6


def test_a_trace_that_is_named_twice_counts_once(folder: Path, tltlc) -> None:  # type: ignore[no-untyped-def]
    judged = tltlc("monitor", "fetch.tltl", "./traces/a.csv", "traces", "traces/")
    assert judged.out.splitlines()[-1].startswith("1 of 4 accepted; ")
