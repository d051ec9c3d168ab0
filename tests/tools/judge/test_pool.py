from __future__ import annotations

import gzip
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import ROOT
from tests.waiting import HANG_S, children, until_gone
from tltlc.io.limits import Limit
from tltlc.pipeline import compile_text
from tltlc.tools.judge import pool
from tltlc.tools.judge.clauses import clauses_of
from tltlc.tools.judge.pool import judge_files

(HIDE,) = compile_text("signal seen: bool\nspec hide = G !seen")
CLAUSES = clauses_of(HIDE, None)


@pytest.fixture
def traces(tmp_path: Path) -> list[str]:
    paths = [tmp_path / f"run_{number:02}.csv" for number in range(60)]
    for number, path in enumerate(paths):
        path.write_text("seen\n" + "0\n" * number + f"{number % 2}\n")
    return list(map(str, paths))


def test_workers_and_one_process_judge_alike_and_in_order(traces: list[str]) -> None:
    alone = list(judge_files(HIDE, CLAUSES, traces, 1))
    assert [trace.name for trace in alone] == traces
    assert [trace.verdict is not None and trace.verdict.outcome.accepted for trace in alone] == [True, False] * 30
    assert list(judge_files(HIDE, CLAUSES, traces, 3)) == alone


def test_a_trace_that_cannot_be_judged_keeps_no_other_from_being_judged(traces: list[str]) -> None:
    Path(traces[7]).write_text("heard\n1\n")
    Path(traces[8]).unlink()
    for workers in (1, 2):
        judged = list(judge_files(HIDE, CLAUSES, traces, workers))
        errors = {trace.name: trace.diagnostics[0].code for trace in judged if trace.verdict is None}
        assert errors == {traces[7]: "TLT0621", traces[8]: "TLT0001"}


def test_a_trace_that_does_not_fit_into_memory_is_refused(traces: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pool, "JUDGED_TRACE", Limit(size=20, values=100))
    (judged,) = judge_files(HIDE, CLAUSES, traces[30:31], 1)
    assert [diagnostic.code for diagnostic in judged.diagnostics] == ["TLT0004"]


def test_the_limits_of_a_packed_trace_are_those_of_its_text(
    traces: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(pool, "JUDGED_TRACE", Limit(size=1_000, values=100))
    packed = [tmp_path / name for name in ("few.csv", "many.csv", "long.csv")]
    for path, rows in zip(packed, (b"0\n" * 90, b"0\n" * 101, b"0" + b" " * 1_000), strict=True):
        path.write_bytes(gzip.compress(b"seen\n" + rows))
    judged = list(judge_files(HIDE, CLAUSES, [*map(str, packed)], 1))
    assert [[diagnostic.code for diagnostic in trace.diagnostics] for trace in judged] == [[], ["TLT0004"], ["TLT0004"]]


SCRIPT = """
import sys
from tltlc.pipeline import compile_text
from tltlc.tools.judge.clauses import clauses_of
from tltlc.tools.judge.pool import judge_files

if __name__ == "__main__":
    fspa, = compile_text("signal seen: bool  spec hide = G !seen")
    for judged in judge_files(fspa, clauses_of(fspa, None), sys.argv[1:], 2):
        print(judged.name, flush=True)
"""


def _is_worker(pid: int) -> bool:
    return "spawn_main" in Path(f"/proc/{pid}/cmdline").read_text()


@pytest.fixture
def running(traces: list[str], tmp_path: Path) -> Iterator[tuple[subprocess.Popen[str], list[int]]]:
    """A process that judges traces, the last of which never ends, and the ids of its two workers."""
    if sys.platform != "linux":
        pytest.skip("the workers of a process are known on Linux alone")
    os.mkfifo(tmp_path / "endless.csv")
    (tmp_path / "judge.py").write_text(SCRIPT)
    command = [sys.executable, "judge.py", *traces, "endless.csv"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment, cwd=tmp_path
    ) as process:
        assert process.stdout is not None
        process.stdout.readline()
        # One of the children tracks resources for multiprocessing.
        workers = [pid for pid in children(process.pid) if _is_worker(pid)]
        assert len(workers) == 2
        yield process, workers
        process.kill()


def test_no_worker_outlives_the_command(running: tuple[subprocess.Popen[str], list[int]]) -> None:
    process, workers = running
    process.kill()
    until_gone(workers)


def test_a_worker_that_dies_is_an_error(running: tuple[subprocess.Popen[str], list[int]]) -> None:
    process, workers = running
    for worker in workers:
        # The command ends the others once it sees that one has died.
        with suppress(ProcessLookupError):
            os.kill(worker, signal.SIGKILL)
    _, errors = process.communicate(timeout=HANG_S)
    assert "TLT0007: a process that judged traces ended unexpectedly" in errors


def test_ctrl_c_ends_the_workers_although_one_of_them_reads_a_file_without_end(
    running: tuple[subprocess.Popen[str], list[int]],
) -> None:
    process, workers = running
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=HANG_S)
    until_gone(workers)


def test_closing_the_iterator_ends_the_workers(traces: list[str]) -> None:
    judged = judge_files(HIDE, CLAUSES, traces, 2)
    next(judged)
    judged.close()
    if sys.platform == "linux":
        assert not [pid for pid in children(os.getpid()) if _is_worker(pid)]
