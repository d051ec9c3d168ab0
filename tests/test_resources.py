"""The last bounds of a command: processor time and memory."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.waiting import HANG_S
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.io.limits import COMMAND
from tltlc.io.resources import OutOfTimeError, exhausted

if sys.platform == "win32":
    pytest.skip("Windows bounds neither", allow_module_level=True)

GOALS = "".join(f"signal a{i}: bool\n" for i in range(11)) + f"spec s = {' & '.join(f'F a{i}' for i in range(11))}\n"
"""Takes half a minute of processor time."""

MANY = "".join(f"signal s{i}: bool\nspec q{i} = F (s{i} & X s{i // 2})\n" for i in range(6_000))
"""Takes 80 MiB."""


def _run(*arguments: str, given: str = "") -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "tltlc", *arguments]
    return subprocess.run(command, input=given, capture_output=True, text=True, timeout=HANG_S, check=False)


def _script(script: str) -> subprocess.CompletedProcess[str]:
    head = "from tltlc.io.limits import Process\nfrom tltlc.io.resources import *\n"
    command = [sys.executable, "-c", head + script]
    return subprocess.run(command, capture_output=True, text=True, timeout=HANG_S, check=False)


def test_a_command_ends_after_its_processor_time(tmp_path: Path) -> None:
    (tmp_path / "goals.tltl").write_text(GOALS)
    ended = _run("--max-cpu", "1", "compile", str(tmp_path / "goals.tltl"), "-o", str(tmp_path / "out"))
    assert ended.returncode == 1
    assert ended.stderr == (
        "error[TLT0007]: the command was not done after 1 seconds of processor time\n"
        "  help: make its input smaller, or permit more: `tltlc --max-cpu SECONDS COMMAND …`\n"
    )
    assert not (tmp_path / "out").exists()


def test_a_command_ends_where_it_takes_too_much_memory() -> None:
    ended = _run("--max-memory", "0.05", "check", "-", given=MANY)
    assert ended.returncode == 1
    # Python prints a line of its own where there is no room to call a hook.
    assert ended.stderr.endswith(
        "error[TLT0007]: the command ran out of memory (it may use 0.05 GiB)\n"
        "  help: make its input smaller, or permit more: `tltlc --max-memory GIB COMMAND …`\n"
    )
    assert "Traceback" not in ended.stderr


@pytest.mark.parametrize("bounds", [(), ("--max-cpu", "0", "--max-memory", "0")])
def test_the_bounds_are_far_away(bounds: tuple[str, ...]) -> None:
    ended = _run(*bounds, "check", "-", given=MANY)
    assert (ended.returncode, ended.stderr) == (0, "<stdin>: 6000 specs, nothing to report\n")


@pytest.mark.parametrize(
    ("option", "value"),
    [
        *[("--max-cpu", value) for value in ("-1", "1.5", "9999999999", str(2**62))],
        *[("--max-memory", value) for value in ("nan", "8589934592", "1e300")],
    ],
)
def test_bounds_are_numbers(option: str, value: str) -> None:
    ended = _run(option, value, "list", "codes")
    assert ended.returncode == 2
    assert "TLT0700" in ended.stderr


def test_the_help_names_the_bounds() -> None:
    out = " ".join(_run("--help").stdout.split())
    assert "--max-cpu SECONDS End the work on files after so much processor time" in out
    assert f"[default: {COMMAND.work_s}" in out
    assert "--max-memory GIB" in out


def test_a_program_that_imports_tltlc_has_no_bounds() -> None:
    script = "import signal, resource\nbefore = resource.getrlimit(resource.RLIMIT_DATA)\nwith bounded():\n"
    script += "    assert signal.getitimer(signal.ITIMER_PROF) == (0.0, 0.0)\n"
    script += "    assert resource.getrlimit(resource.RLIMIT_DATA) == before\n"
    ended = _script(script)
    assert (ended.returncode, ended.stderr) == (0, "")


def test_bounds_end_with_the_work_that_has_them() -> None:
    script = (
        "import resource, signal\n"
        "before = resource.getrlimit(resource.RLIMIT_DATA), signal.getsignal(signal.SIGPROF)\n"
        "permit(Process(memory=1 << 30, work_s=100))\n"
        "with bounded():\n"
        "    with bounded():\n"
        "        pass\n"
        "    assert 0 < signal.getitimer(signal.ITIMER_PROF)[0] < 101\n"
        "    assert resource.getrlimit(resource.RLIMIT_DATA)[0] == 1 << 30\n"
        "assert signal.getitimer(signal.ITIMER_PROF)[0] == 0\n"
        "assert (resource.getrlimit(resource.RLIMIT_DATA), signal.getsignal(signal.SIGPROF)) == before\n"
    )
    ended = _script(script)
    assert (ended.returncode, ended.stderr) == (0, "")


def test_no_handler_of_exceptions_keeps_it_going() -> None:
    script = (
        "permit(Process(memory=0, work_s=1))\n"
        "class Dropped:\n"
        "    def __del__(self):\n"
        "        while True: pass\n"
        "try:\n"
        "    with bounded():\n"
        "        Dropped()\n"
        "        while True:\n"
        "            try: sum(range(1000))\n"
        "            except Exception: pass\n"
        "except OutOfTimeError: print('ended')\n"
    )
    assert _script(script).stdout == "ended\n"


def test_other_threads_have_no_bounds() -> None:
    script = (
        "import threading\n"
        "permit(Process(memory=1 << 30, work_s=100))\n"
        "def work():\n"
        "    with bounded(): print('worked')\n"
        "thread = threading.Thread(target=work)\nthread.start()\nthread.join()\n"
    )
    ended = _script(script)
    assert (ended.stdout, ended.stderr) == ("worked\n", "")


def test_a_process_is_limited_for_good() -> None:
    script = (
        "import resource\n"
        "limit('RLIMIT_DATA', 1 << 30)\nlimit('RLIMIT_DATA', 1 << 31)\nlimit('RLIMIT_OF_ANOTHER_SYSTEM', 1)\n"
        "print(*resource.getrlimit(resource.RLIMIT_DATA))\n"
    )
    ended = _script(script)
    assert (ended.stdout, ended.stderr) == (f"{1 << 30} {1 << 30}\n", "")


@pytest.mark.parametrize("error", [OutOfTimeError(), MemoryError(), RecursionError()])
def test_each_has_the_same_code(error: BaseException) -> None:
    reported = exhausted(error)
    assert isinstance(reported, TltlError)
    assert [each.code for each in reported.diagnostics] == ["TLT0007"]


def test_other_errors_are_not_meant() -> None:
    assert exhausted(ValueError()) is None


def test_what_a_destructor_runs_out_of_is_not_printed() -> None:
    done = _script("""
class Thing:
    def __init__(self, error):
        self.error = error

    def __del__(self):
        raise self.error

permit(Process(memory=0, work_s=100))
with bounded():
    Thing(MemoryError())
    Thing(OutOfTimeError())
    Thing(ValueError("inside"))
Thing(MemoryError("outside"))
""")
    assert done.returncode == 0
    assert "ValueError: inside" in done.stderr
    assert "MemoryError: outside" in done.stderr
    assert done.stderr.count("Traceback") == 2
