"""The verdicts of a suite as annotations of files, in the form of workflow commands of GitHub Actions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

from tltl_runtime.game.registry import game_of
from tltl_runtime.regression.report.case_report import CaseReport, new_failure_text
from tltl_runtime.regression.report.suite_summary import suite_summary, worst_first
from tltl_runtime.regression.suite.dependencies import dependencies
from tltl_runtime.regression.suite.suite import Suite, SuiteCase
from tltl_runtime.regression.suite.trace_case import TraceCase
from tltlc.api import fileio, workflow_command

_COMMANDS: Final = {"fail": "error", "review": "warning", "pass": "notice"}


def workflow_commands(suite: Suite, reports: Sequence[CaseReport], root: Path, not_judged: int = 0) -> Iterator[str]:
    """Yield an ``::error`` for each case that fails, and a ``::warning`` for each ``review``.

    A case that passes, but fails in a way that the baseline does not have, gets a ``::notice``. Before all of
    these stands a ``::notice`` with the result of the suite in one sentence, without a file; if all cases
    pass without new failures, there is no command at all. Failures come first, because GitHub shows
    only the first annotations.

    The command annotates the first of these places that exists:

    1. the file and the line of the error that keeps the case from being played;
    2. for recorded traces, the file of the spec;
    3. if the case was not played to a verdict, the file of the level;
    4. a file that has changed since the baseline; an overlay (a file that changes a level) is
       preferred to the level;
    5. the file of the suite.

    ``root`` is the top folder of the checkout. Paths inside it are written relative to it. ``not_judged``
    counts the cases without a report.
    """
    cases = {case.name: case for case in suite.cases}
    commands = [
        _command(suite, cases[report.name], report, root)
        for report, _ in worst_first([(report, None) for report in reports])
        if report.verdict != "pass" or report.has_new_failure
    ]
    if commands:
        yield workflow_command("notice", suite_summary(reports, not_judged).sentence, {"title": suite.path.stem})
    yield from commands


def _command(suite: Suite, case: SuiteCase, report: CaseReport, root: Path) -> str:
    path, line = report.fault_at or (_file_to_annotate(suite, case, report), None)
    location = {"file": _path_from_root(Path(path), root), **({"line": str(line)} if line else {})}
    is_new = report.verdict == "pass"
    title = f"{report.name}: {report.verdict}{', with a new failure' * is_new}"
    new = (*map(new_failure_text, report.new_failures), *report.failing_traces)
    texts = new if is_new else report.reasons
    return workflow_command(_COMMANDS[report.verdict], "\n".join(texts), {**location, "title": title})


def _file_to_annotate(suite: Suite, case: SuiteCase, report: CaseReport) -> Path:
    """Return the file to annotate for a case without an error, or with one that has no location.

    :func:`workflow_commands` lists the files from which this function chooses, the best one first.
    """
    if isinstance(case, TraceCase):
        return Path(fileio.split_spec_name(case.spec)[0])
    if report.played is None:
        return game_of(case.level).level_files.path(case.level)
    before = dict(report.reference.files) if report.reference else {}
    # `files` begins with the level. Prefer overlays, which come later: they are more specific.
    changed = [name for name, sha256 in reversed(report.played.files) if before.get(name) != sha256]
    paths = dependencies(suite, case)
    for name in changed:
        parts = Path(name).parts
        for path in paths:
            if path.parts[-len(parts) :] == parts and fileio.is_file(path):
                return path
    return suite.path


def _path_from_root(path: Path, root: Path) -> str:
    """Return a path as text, relative to ``root`` if it is inside, else unchanged."""
    try:
        return path.resolve().relative_to(root.resolve()).as_posix()
    except ValueError:
        return path.as_posix()
