"""``tltlc regress``: report which levels still play as designed, and why the rest do not."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

import click

from tltl_runtime.cli.support.changed_option import ChangedCommand
from tltl_runtime.cli.support.closed_output import ignore_closed_pipe
from tltl_runtime.cli.support.missing_extra import name_missing_extra
from tltl_runtime.cli.support.options import Function, output_folder
from tltl_runtime.cli.support.suite_argument import check_suite_exists
from tltl_runtime.cli.support.trace_options import TraceOptions, path_option, spec_label, threshold_option
from tltl_runtime.cli.support.worker_options import all_cores_option
from tltl_runtime.cli.support.writable_paths import is_standard_output
from tltlc.api import TltlError, cli, fileio

_MINUTES: Final = 10.0
"""The default limit of each training with --retrain, in minutes."""
_REPORTS: Final = {"json": "the JSON", "junit": "the XML", "html": "the page"}


def _report_option(name: str, help_text: str) -> Callable[[Function], Function]:
    help_text = f"{help_text}; `-` prints it instead of the text."
    return click.option(
        f"--{name}", metavar="FILE", type=cli.OutputPath("file", stdout=True, checked=True), help=help_text
    )


def _threshold_option(name: str, help_text: str, default: str) -> Callable[[Function], Function]:
    limits = cli.FiniteRange(min=0, max=0.999)
    help_text = f"With --spec: {help_text[0].lower()}{help_text[1:]} (default: {default})."
    return click.option(threshold_option(name), name, metavar="R", type=limits, help=help_text)


@click.command(
    cls=ChangedCommand,
    epilog="""\b
Examples:
  tltlc regress
  tltlc regress suite.toml --html report.html
  tltlc regress suite.toml --json - > report.json
  tltlc regress suite.toml --changed assets/guard.toml
  tltlc regress suite.toml --retrain --minutes 20
  tltlc regress --spec metroid.tltl --baseline traces/v1 --now traces/v2
  tltlc regress suite.toml --junit report.xml --github --changed $(git diff --no-renames --name-only main)
