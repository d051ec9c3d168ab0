"""Cases of recorded traces: a spec judges them, without a game and without a policy."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from tltl_runtime.regression.suite.named_files import spec_diagnostics
from tltl_runtime.regression.suite.thresholds import Thresholds, read_thresholds
from tltl_runtime.support.checked_table import CheckedTable, wrong_value
from tltlc.api import Diagnostic, Label, fileio, record, traces

JUDGED_AS: Final = ("episodes", "traces")
"""The values of the key ``judged_as``; the first is the default."""


@record
class TraceCase:
    """A regression test of recorded traces: a spec judges them and the traces of a baseline.

    ``spec`` is a path, or ``FILE:NAME``. ``traces`` and ``baseline`` are paths of files and of folders
    with such files. With ``as_episodes``, a trace is judged only up to the goal, a violation or the limit
    of the spec, where an episode would end; otherwise, it is judged as a whole.
    """

    name: str
    spec: str
    traces: tuple[str, ...]
    baseline: tuple[str, ...]
    thresholds: Thresholds = Thresholds()
    as_episodes: bool = True


def read_trace_case(table: CheckedTable, folder: Path, thresholds: Thresholds) -> tuple[TraceCase, Label] | None:
    """Read a case of recorded traces; return it with the label that shows its place in the file.

    None if it has errors, which are added to ``table.log``. ``folder`` is the folder of the suite, and
    ``thresholds`` has the values for thresholds that the case does not set.
    """
    before = len(table.log)
    spec = _spec(table, folder)
    now, baseline = _paths(table, folder, "traces"), _paths(table, folder, "baseline")
    thresholds = read_thresholds(table, thresholds)
    judged_as = table.text("judged_as", JUDGED_AS[0], one_of=JUDGED_AS)
    name = table.text("name", "")
    table.report_unknown_keys()
    if len(table.log) > before:
        return None
    name = name or _without_ending(Path(now[0]).name)
    return TraceCase(name, spec, now, baseline, thresholds, judged_as == JUDGED_AS[0]), table.label


def _without_ending(name: str) -> str:
    """Remove the ending of a trace's file from a name: ``run`` for ``run.csv``.

    A name without such an ending, for example that of a folder, is returned unchanged.
    """
    return next((name[: -len(ending)] for ending in traces.ENDINGS if name.lower().endswith(ending)), name)


def _spec(table: CheckedTable, folder: Path) -> str:
    text = table.text("spec")
    file, name = fileio.split_spec_name(text)
    path = str(folder / file)
    if text and not fileio.is_file(path):
        title, help_ = f"there is no spec `{file}`", "paths are relative to the suite"
        table.log.append(Diagnostic("TLT0805", title, (table.label_of("spec"),), help_))
        return text
    spec = f"{path}:{name}" if name else path
    if text:
        table.log += spec_diagnostics(spec, table.label_of("spec"))
    return spec


def _paths(table: CheckedTable, folder: Path, key: str) -> tuple[str, ...]:
    """Read a key whose value is the path of a file or folder, or a list of such paths.

    Paths in the suite are relative to ``folder``; the returned paths are relative to the working
    directory. Errors are added to ``table.log``.
    """
    entry = table.entries.get(key)
    if entry is None:
        title = f"{table.description} has `traces`, but lacks `{key}`"
        help_ = f'name the recorded traces to compare with, e.g. `{key} = "traces/old"`: a file, a folder, or a list'
        table.log.append(Diagnostic("TLT0803", title, (table.label,), help_))
        return ()
    names = table.names(key) if isinstance(entry.value, list) else (table.text(key),)
    if entry.value == [] or "" in names:
        expected = "the path of a file or a folder, or a list of them, none of them empty"
        if not isinstance(entry.value, str):
            table.log.append(wrong_value(entry, key, expected))
    for name in names:
        if name and not fileio.exists(folder / name):
            title, help_ = f"there is no file or folder `{name}`", "paths are relative to the suite"
            table.log.append(Diagnostic("TLT0805", title, (table.label_of(key),), help_))
    return tuple(str(folder / name) for name in names)
