"""The limits of a command on processor time and memory."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.waiting import HANG_S
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.io.limits import COMMAND
from tltlc.io.resources import OutOfTimeError, exhaustion_error

if sys.platform == "win32":
    pytest.skip("Windows bounds neither", allow_module_level=True)

GOALS = "".join(f"signal a{i}: bool\n" for i in range(11)) + f"spec s = {' & '.join(f'F a{i}' for i in range(11))}\n"
"""A source that takes half a minute of processor time."""


def many(specs: int) -> str:
    """Return a source with this number of specs; 6,000 take 80 MiB of memory."""
    return "".join(f"signal s{i}: bool\nspec q{i} = F (s{i} & X s{i // 2})\n" for i in range(specs))


def _run(*arguments: str, stdin: str = "") -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "tltlc", *arguments]
    return subprocess.run(command, input=stdin, capture_output=True, text=True, timeout=HANG_S, check=False)


def _script(script: str) -> subprocess.CompletedProcess[str]:
    head = "from tltlc.io.limits import ProcessLimit\nfrom tltlc.io.resources import *\n"
    command = [sys.executable, "-c", head + script]
    return subprocess.run(command, capture_output=True, text=True, timeout=HANG_S, check=False)


def test_a_command_stops_at_its_limit_of_processor_time(tmp_path: Path) -> None:
    (tmp_path / "goals.tltl").write_text(GOALS)
    result = _run("--max-cpu", "1", "compile", str(tmp_path / "goals.tltl"), "-o", str(tmp_path / "out"))
    assert result.returncode == 1
    assert result.stderr == (
        "error[TLT0007]: the command did not finish within 1 second of processor time\n"
        "  help: make its input smaller, or allow more: `tltlc --max-cpu SECONDS COMMAND …`\n"
    )
    assert not (tmp_path / "out").exists()


def test_a_command_stops_at_its_limit_of_memory() -> None:
    result = _run("--max-memory", "0.05", "check", "-", stdin=many(6_000))
    assert result.returncode == 1
    # Python may print another line first, if it has no memory to call the exception hook.
    assert result.stderr.endswith(
        "error[TLT0007]: the command ran out of memory (it may use 0.05 GiB)\n"
        "  help: make its input smaller, or allow more: `tltlc --max-memory GIB COMMAND …`\n"
    )
    assert "Traceback" not in result.stderr


@pytest.mark.parametrize("specs", [1_000, pytest.param(6_000, marks=pytest.mark.slow)])
@pytest.mark.parametrize("bounds", [(), ("--max-cpu", "0", "--max-memory", "0")])
def test_the_default_limits_are_generous(bounds: tuple[str, ...], specs: int) -> None:
    result = _run(*bounds, "check", "-", stdin=many(specs))
    assert (result.returncode, result.stderr) == (0, f"<stdin>: {specs} specs, nothing to report\n")


@pytest.mark.parametrize(
    ("option", "value"),
    [
        *[("--max-cpu", value) for value in ("-1", "1.5", "9999999999", str(2**62))],
        *[("--max-memory", value) for value in ("nan", "8589934592", "1e300")],
    ],
)
def test_invalid_limits_are_rejected(option: str, value: str) -> None:
    result = _run(option, value, "list", "codes")
    assert result.returncode == 2
    assert "TLT0700" in result.stderr


def test_the_help_shows_the_limits() -> None:
    out = " ".join(_run("--help").stdout.split())
    assert "--max-cpu SECONDS Stop a command after this much processor time" in out
    assert f"[default: {COMMAND.work_s}" in out
    assert "--max-memory GIB" in out


def test_a_program_that_imports_tltlc_has_no_limits() -> None:
    script = "import signal, resource\nbefore = resource.getrlimit(resource.RLIMIT_DATA)\nwith resource_limits():\n"
    script += "    assert signal.getitimer(signal.ITIMER_PROF) == (0.0, 0.0)\n"
    script += "    assert resource.getrlimit(resource.RLIMIT_DATA) == before\n"
    result = _script(script)
    assert (result.returncode, result.stderr) == (0, "")


def test_limits_end_with_the_bounded_block() -> None:
    script = (
        "import resource, signal\n"
        "before = resource.getrlimit(resource.RLIMIT_DATA), signal.getsignal(signal.SIGPROF)\n"
        "permit(ProcessLimit(memory=1 << 30, work_s=100))\n"
        "with resource_limits():\n"
        "    with resource_limits():\n"
        "        pass\n"
        "    assert 0 < signal.getitimer(signal.ITIMER_PROF)[0] < 101\n"
        "    assert resource.getrlimit(resource.RLIMIT_DATA)[0] == 1 << 30\n"
        "assert signal.getitimer(signal.ITIMER_PROF)[0] == 0\n"
        "assert (resource.getrlimit(resource.RLIMIT_DATA), signal.getsignal(signal.SIGPROF)) == before\n"
    )
    result = _script(script)
    assert (result.returncode, result.stderr) == (0, "")


@pytest.mark.slow
def test_no_exception_handler_can_ignore_the_time_limit() -> None:
    script = (
        "permit(ProcessLimit(memory=0, work_s=1))\n"
        "class Dropped:\n"
        "    def __del__(self):\n"
        "        while True: pass\n"
        "try:\n"
        "    with resource_limits():\n"
        "        Dropped()\n"
        "        while True:\n"
        "            try: sum(range(1000))\n"
        "            except Exception: pass\n"
        "except OutOfTimeError: print('ended')\n"
    )
    assert _script(script).stdout == "ended\n"


def test_other_threads_have_no_limits() -> None:
    script = (
        "import threading\n"
        "permit(ProcessLimit(memory=1 << 30, work_s=100))\n"
        "def work():\n"
        "    with resource_limits(): print('worked')\n"
        "thread = threading.Thread(target=work)\nthread.start()\nthread.join()\n"
    )
    result = _script(script)
    assert (result.stdout, result.stderr) == ("worked\n", "")


def test_a_limit_of_a_process_cannot_be_raised() -> None:
    script = (
        "import resource\n"
        "limit('RLIMIT_DATA', 1 << 30)\nlimit('RLIMIT_DATA', 1 << 31)\nlimit('RLIMIT_OF_ANOTHER_SYSTEM', 1)\n"
        "print(*resource.getrlimit(resource.RLIMIT_DATA))\n"
    )
    result = _script(script)
    assert (result.stdout, result.stderr) == (f"{1 << 30} {1 << 30}\n", "")


@pytest.mark.parametrize("error", [OutOfTimeError(), MemoryError(), RecursionError()])
def test_all_exhausted_resources_give_the_same_error_code(error: BaseException) -> None:
    reported = exhaustion_error(error)
    assert isinstance(reported, TltlError)
    assert [diagnostic.code for diagnostic in reported.diagnostics] == ["TLT0007"]


def test_other_errors_are_not_reported_as_exhausted() -> None:
    assert exhaustion_error(ValueError()) is None


def test_exhausted_resources_in_a_destructor_are_not_printed() -> None:
    result = _script("""
class Thing:
    def __init__(self, error):
        self.error = error

    def __del__(self):
        raise self.error

permit(ProcessLimit(memory=0, work_s=100))
with resource_limits():
    Thing(MemoryError())
    Thing(OutOfTimeError())
    Thing(ValueError("inside"))
Thing(MemoryError("outside"))
""")
    assert result.returncode == 0
    assert "ValueError: inside" in result.stderr
    assert "MemoryError: outside" in result.stderr
    assert result.stderr.count("Traceback") == 2
