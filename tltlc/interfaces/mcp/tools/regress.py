"""The tool ``regress``: report which levels of a game still play as designed.

The command ``tltlc regress`` belongs to the runtime, which the compiler does not import. So it runs
in a child process.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Awaitable, Callable, Mapping
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

import anyio
from anyio.abc import Process
from anyio.streams.text import TextReceiveStream

from tltlc.diagnostics.shortening import short_text
from tltlc.interfaces.mcp.answer import Answer, WrongUseError
from tltlc.interfaces.mcp.schemas import PATHS, TEXTS, arguments, path_schema
from tltlc.interfaces.mcp.tool import Tool

Report = Callable[[float, str], Awaitable[None]]
"""A function that reports progress: a number that grows, and a line of text."""

_PROGRAM: Final = """\
import sys
sys.path[:] = {path!r}
from tltlc.io.parent_process import terminate_with_input
terminate_with_input({patience_s!r})
from tltlc.interfaces.cli.main import main
main()
"""

_PATIENCE_S: Final = 20.0
"""Seconds that the command may take to keep its results and end its processes after the call or the server ends."""

_FOUND: Final = (0, 1)
"""The exit statuses with which the command has a report."""
_WRONG_USE: Final = 2

_VALUES: Final = ("baseline", "spec", "now", "judged_as", "pass_rate", "fail_rate", "minutes", "workers", "output")
_FLAGS: Final = ("fresh", "retrain")
_OPTIONS: Final = {"output": "--out"}
"""The options whose names are not those of the arguments."""


async def run(arguments: Mapping[str, Any], report: Report) -> Answer:
    """Run ``tltlc regress`` with these arguments, and report each line that it prints about its progress.

    If the call is cancelled, the command keeps the cases that it has judged, and ends. Raises
    WrongUseError for a wrong use of the command.
    """
    if "suite" not in arguments and "spec" not in arguments:
        raise WrongUseError("give `suite`, a TOML file, or `spec` with `baseline` and `now` for recorded sessions")
    with TemporaryDirectory() as folder:
        file = Path(folder, "report.json")
        program = _PROGRAM.format(path=sys.path, patience_s=_PATIENCE_S)
        words = [sys.executable, "-c", program, "regress", f"--json={file}", *command_words(arguments)]
        status, output, messages = await _run_command(words, report)
        if status == _WRONG_USE:
            raise WrongUseError("\n".join(messages))
        if status not in _FOUND or not file.exists():
            text = "\n".join(messages) or f"`tltlc regress` ended with exit status {status}"
            return Answer(text, is_error=True)
        document = json.loads(file.read_text(encoding="utf-8"))
    return Answer(output.rstrip("\n"), {"report": document, "messages": messages})


def command_words(arguments: Mapping[str, Any]) -> list[str]:
    """Return the words of the command line. No value can be taken for an option."""
    words = [f"--{name}" for name in _FLAGS if arguments.get(name)]
    values = [(name, arguments[name]) for name in _VALUES if name in arguments]
    words += [f"{_OPTIONS.get(name, '--' + name.replace('_', '-'))}={value}" for name, value in values]
    words += [f"--changed={file}" for file in arguments.get("changed", ())]
    return [*words, "--", arguments["suite"]] if "suite" in arguments else words


async def _run_command(words: list[str], report: Report) -> tuple[int, str, list[str]]:
    """Run a command; return its exit status, its output, and the lines of its standard error."""
    process = await anyio.open_process(
        words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True
    )
    output: list[str] = []
    messages: list[str] = []
    try:
        async with anyio.create_task_group() as group:
            group.start_soon(_read, process, output)
            group.start_soon(_read_messages, process, messages, report)
        status = await process.wait()
    finally:
        with anyio.CancelScope(shield=True):
            await _end(process)
    return status, "".join(output), messages


async def _read(process: Process, output: list[str]) -> None:
    assert process.stdout is not None
    output.extend([text async for text in TextReceiveStream(process.stdout, errors="replace")])


async def _read_messages(process: Process, messages: list[str], report: Report) -> None:
    """Read the lines of standard error, and report each of them."""
    rest = ""
    assert process.stderr is not None
    async for text in TextReceiveStream(process.stderr, errors="replace"):
        *lines, rest = (rest + text).split("\n")
        for line in map(short_text, lines):
            messages.append(line)
            await report(len(messages), line)
    if rest:
        messages.append(short_text(rest))


async def _end(process: Process) -> None:
    """End the command and all its processes, and wait for that."""
    if process.returncode is None:
        process.terminate()
        with anyio.move_on_after(_PATIENCE_S):
            await process.wait()
    if hasattr(os, "killpg"):
        # The command ends its own processes, unless it was killed.
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(process.pid, signal.SIGKILL)
    elif process.returncode is None:
        process.kill()
    await process.aclose()


TOOL: Final = Tool(
    name="regress",
    title="Report what no longer plays as designed",
    description=(
        "Run `tltlc regress`: trained policies play the levels of a suite, or recorded sessions are judged, and the "
        "report says which cases still play as designed, where and why not. It needs the extra `game`, runs the code "
        "of the game, and may take minutes. It writes its page and its recordings into the folder `output` (default: "
        "regression/SUITE), and nothing else. Give `suite`, or `spec` with `baseline` and `now` for recorded sessions."
    ),
    arguments=arguments(
        {
            "suite": path_schema("a suite, a TOML file"),
            "spec": path_schema("judge recorded sessions by this spec (FILE or FILE:SPEC)"),
            "baseline": path_schema(
                "with `spec`: the sessions to compare with (a trace or a folder); with `suite`: a file"
            ),
            "now": path_schema("with `spec`: the sessions to judge, a trace or a folder"),
            "judged_as": {"enum": ["episodes", "traces"], "description": "with `spec` (default: episodes)"},
            "pass_rate": {"type": "number", "minimum": 0, "maximum": 0.999, "description": "with `spec`"},
            "fail_rate": {"type": "number", "minimum": 0, "maximum": 0.999, "description": "with `spec`"},
            "changed": {**PATHS, "minItems": 1, "description": "judge only the cases that depend on these files"},
            "fresh": {"type": "boolean", "description": "play all cases again, even if nothing has changed"},
            "retrain": {
                "type": "boolean",
                "description": "train the policies of cases that do not pass; needs minutes",
            },
            "minutes": {"type": "number", "exclusiveMinimum": 0, "description": "with `retrain`: the limit of each"},
            "workers": {"type": "integer", "minimum": 1, "description": "how many processes play"},
            "output": path_schema("the folder for the page and the recordings"),
        }
    ),
    result={
        "type": "object",
        "required": ["report", "messages"],
        "properties": {
            "report": {
                "type": "object",
                "required": ["format", "version", "suite", "complete", "verdicts", "cases"],
                "properties": {
                    "complete": {"type": "boolean"},
                    "verdicts": {
                        "type": "object",
                        "additionalProperties": {"type": "integer"},
                        "description": "how many cases have each of the verdicts pass, review and fail",
                    },
                    "cases": {
                        "type": "array",
                        "items": {
                            "type": "object",
                            "required": ["name", "verdict", "headline", "reasons"],
                            "properties": {"verdict": {"enum": ["pass", "review", "fail"]}},
                        },
                    },
                },
                "description": "what `tltlc regress --json` writes",
            },
            "messages": {**TEXTS, "description": "warnings, progress, and where the page is"},
        },
    },
    run=None,
    writes=True,
)
