"""How the monitors' programs handle arguments, the syntax of traces, errors, and closed or full
output.

The Python program also reads JSON lines. Its tests are in ``tests/monitor``, except the tests of
standard output, which are here.
"""

from __future__ import annotations

import os
import signal
import subprocess
from collections.abc import Callable, Sequence
from pathlib import Path
from threading import Timer

import pytest

from tests.backends.monitors import FAR, HEAD, expected, trace_of
from tests.tools.conformance.runner import (
    LONGEST_RUN_S,
    Outcome,
    Runner,
    build,
    build_program,
    runners,
    words_for,
    write,
)
from tltlc.io.limits import TRACE_LINE
from tltlc.tools.conformance.case import ConformanceCase
from tltlc.tools.conformance.corpus import CASES

NAME = "cover_and_hide"
ROW_BYTES = TRACE_LINE.size
SPELLINGS = [
    b"\xef\xbb\xbfhealth,distance(s1),distance(s2),distance(exit)\n1,20,20,20\n",
    b'\xef\xbb\xbf"health",distance(s1),distance(s2),distance(exit)\n1,20,20,20',
    b'\r\n\r\n health ,\t"distance(s1)" ,distance(s2), distance(exit)\r\n\r\n 1 , 20\t,2e1,"20" \r\n\r\n',
    b'x,health,distance(s1),distance(s2),distance(exit)\n"a,\nb""c",True,20,20,+20.\n',
    # A cell of the maximal size.
    b"x,health,distance(s1),distance(s2),distance(exit)\n"
    + b"-" * (ROW_BYTES - len(b",1,20,20,20"))
    + b",1,20,20,20\n",
    b'x,health,distance(s1),distance(s2),distance(exit)\n"'
    + b"\n" * (ROW_BYTES - len(b'"",1,20,20,20'))
    + b'",1,20,20,20',
]

# Traces and the expected messages; `…` stands for text that differs between languages.
ERRORS = [
    ("", "the trace contains no sample"),
    ("\n\n", "the trace contains no sample"),
    (HEAD, "the trace contains no sample"),
    ("health,distance(s1)\n1\n", "line 1: the trace has no column for `distance(s2)` and `distance(exit)`"),
    ("\ndistance(exit)\n1\n", "line 2: the trace has no column for `distance(s1)`, `distance(s2)` and `health`"),
    ("health,distance(s1),distance(s2)\n1\n", "line 1: the trace has no column for `distance(exit)`"),
    ('{"health": 1}\n', "the trace is JSON, but this program reads only CSV: `tltlc monitor` reads both"),
    (' \t{, "health" 1}\n', "the trace is JSON, but this program reads only CSV: `tltlc monitor` reads both"),
    (f"health,{HEAD}1,1,1,1,1\n", "line 1: two columns are called `health`"),
    (f"{HEAD}1,1\n", "line 2: 2 values for 4 columns"),
    (f"{HEAD}x,1,1,1\n", "line 2: the signal `health` is `x`, not a number"),
    (f"{HEAD}0x1,1,1,1\n", "line 2: the signal `health` is `0x1`, not a number"),
    (f"{HEAD}--1,1,1,1\n", "line 2: the signal `health` is `--1`, not a number"),
    (f"{HEAD},1,1,1\n", "line 2: the signal `health` is ``, not a number"),
    (f"{HEAD}nan,1,1,1\n", "step 1: …`health`"),
    (f"{HEAD}-Inf,1,1,1\n", "step 1: …`health`"),
    (f"{HEAD}1e999,1,1,1\n", "step 1: …`health`"),
    (f'{HEAD}"1,1,1,1\n', "line 2: a quote is not closed"),
    (f'{HEAD}"1"2,1,1,1\n', "line 2: a cell continues after its closing quote"),
    (f"{HEAD}1\r,1,1,1\n", "line 2: a carriage return without a line feed"),
    (f"{HEAD}\0,1,1,1\n", "line 2: it is not UTF-8, or contains a NUL"),
    (f"{HEAD}\n{'-' * (ROW_BYTES + 1)}\n", "line 3: more than 1048576 bytes"),
    (f"{HEAD}1,1,1,{' ' * 3 * ROW_BYTES}1", "line 2: more than 1048576 bytes"),
    (f'{HEAD}1,1,1,"{chr(10) * ROW_BYTES}\xe9', "line 2: more than 1048576 bytes"),
    # Long runs of digits, on which a backtracking regular expression would take quadratic time.
    (f"{HEAD}{'1' * 200_000}x,1,1,1\n", "line 2: the signal `health` is `1…not a number"),
    (f"{HEAD}1{' ' * 200_000}1,1,1,1\n", "line 2: the signal `health` is `1…not a number"),
    (f"{HEAD}1,0.5,0.5,20\n", "step 1: `near(s1)` and `near(s2)` hold at once, against …"),
]
USAGE = [[], ["--full"], ["-", "--full"], ["--full", "a", "b"], ["--what", "a"]]

