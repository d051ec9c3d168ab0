#!/usr/bin/env python3
"""Run monitors on the traces in this folder, and print the differences from the expected results.

    python check.py [--only CASE,CASE] COMMAND...

COMMAND starts a monitor. ``{name}`` in it stands for the name of a case; the script appends ``--full`` and a trace:
``python check.py node 'build/{name}_monitor.mjs'``. Lines that an engine prints before the header are ignored. The
exit status is 1 if there is a difference, and 2 if COMMAND or a CASE is wrong.
"""

from __future__ import annotations

import csv
import difflib
import io
import json
import re
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

NUMBERS = ("progress", "reward", "robustness")
LONGEST_RUN_S = 60


def main(words: Sequence[str]) -> int:
    """Run the command line ``words``, and return the exit status.

    It is 0 if all results are as expected, 1 if anything differs, and 2 for wrong usage.
    """
    only = words[1].split(",") if len(words) > 1 and words[0] == "--only" else None
    command = words[2:] if only else words
    if not command or command[0].startswith("-"):
        print(__doc__, file=sys.stderr)
        return 2
    folder = Path(__file__).resolve().parent
    index = json.loads((folder / "index.json").read_text(encoding="utf-8"))
    misuse = _misuse(command, only or (), [case["name"] for case in index["cases"]])
    if misuse:
        print(f"error: {misuse}", file=sys.stderr)
        return 2
    try:
        return _checked(command, only, folder, index)
    except OSError as error:
        print(f"error: cannot start `{' '.join(command)}`: {error}", file=sys.stderr)
        return 2


def _misuse(command: Sequence[str], only: Sequence[str], names: Sequence[str]) -> str | None:
    """Return what is wrong with the command line, or None if nothing is.

    ``only`` are the cases that it asks for, and ``names`` all cases that exist.
    """
    if not any("{name}" in word for word in command):
        return "the command has no {name}, so all cases would run the same monitor"
    for case in only:
        if case not in names:
            near = difflib.get_close_matches(case, names) or names
            return f"no case is called `{case}`; there are {', '.join(near)}"
    return None


def _checked(command: Sequence[str], only: Sequence[str] | None, folder: Path, index: Mapping[str, Any]) -> int:
    """Check each case of the corpus that ``only`` names, or all if it is None; return the exit status.

    Prints the differences, and at the end how many traces have any.
    """
    traces = differing = 0
    for case in index["cases"]:
        if only and case["name"] not in only:
            continue
        tolerance = 0.0 if case["exact"] else index["tolerance"]
        for trace in case["traces"]:
            traces += 1
            problems = list(trace_problems(command, folder, case["name"], trace, tolerance))
            differing += bool(problems)
            for problem in problems[:5]:
                print(f"{trace['trace']}: {problem}")
    print(f"{traces} trace{'' if traces == 1 else 's'}, {differing} of them not as expected")
    return 1 if differing or not traces else 0


def trace_problems(
    command: Sequence[str], folder: Path, name: str, trace: Mapping[str, Any], tolerance: float
) -> Iterator[str]:
    """Run a monitor on one trace of the index, and yield the differences from the expected results.

    Numbers may differ by at most ``tolerance``. Raises OSError if the monitor cannot be started.
    """
    words = [word.replace("{name}", name) for word in command]
    try:
        done = subprocess.run([*words, "--full", folder / trace["trace"]], capture_output=True, timeout=LONGEST_RUN_S)
    except subprocess.TimeoutExpired as error:
        yield str(error)
        return
    with (folder / trace["expected"]).open(encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file))
    out, err = (text.decode(errors="replace") for text in (done.stdout, done.stderr))
    yield from differences(done.returncode, out, err, rows, trace["warnings"], trace["error"], tolerance)


def differences(
    status: int,
    out: str,
    err: str,
    rows: Sequence[Sequence[str]],
    warnings: int,
    error: Mapping[str, Any] | None,
    tolerance: float,
) -> Iterator[str]:
    """Yield the differences from the expected exit status, standard output and standard error.

    ``rows`` are the expected rows, and begin with the header. ``warnings`` is the expected number
    of warnings. ``error`` is the expected error as the index has it; None if there must be none.
    """
    expected_status = 1 if error else 0
    if status != expected_status:
        yield f"exit status {status}, not {expected_status}: {err}"
    yield from _row_differences(out, rows, tolerance)
    yield from _message_differences(err, warnings, error)


def _row_differences(out: str, rows: Sequence[Sequence[str]], tolerance: float) -> Iterator[str]:
    """Yield the differences between the printed and the expected rows, cell by cell.

    The header may be missing if the monitor rejects the first sample.
    """
    columns, *expected = rows
    # Game engines print lines of their own first.
    header = re.search(rf"^{re.escape(','.join(columns))}\r?$", out, re.MULTILINE)
    if header is None:
        if expected:
            yield f"there is no header in: {out}"
        return
    printed = [*csv.reader(io.StringIO(out[header.end() :].lstrip("\r\n"), newline=""), strict=True)]
    if len(printed) != len(expected):
        yield f"{len(printed)} rows, not {len(expected)}"
    for number, (row, expected_row) in enumerate(zip(printed, expected), start=1):  # noqa: B905 (counted above)
        if len(row) != len(expected_row):
            yield f"row {number} has {len(row)} cells: {row}"
            continue
        for column, cell, expected_cell in zip(columns, row, expected_row):  # noqa: B905 (equal lengths)
            if cell != expected_cell and not (column in NUMBERS and _is_near(cell, expected_cell, tolerance)):
                yield f"row {number}: {column} is {cell!r}, not {expected_cell!r}"


def _is_near(cell: str, expected: str, tolerance: float) -> bool:
    try:
        return tolerance > 0.0 and abs(float(cell) - float(expected)) <= tolerance
    except ValueError:
        return False


def _message_differences(err: str, warnings: int, error: Mapping[str, Any] | None) -> Iterator[str]:
    """Yield in words what is wrong with ``err``, the standard error output of a monitor.

    If ``error`` is given, the output must have one line about it, with the names of the signals or
    atoms at fault. Otherwise, it must have no error, and ``warnings`` lines with a warning.
    """
    lines = err.splitlines()
    errors = [line for line in lines if line.startswith("error: ")]
    if error is None:
        count = sum(line.startswith("warning: ") for line in lines)
        if errors or count != warnings:
            yield f"{count} warnings, not {warnings}: {err}"
    elif len(errors) != 1:
        yield f"{len(errors)} errors in: {err}"
    else:
        place = f"line {error['line']}" if error["line"] is not None else f"step {error['step']}"
        if error["kind"] != "no sample" and not errors[0].startswith(f"error: {place}: "):
            yield f"an error at {place}, not: {errors[0]}"
        for name in error["names"]:
            if not re.search(rf"(?<!\w){re.escape(name)}(?!\w)", errors[0]):
                yield f"the error does not name {name}: {errors[0]}"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
