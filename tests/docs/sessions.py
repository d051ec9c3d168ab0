"""Run pages as a reader would: write their files, run their commands, and compare the output."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from tests.docs.blocks import ROOT
from tests.waiting import HANG_S

ANYTHING = "…"
ON_TERMINAL = "tltlc monitor "
"""Commands that begin like this print something else on a terminal than into a pipe."""
COLUMNS = "100"
"""The width of the terminal."""
_PART = re.compile(
    r"^```(?:toml|tltl|hoa|cpp|cs|gdscript|js|lua|python|rs)\n"
    r"(?P<text>(?:#|//|/\*|--) (?P<new>[\w./]+\.\w+)(?: \*/)?\n.*?)^```$"
    r"|^<!-- file (?P<data>\S+) -->\n```\w+\n(?P<content>.*?)^```$"
    r"|^```console\n(?P<session>.*?)^```$"
    r"|^<!-- in (?P<file>\S+): (?P<edit>.*?) -->$",
    re.DOTALL | re.MULTILINE,
)
_COMMAND = re.compile(r"^\$ (.*)\n((?:(?!\$ ).*\n)*)", re.MULTILINE)


class Shell:
    """A shell in a folder, with the commands of this checkout; it keeps the last exit status."""

    def __init__(self, folder: Path) -> None:
        programs = folder / "bin"
        programs.mkdir()
        for name, arguments in (("tltlc", " -m tltlc"), ("python", "")):
            (programs / name).write_text(f'#!/bin/sh\nexec "{sys.executable}"{arguments} "$@"\n')
            (programs / name).chmod(0o755)
        self._environment = {
            **os.environ,
            "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}",
            "PYTHONPATH": str(ROOT),
            "TLTLC_CACHE_DIR": "",
        }
        self.folder = folder
        self._status = 0

    def run(self, command: str) -> str:
        """Run a command and return its output, standard output before standard error.

        The standard output of some commands is a terminal, so that they print what a reader sees there.
        """
        if command.startswith("cd "):
            self.folder /= command[3:]
            return ""
        if command == "echo $?":
            return f"{self._status}\n"
        if command.startswith(ON_TERMINAL):
            return self._run_on_terminal(command)
        completed = subprocess.run(
            ["/bin/sh", "-c", command],
            cwd=self.folder,
            env=self._environment,
            capture_output=True,
            encoding="utf-8",
            timeout=HANG_S,
            check=False,
        )
        self._status = completed.returncode
        return completed.stdout + completed.stderr

    def _run_on_terminal(self, command: str) -> str:
        import pty

        terminal, output = pty.openpty()
        with tempfile.TemporaryFile() as errors, ThreadPoolExecutor() as pool:
            printed = pool.submit(_read, terminal)
            try:
                completed = subprocess.run(
                    ["/bin/sh", "-c", command],
                    cwd=self.folder,
                    env={**self._environment, "COLUMNS": COLUMNS},
                    stdout=output,
                    stderr=errors,
                    timeout=HANG_S,
                    check=False,
                )
            finally:
                os.close(output)
            self._status = completed.returncode
            errors.seek(0)
            return (printed.result() + errors.read()).decode().replace("\r\n", "\n")


def _read(terminal: int) -> bytes:
    """Return what is printed on a terminal until the other end is closed, and close this end."""
    printed = b""
    with os.fdopen(terminal, "rb", buffering=0) as file:
        try:
            while chunk := file.read(4096):
                printed += chunk
        except OSError:  # so Linux reports that the other end is closed
            pass
    return printed


def matches(printed: str, expected: str) -> bool:
    """Whether the printed text matches the shown text, in which a line `…` stands for any number of
    lines."""
    parts = [re.escape(part) for part in re.split(rf"^ *{ANYTHING}\n", expected, flags=re.MULTILINE)]
    return re.fullmatch(r"(?:.*\n)*".join(parts), printed) is not None


def run_page(text: str, shell: Shell) -> int:
    """Write the files of a page, run its commands and compare their output; return the number of
    commands."""
    commands = 0
    for part in _PART.finditer(text):
        if name := part["new"] or part["data"]:
            (shell.folder / name).write_text(part["text"] or part["content"], encoding="utf-8")
            continue
        if part["file"]:
            path = shell.folder / part["file"]
            before, after = part["edit"].split(" => ")
            source = path.read_text(encoding="utf-8")
            assert before in source, part[0]
            path.write_text(source.replace(before, after, 1), encoding="utf-8")
            continue
        for command, expected in _COMMAND.findall(part["session"]):
            printed = shell.run(command)
            assert matches(printed, expected), f"$ {command}\n{printed}"
            commands += 1
    return commands