Run = Callable[..., Outcome]
RunAll = Callable[[Sequence[bytes]], list[Outcome]]
Program = tuple[Runner, Path, list[str]]


@pytest.fixture(scope="session")
def case() -> ConformanceCase:
    return CASES[NAME]()


# test_conformance.py reports which runners cannot be used here, and why.
USABLE = [runner for runner in runners() if runner.name != "python" and runner.missing() is None]
WITH_PYTHON = [*USABLE, *(runner for runner in runners() if runner.name == "python")]

FULL = Path("/dev/full")
# In these languages, the engine prints and does not report whether it succeeded.
UNAWARE = {"gdscript", "gdscript3"}
# In these languages, the interpreter or library opens the null device in place of a closed standard output.
REOPENING = {"csharp", "javascript", "rust"}


# Their programs read many traces in one process.
SLOW_TO_START = ("gdscript3", "node")


@pytest.fixture(scope="session")
def programs() -> dict[str, Program]:
    """The programs built so far, by the name of the runner.

    In a random order, the tests of one runner need not follow one another, so programs are kept.
    """
    return {}


@pytest.fixture(scope="session", params=USABLE, ids=lambda runner: runner.name)
def program(
    request: pytest.FixtureRequest,
    case: ConformanceCase,
    programs: dict[str, Program],
    tmp_path_factory: pytest.TempPathFactory,
) -> Program:
    """The program of a language: its runner, its folder, and the command that starts it there."""
    runner: Runner = request.param
    if runner.name not in programs:
        folder = tmp_path_factory.mktemp(runner.name)
        write(runner, case.fspa, folder)
        build(runner, NAME, folder)
        programs[runner.name] = runner, folder, words_for(runner.run, NAME)
    return programs[runner.name]


@pytest.fixture(scope="session")
def run(program: Program) -> Run:
    """A function that runs the program on a trace, which it gets both as a file and on standard
    input."""
    _, folder, command = program

    def run(*arguments: str, trace: str | bytes = "") -> Outcome:
        data = trace.encode() if isinstance(trace, str) else trace
        (folder / "trace.csv").write_bytes(data)
        process = subprocess.run(
            [*command, *arguments], cwd=folder, input=data, capture_output=True, timeout=LONGEST_RUN_S
        )
        # Some engines print lines of their own first.
        out = process.stdout.decode()
        return (
            process.returncode,
            out[out.index("step,state,") :] if "step,state," in out else "",
            process.stderr.decode(),
        )

    return run


@pytest.fixture
def outcomes(program: Program, run: Run, case: ConformanceCase, tmp_path: Path) -> RunAll:
    """A function that runs the program on many traces, with ``--full``."""
    runner, _, _ = program
    if runner.name in SLOW_TO_START:
        together = build_program(runner, [case.fspa], tmp_path)
        return lambda traces: together([(NAME, trace) for trace in traces])
    return lambda traces: [run("--full", "trace.csv", trace=trace) for trace in traces]


