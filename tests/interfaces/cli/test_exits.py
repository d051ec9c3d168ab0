from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import click
import pytest

from tests.interfaces.cli.conftest import EXAMPLE, HIDE, ROOT
from tests.waiting import HANG_S, until_it_reads
from tltlc.interfaces.cli import exits


def test_clean_files_and_warnings_exit_with_0(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    clean = tltlc("check", "hide.tltl")
    assert (clean.status, clean.out) == (0, "")
    assert clean.err == "hide.tltl: 1 spec, nothing to report\n"
    Path("warned.tltl").write_text("signal a: bool  spec never = F a & G !a")
    warned = tltlc("check", "warned.tltl")
    assert warned.status == 0
    assert "warning[TLT0410]" in warned.err


def test_errors_exit_with_1(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("broken.tltl").write_text("spec hide = G !seen")
    Path("import.tltl").write_text("import nowhere\n" + HIDE)
    Path("latin.tltl").write_bytes(b"// \xe9")
    for name in ("broken.tltl", "import.tltl", "latin.tltl"):
        assert tltlc("check", name).status == 1, name


@pytest.mark.skipif(not Path("/proc/self/mem").exists(), reason="needs a file that opens and cannot be read")
def test_an_unreadable_import_exits_with_1(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("lib.tltl").symlink_to("/proc/self/mem")
    Path("import.tltl").write_text("import lib\n" + HIDE)
    outcome = tltlc("check", "import.tltl")
    assert (outcome.status, outcome.err.splitlines()[0][:37]) == (1, "error[TLT0010]: cannot read `lib.tltl")
    assert "imported here" in outcome.err


def test_all_files_are_checked_despite_an_unreadable_one(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    outcome = tltlc("check", "missing.tltl", "hide.tltl")
    assert outcome.status == 3
    assert "hide.tltl: 1 spec" in outcome.err


def test_an_unreadable_file_exits_with_3_despite_errors_in_others(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("broken.tltl").write_text("spec hide = G !seen")
    for command in ("check", "lint", "test", "fmt"):
        for names in (("broken.tltl", "missing.tltl"), ("missing.tltl", "broken.tltl")):
            assert tltlc(command, *names).status == 3, (command, names)
    assert tltlc("check", "--format", "json", "broken.tltl", "missing.tltl").status == 3
    assert tltlc("check", "broken.tltl", "hide.tltl:other").status == 2


@pytest.mark.parametrize(
    "arguments",
    [
        (),
        ("breaking",),
        ("compile",),
        ("bogus",),
        ("check", "--bogus", "hide.tltl"),
        ("check", "--format", "yaml", "hide.tltl"),
        ("check", "--param", "x", "hide.tltl"),
        ("check", "--param", "x=1", "--param", "x=2", "hide.tltl"),
        ("check", "--state-budget", "0", "hide.tltl"),
        ("check", "hide.tltl:other"),
        ("compile", "hide.tltl", "-t", "jsno"),
        ("compile", "hide.tltl", "--spec", "other"),
        ("render", "hide.tltl", "-o", "hide.bmp"),
        ("explain", "TLT9999"),
        ("list", "colours"),
        ("new", "."),
    ],
)
def test_wrong_usage_exits_with_2(arguments: tuple[str, ...], tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    before = sorted(inside.iterdir())
    assert tltlc(*arguments).status == 2
    assert sorted(inside.iterdir()) == before


def test_only_existing_options_are_suggested(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    assert "-o" not in tltlc("new", "hide.tltl/game").err
    assert "-o" in tltlc("compile", "hide.tltl", "-o", "hide.tltl/game").err


@pytest.mark.parametrize(
    "arguments",
    [
        ("check", "missing.tltl"),
        ("render", "."),
        ("check", "nul\0byte.tltl"),
        ("check", "n" * 300 + ".tltl"),
        ("check", "n" * 5000 + "/a.tltl"),
        ("check", "--library", "nowhere", "hide.tltl"),
        ("check", "--library", "n" * 5000, "hide.tltl"),
        ("test", "n" * 5000),
        ("new", "n" * 5000),
        ("compile", "hide.tltl", "-t", "json", "-o", "hide.tltl"),
        ("compile", "hide.tltl", "-t", "json", "-o", "hide.tltl/deeper"),
        ("render", "hide.tltl", "-o", "nowhere/hide.svg"),
        ("render", "hide.tltl", "-t", "dot", "-o", "."),
    ],
)
def test_unreadable_and_unwritable_paths_exit_with_3(arguments: tuple[str, ...], tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    outcome = tltlc(*arguments)
    assert outcome.status == 3
    assert outcome.err.startswith("error[TLT000")
    assert [path.name for path in inside.iterdir()] == ["hide.tltl"]


def test_a_bug_exits_with_70_without_a_traceback(tltlc, inside: Path, monkeypatch) -> None:  # type: ignore[no-untyped-def]
    def broken(*_: object, **__: object) -> None:
        raise ZeroDivisionError("secret")

    monkeypatch.setattr("tltlc.pipeline.Session.compiled", broken)
    outcome = tltlc("check", "hide.tltl")
    assert outcome.status == 70
    assert outcome.err.startswith("error: a bug in tltlc stopped this command (reference ")
    assert "Traceback" not in outcome.err
    assert tltlc("check", "hide.tltl").err == outcome.err
    monkeypatch.setenv("TLTLC_DEBUG", "1")
    assert "ZeroDivisionError: secret" in tltlc("check", "hide.tltl").err


def test_a_closed_pipe_is_quiet(inside: Path) -> None:
    reading, writing = os.pipe()
    os.close(reading)
    try:
        completed = subprocess.run(
            [sys.executable, "-m", "tltlc", "render", str(EXAMPLE), "-t", "dot"],
            stdout=writing,
            stderr=subprocess.PIPE,
            timeout=HANG_S,
            env={**os.environ, "PYTHONPATH": str(ROOT)},
            check=False,
        )
    finally:
        os.close(writing)
    assert (completed.returncode, completed.stderr) == (141, b"")


@pytest.mark.skipif(sys.platform != "linux", reason="looks at a process as Linux shows it")
def test_an_interrupt_is_quiet(inside: Path) -> None:
    command = [sys.executable, "-m", "tltlc", "check", "-"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment
    ) as running:
        # An earlier signal would arrive while Python itself starts.
        until_it_reads(running.pid)
        running.send_signal(signal.SIGINT)
        out, err = running.communicate(timeout=HANG_S)
    assert (running.returncode, out, err) == (130, b"", b"")


def test_no_arguments_show_the_help(process) -> None:  # type: ignore[no-untyped-def]
    outcome = process()
    assert (outcome.status, outcome.out) == (2, "")
    assert outcome.err == process("--help").out


def test_choices_are_printed_on_one_line(tltlc) -> None:  # type: ignore[no-untyped-def]
    names = ("predicates", "targets", "games", "levels", "codes")
    message = f"missing argument '{{{'|'.join(names)}}}'. Choose from: {', '.join(names)}\n"
    assert message in tltlc("list").err


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device without room")
def test_full_standard_output_exits_with_3() -> None:
    with Path("/dev/full").open("wb") as full:
        completed = subprocess.run(
            [sys.executable, "-m", "tltlc", "list", "codes"], stdout=full, stderr=-1, check=False, cwd=ROOT
        )
    assert completed.returncode == 3
    assert completed.stderr.startswith(b"error[TLT0005]: cannot write to standard output")


def test_a_missing_folder_is_reported_as_a_folder(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    outcome = tltlc("render", "hide.tltl", "-o", "nowhere/hide.svg")
    assert outcome.status == 3
    assert outcome.err.splitlines()[0].endswith("there is no such folder")


def test_the_summary_counts_files_with_errors(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    Path("broken.tltl").write_text("spec x = F b\n")
    Path("other.tltl").write_text("spec x = F c\n")
    outcome = tltlc("test", "broken.tltl", "other.tltl")
    assert outcome.out == "0 passed, 0 failed, 2 files with errors\n"
    assert "\n\nerror[" in outcome.err


@pytest.mark.parametrize(
    ("type_", "text", "message"),
    [
        (click.FLOAT, "1,5", "`1,5` is not a number; write 1.5"),
        (click.FloatRange(min=0.0), "fast", "`fast` is not a number"),
        (click.IntRange(min=0), "1.5", "`1.5` is not a whole number"),
    ],
)
def test_an_invalid_number_is_reported(
    type_: click.ParamType, text: str, message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    command = click.Command("wait", params=[click.Option(["--for"], type=type_)])
    with pytest.raises(click.UsageError) as error:
        command.main(["--for", text], standalone_mode=False)
    assert exits.report(error.value) == exits.USAGE
    assert capsys.readouterr().err.startswith(f"error[TLT0700]: invalid value for '--for': {message}\n")


def test_a_path_that_the_system_rejects_is_not_reported_as_a_bug(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(OSError, match="too long") as error:
        Path("a" * 300).stat()
    assert exits.report(error.value) == exits.UNREADABLE
    message = capsys.readouterr().err
    assert message.startswith(f"error[TLT0001]: cannot access `{'a' * 300}`: file name too long\n  help: ")


@pytest.mark.skipif(sys.platform == "win32", reason="needs limits of processes")
@pytest.mark.parametrize("files", [7, 10])
def test_a_system_limit_is_not_reported_as_a_bug(files: int, inside: Path) -> None:
    script = f"ulimit -n {files}; exec {sys.executable} -m tltlc serve --port 0"
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    completed = subprocess.run(
        ["/bin/sh", "-c", script], env=environment, capture_output=True, text=True, timeout=HANG_S
    )
    assert (completed.returncode, completed.stdout) == (3, "")
    assert completed.stderr == (
        "error[TLT0768]: this process cannot open more files\n"
        "  help: `ulimit -a` shows your limits: raise the one that is too small, or close other programs\n"
    )


def test_the_cause_of_an_exception_decides_the_message(capsys: pytest.CaptureFixture[str]) -> None:
    error = RuntimeError("no thread")
    error.__cause__ = MemoryError()
    assert exits.report(error) == exits.UNREADABLE
    assert "error[TLT0768]: there is not enough memory" in capsys.readouterr().err