""",
)
@click.argument("suite", metavar="[SUITE]", required=False, type=click.Path(path_type=Path))
@click.option(
    "--changed",
    metavar="ASSET…",
    multiple=True,
    help="Judge only the cases that depend on these files. All words up to the next option are files.",
)
@_report_option("json", "Write the report as JSON, too")
@_report_option("junit", "Write the report as JUnit XML, too")
@_report_option("html", "Write the report as an HTML page, too")
@click.option("--github", is_flag=True, help="Print annotations for GitHub Actions, too.")
@click.option(
    "--baseline",
    metavar="PATH",
    type=click.Path(),
    callback=path_option,
    help="The baseline to compare with (default: SUITE.baseline.json, next to the suite); with --spec, a recorded "
    "trace or a folder of them.",
)
@click.option(
    "--spec",
    metavar="SPEC",
    help="Judge recorded traces by this spec, without a suite, a game or a policy; needs --now and --baseline.",
)
@click.option(
    "--now", metavar="PATH", type=click.Path(), callback=path_option, help="The traces to judge: a file or a folder."
)
@click.option(
    "--judged-as",
    type=click.Choice(["episodes", "traces"]),
    help="With --spec: whether each trace ends at the goal, at a violation or at the limit of the spec, or is judged "
    "as a whole (default: episodes).",
)
@_threshold_option("pass_rate", "The pass rate that is enough", "0.85")
@_threshold_option("fail_rate", "The pass rate below which the case fails", "0.5")
@click.option("--fresh", is_flag=True, help="Play all cases again, even if nothing has changed since they were played.")
@click.option(
    "--retrain",
    is_flag=True,
    help="Train the policy of each case that does not pass on the changed level, to find out whether this level can "
    "still be played.",
)
@click.option(
    "--minutes",
    metavar="M",
    type=cli.FiniteRange(min=0, min_open=True, max=1_000_000),
    help=f"The time limit of each training (default: {_MINUTES:g}).",
)
@all_cores_option
@output_folder("The folder for the page and the recordings (default: regression/SUITE).")
def command(
    suite: Path | None,
    changed: tuple[str, ...],
    github: bool,
    baseline: Path | None,
    spec: str | None,
    now: Path | None,
    judged_as: str | None,
    pass_rate: float | None,
    fail_rate: float | None,
    fresh: bool,
    retrain: bool,
    minutes: float | None,
    workers: Any,
    folder: Path | None,
    **files: Path | None,
) -> int:
    """Report which levels still play as designed: trained policies play them, or recorded play is judged.

    SUITE is a TOML file that lists cases: levels and the policies that play them, or recorded traces of any game.
    Without SUITE, the levels that come with tltlc are played, in all of their variants. --spec judges recorded traces
    without a suite. A case is not played again if nothing has changed since the last run. Actions are sampled, as in
    training and in the baseline; `tltlc evaluate` also plays the most probable ones.

    The exit status is 0 if all cases pass, and 1 if a case fails or needs a review; --retrain does not change it.
    """
    printed = {
        name: f"`--{name} {path}`" for name, path in files.items() if path is not None and is_standard_output(path)
    }
    if printed and len(uses := [*["--github"] * github, *printed.values()]) > 1:
        *_, last = (_REPORTS[name] for name in printed)
        advice = f"write {last} to a file" if len(uses) == 2 else "write the reports to files"
        both = "both" if len(uses) == 2 else "all"
        raise click.UsageError(f"{', '.join(uses[:-1])} and {uses[-1]} {both} need standard output: {advice}")
    if minutes is not None and not retrain:
        raise click.UsageError("--minutes works only with --retrain: add --retrain")
    thresholds = {name: rate for name, rate in (("pass_rate", pass_rate), ("fail_rate", fail_rate)) if rate is not None}
    others = {f"`{suite}`": suite is not None, "--changed": bool(changed), "--retrain": retrain, "--fresh": fresh}
    TraceOptions(spec, now, baseline, judged_as, thresholds, others).check()
    if suite is None and (swallowed := next(filter(_is_suite, changed or ()), None)):
        raise click.UsageError(f"`{swallowed}` counts as a file of --changed: put the suite before --changed")
    with cli.Report() as report, name_missing_extra("`tltlc regress`"), ignore_closed_pipe():
        check_suite_exists(suite)
        from tltl_runtime.cli.support.regression_run import RegressOptions, run

        options = RegressOptions(
            suite=suite,
            spec=spec,
            now=now,
            judged_as=judged_as,
            thresholds=thresholds,
            changed=tuple(filter(None, changed)) if changed else None,
            folder=folder or _default_folder(suite, spec),
            files={f"--{name}": path for name, path in files.items() if path is not None},
            github=github,
            fresh=fresh,
            workers=workers,
            baseline=baseline,
            minutes=(minutes or _MINUTES) if retrain else None,
        )
        return run(options)
    return report.status


def _is_suite(word: str) -> bool:
    """Whether a word is the path of a suite: a TOML file with a table ``[[case]]``."""
    if not word.endswith(".toml") or not fileio.is_file(word):
        return False
    try:
        return "\n[[case]]" in "\n" + fileio.read_source(word, max_bytes=fileio.limits.TOML.size).text
    except TltlError:
        return False


def _default_folder(suite: Path | None, spec: str | None) -> Path:
    """Return the default folder of a run, for example ``regression/levels/game`` for the suite ``levels/game.toml``.

    It is ``regression``, followed by the path of the suite relative to the working directory,
    without ``..`` and without the extension. With ``--spec``, it is ``regression`` and the name of the
    spec. Without a suite and a spec, it is ``regression/shipped``.
    """
    if spec is not None:
        return Path("regression", spec_label(spec))
    if suite is None:
        return Path("regression", "shipped")
    try:
        path = Path(os.path.relpath(suite))
    except ValueError:  # on Windows, the suite is on another drive
        path = Path(suite.name)
    return Path("regression", *(part for part in path.parent.parts if part != os.pardir), path.stem)