def test_files_and_standard_input_give_the_same_rows(run: Run, case: ConformanceCase) -> None:
    samples = [{**FAR, "distance(s1)": 0.3}, {**FAR, "distance(s2)": 7.7}, {**FAR, "health": -1.0}]
    status, out, err = expected(case.fspa, samples)
    short = "".join(line.rsplit(",", 5)[0] + "\n" for line in out.splitlines())
    trace = trace_of(samples, [*FAR])
    assert run("--full", "trace.csv", trace=trace) == (status, out, err)
    assert run("trace.csv", trace=trace) == (status, short, err)
    assert run("-", trace=trace) == (status, short, err)


def test_a_trace_may_be_written_in_several_ways(outcomes: RunAll, case: ConformanceCase) -> None:
    expected_outcome = expected(case.fspa, [FAR])
    for trace, outcome in zip(SPELLINGS, outcomes(SPELLINGS), strict=True):
        assert outcome == expected_outcome, trace[:200]


def test_invalid_traces_are_rejected(outcomes: RunAll) -> None:
    traces = [trace.encode() for trace, _ in ERRORS]
    for trace, (_, message), (status, out, err) in zip(traces, ERRORS, outcomes(traces), strict=True):
        start, _, rest = f"error: {message}".partition("…")
        assert (status, out) == (1, ""), trace[:200]
        assert err.startswith(start) and rest in err and err.count("\n") == 1, (trace[:200], err[:200])


def test_rows_before_an_unreadable_line_are_printed(run: Run) -> None:
    status, out, err = run("trace.csv", trace=f"{HEAD}1,20,20,20\n2,20,20,20\n1,20,?,20\n")
    assert (status, out.count("\n")) == (1, 3)
    assert err == (
        "error: line 4: the signal `distance(s2)` is `?`, not a number\n"
        "warning: step 2: the signal `health` is 2, outside [0, 1]: it counts as 1\n"
    )


@pytest.mark.parametrize("byte", [b"\0", b"\xe9", b"\r"])
def test_standard_input_is_read_as_bytes(run: Run, byte: bytes) -> None:
    trace = f"{HEAD}1,20,20,20\n1,20,".encode() + byte + b",20\n"
    assert run("-", trace=trace) == run("trace.csv", trace=trace)
    assert run("-", trace=trace)[2].startswith("error: line 3: ")


