"""Ctrl-C at moments at which Python itself would handle it differently."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tests.waiting import HANG_S

ROOT = Path(__file__).parents[3]

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="needs a signal that reaches one process alone")

_SLOW = """
import sys, time
print("imports", flush=True)
try:
    time.sleep(0.3)
except BaseException:
    raise ImportError("a library that says something else") from None
"""


def _start(folder: Path, script: str) -> subprocess.Popen[str]:
    script = f"from tltlc.interfaces.cli.interrupts import end_on_signals\n{script}"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(folder), str(ROOT)])}
    return subprocess.Popen([sys.executable, "-c", script], env=environment, stdout=-1, stderr=-1, text=True)


def _run(folder: Path, script: str) -> subprocess.CompletedProcess[str]:
    """Run a process that is interrupted by itself at most."""
    with _start(folder, script) as running:
        out, err = running.communicate(timeout=HANG_S)
    return subprocess.CompletedProcess(running.args, running.returncode, out, err)


def _interrupt_at_line(folder: Path, script: str, expected_line: str) -> tuple[int, str, str]:
    """Interrupt a process as soon as it prints ``expected_line``; return its status, output and
    messages."""
    (folder / "slow.py").write_text(_SLOW, encoding="utf-8")
    with _start(folder, script) as running:
        assert running.stdout is not None
        assert running.stdout.readline() == expected_line
        running.send_signal(signal.SIGINT)
        out, err = running.communicate(timeout=HANG_S)
    return running.returncode, out, err


def test_an_import_finishes_before_its_interrupt(tmp_path: Path) -> None:
    script = "import time\nwith end_on_signals():\n    import slow\n    print('imported')\n    time.sleep(60)"
    status, out, err = _interrupt_at_line(tmp_path, script, "imports\n")
    assert (status, err) == (130, "")
    # On a slow machine, the interrupt may arrive right after the import, also before the end of the line.
    assert "imported\n".startswith(out)


def test_an_interrupt_ends_an_endless_import(tmp_path: Path) -> None:
    (tmp_path / "endless.py").write_text("import slow, time\nwhile True:\n    time.sleep(0.01)\n", encoding="utf-8")
    script = "with end_on_signals():\n    print('begins', flush=True)\n    import endless"
    status, _, err = _interrupt_at_line(tmp_path, script, "begins\n")
    assert (status, err) == (130, "")


def test_an_interrupt_at_exit_changes_nothing(tmp_path: Path) -> None:
    script = (
        "import atexit, sys, time\n"
        "atexit.register(lambda: (print('ends', flush=True), time.sleep(0.5)))\n"
        "with end_on_signals():\n    sys.exit(1)"
    )
    assert _interrupt_at_line(tmp_path, script, "ends\n") == (1, "", "")


def test_an_ignored_signal_stays_ignored(tmp_path: Path) -> None:
    script = (
        "import signal, time\nsignal.signal(signal.SIGINT, signal.SIG_IGN)\n"
        "with end_on_signals():\n    print('works', flush=True)\n    time.sleep(0.5)\n    print('over')"
    )
    assert _interrupt_at_line(tmp_path, script, "works\n") == (0, "over\n", "")


def test_an_error_after_an_interrupt_is_not_reported_as_a_bug(tmp_path: Path) -> None:
    script = (
        "import time\nfrom tltlc.interfaces.cli import command_line, main\n"
        "def broken(*_):\n"
        "    print('works', flush=True)\n"
        "    try:\n        time.sleep(60)\n"
        "    except KeyboardInterrupt:\n        raise SystemError('an exception is set') from None\n"
        "command_line.CommandLine.get_command = broken\n"
        "import sys; sys.argv = ['tltlc', 'check']\n"
        "main.main()"
    )
    assert _interrupt_at_line(tmp_path, script, "works\n") == (130, "", "")


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", "SIGHUP"])
def test_a_signal_after_the_command_gives_its_own_status(name: str, tmp_path: Path) -> None:
    script = (
        "import signal, sys\nfrom tltlc.interfaces.cli import interrupts, main\n"
        "stop = interrupts._stop_listening\n"
        "def stop_late():\n"
        "    interrupts._stop_listening = stop\n"
        # By then SIGINT is ignored; the test sends it a moment earlier.
        "    signal.signal(signal.SIGINT, interrupts.interrupt)\n"
        f"    signal.raise_signal(signal.{name})\n"
        "interrupts._stop_listening = stop_late\n"
        "sys.argv = ['tltlc', '--version']\n"
        "main.main()"
    )
    done = _run(tmp_path, script)
    assert (done.returncode, done.stderr) == (128 + getattr(signal, name), "")


HANDLERS = """
import signal
for name in ("SIGINT", "SIGTERM", "SIGHUP"):
    print(getattr(signal.getsignal(getattr(signal, name)), "__name__", "default"), flush=True)
"""


def test_a_child_process_has_the_default_handlers(tmp_path: Path) -> None:
    start = (
        f"with end_on_signals():\n    import subprocess, sys\n    subprocess.run([sys.executable, '-c', {HANDLERS!r}])"
    )
    # For SIGINT this is Python's own handler.
    assert _run(tmp_path, start).stdout.split() == ["default_int_handler", "default", "default"]


def test_a_forked_process_handles_sigint_and_has_the_other_defaults(tmp_path: Path) -> None:
    fork = (
        "import os\nwith end_on_signals():\n    child = os.fork()\n    if not child:\n"
        f"        exec({HANDLERS!r})\n        os._exit(0)\n    os.waitpid(child, 0)"
    )
    assert _run(tmp_path, fork).stdout.split() == ["interrupt", "default", "default"]