def test_rows_are_written_as_samples_arrive(program: Program) -> None:
    """A game that is still running may write the trace. Godot reads all input first, so it is
    skipped."""
    runner, folder, command = program
    if runner.target in UNAWARE:
        pytest.skip("Godot reads standard input to its end")
    with subprocess.Popen([*command, "-"], cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as running:
        assert running.stdin is not None and running.stdout is not None
        # Kill a program that waits for more input, so that the test ends.
        deadline = Timer(2 * LONGEST_RUN_S, running.kill)
        deadline.start()
        for number in (1, 2):
            running.stdin.write(f"{HEAD if number == 1 else ''}1,20,20,20\n".encode())
            running.stdin.flush()
            header = running.stdout.readline() if number == 1 else b"step,"
            assert header.startswith(b"step,")
            assert running.stdout.readline().startswith(f"{number},".encode())
        running.stdin.close()
        deadline.cancel()
    assert running.returncode == 0


@pytest.mark.parametrize("path", ["missing.csv", "."])
def test_unreadable_files_are_reported(run: Run, path: str) -> None:
    status, out, err = run(path)
    assert (status, out) == (3, "")
    assert err.startswith(f"error: cannot read `{path}`") and err.count("\n") == 1


@pytest.mark.parametrize("arguments", USAGE, ids=" ".join)
def test_wrong_usage_is_rejected(run: Run, arguments: list[str]) -> None:
    status, out, err = run(*arguments)
    assert (status, out) == (2, "")
    assert err.startswith("usage: ")


with_python = pytest.mark.parametrize(
    "program", WITH_PYTHON, indirect=True, ids=lambda runner: runner.name, scope="session"
)


def reporting_program(program: Program) -> tuple[Path, list[str]]:
    """Return the folder and the command of the program; skip a program that cannot report a failed output."""
    runner, folder, command = program
    if runner.target in UNAWARE:
        pytest.skip(f"{runner.name}: the engine does not say whether it could print")
    return folder, command


def full_device() -> Path:
    if not FULL.exists():
        pytest.skip(f"there is no {FULL}, a device without room")
    return FULL


@with_python
@pytest.mark.parametrize("rest", ["", "1,20,20,20\n" * 20_000, "1,20,?,20\n"], ids=["one row", "many", "an error"])
def test_full_standard_output_exits_with_3(program: Program, rest: str) -> None:
    folder, command = reporting_program(program)
    (folder / "trace.csv").write_text(f"{HEAD}2,20,20,20\n{rest}")
    with full_device().open("wb") as full:
        process = subprocess.run(
            [*command, "--full", "trace.csv"], cwd=folder, stdout=full, stderr=subprocess.PIPE, timeout=LONGEST_RUN_S
        )
    message, *warnings = process.stderr.decode().splitlines()
    assert process.returncode == 3
    assert message.startswith("error: cannot write to standard output: ")
    assert "no space left on device" in message.lower()
    assert warnings == ["warning: step 1: the signal `health` is 2, outside [0, 1]: it counts as 1"]


@with_python
def test_full_standard_error_does_not_change_the_exit_status(program: Program) -> None:
    folder, command = reporting_program(program)
    for trace, status in ((f"{HEAD}2,20,20,20\n", 3), (f"{HEAD}1,20,?,20\n", 1)):
        (folder / "trace.csv").write_text(trace)
        with full_device().open("wb") as full:
            process = subprocess.run(
                [*command, "trace.csv"], cwd=folder, stdout=full, stderr=full, timeout=LONGEST_RUN_S
            )
        assert process.returncode == status


@with_python
def test_closed_standard_output_exits_with_3(program: Program) -> None:
    folder, command = reporting_program(program)
    if program[0].target in REOPENING:
        pytest.skip(f"{program[0].name}: rows go to the null device where standard output is closed")
    (folder / "trace.csv").write_text(f"{HEAD}1,20,20,20\n")
    command_with_closed_output = ["sh", "-c", 'exec "$@" >&-', "sh", *command, "trace.csv"]
    process = subprocess.run(command_with_closed_output, cwd=folder, capture_output=True, timeout=LONGEST_RUN_S)
    assert (process.returncode, process.stderr) == (3, b"error: cannot write to standard output: it is closed\n")


@with_python
@pytest.mark.parametrize("by_signal", [True, False], ids=["by signal", "by error"])
def test_a_closed_pipe_ends_the_program_quietly(program: Program, by_signal: bool) -> None:
    """The system sends SIGPIPE, unless the parent process ignores this signal."""
    folder, command = reporting_program(program)
    (folder / "trace.csv").write_text(f"{HEAD}2,20,20,20\n")
    reading, writing = os.pipe()
    os.close(reading)
    try:
        process = subprocess.run(
            [*command, "trace.csv"],
            cwd=folder,
            stdout=writing,
            stderr=subprocess.PIPE,
            restore_signals=by_signal,
            timeout=LONGEST_RUN_S,
        )
    finally:
        os.close(writing)
    # A shell returns 141 for the signal.
    assert process.returncode in ((141, -signal.SIGPIPE) if by_signal else (141,))
    assert process.stderr == b""


@with_python
def test_a_pipe_closed_during_the_run_ends_the_program_quietly(program: Program) -> None:
    folder, command = reporting_program(program)
    running = subprocess.Popen(
        [*command, "-"], cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    with running:
        assert running.stdin is not None and running.stdout is not None and running.stderr is not None
        deadline = Timer(2 * LONGEST_RUN_S, running.kill)
        deadline.start()
        running.stdin.write(f"{HEAD}1,20,20,20\n".encode())
        running.stdin.flush()
        assert running.stdout.readline().startswith(b"step,")
        assert running.stdout.readline().startswith(b"1,")
        running.stdout.close()
        running.stdin.write(b"1,20,20,20\n")
        running.stdin.flush()
        # The program ends although more input could follow.
        assert running.wait() in (141, -signal.SIGPIPE)
        assert running.stderr.read() == b""
        deadline.cancel()
