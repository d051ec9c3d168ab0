"""``tltlc baseline``: record episodes that ``tltlc regress`` later compares with new ones."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from shlex import join
from typing import TYPE_CHECKING, Any

import click

from tltl_runtime.cli.support.closed_output import ignore_closed_pipe
from tltl_runtime.cli.support.level_faults import level_faults
from tltl_runtime.cli.support.missing_extra import name_missing_extra
from tltl_runtime.cli.support.options import output_file
from tltl_runtime.cli.support.plain_text import plain_text
from tltl_runtime.cli.support.suite_argument import check_suite_exists
from tltl_runtime.cli.support.worker_options import all_cores_option
from tltl_runtime.cli.support.writable_paths import check_apart, check_writable
from tltlc.api import TltlError, cli, fileio

if TYPE_CHECKING:
    from tltl_runtime.regression.suite.suite import Case, Suite
    from tltl_runtime.regression.verdict.baseline import Reference
    from tltl_runtime.regression.verdict.baseline_run import RecordedReference


@click.command(
    epilog="""\b
Examples:
  tltlc baseline suite.toml
  tltlc baseline suite.toml --output tonight.json
  tltlc regress suite.toml --baseline tonight.json
"""
)
@click.argument("suite", metavar="[SUITE]", required=False, type=click.Path(path_type=Path))
@output_file("FILE", "The file to write (default: SUITE.baseline.json, next to the suite).")
@click.option(
    "--fresh", is_flag=True, help="Play all levels again, even if nothing has changed since they were recorded."
)
@all_cores_option
@level_faults()
def command(suite: Path | None, path: Path | None, fresh: bool, workers: Any) -> int:
    """Record how the policies of a suite play the levels now. `tltlc regress` compares with this baseline.

    Run it while the levels play as you want them to, and again after each intended change. Each level is played only in
    the variant that its cases are compared with, by default the first one; `tltlc regress` judges the others. Results
    in an existing file are kept if level, policy, spec, seed, versions and code have not changed. Without SUITE, the
    command plays the levels that come with tltlc and writes `shipped.baseline.json`.

    The exit status is 0 if the baseline is written, and 1 if it is written but none of the cases can pass with it.
    After an error, with status 1 or any other, the baseline is not written.
    """
    with cli.Report() as report, name_missing_extra("`tltlc baseline`"), ignore_closed_pipe():
        check_suite_exists(suite)
        from tltl_runtime.cli.support.regression_display import RegressionDisplay
        from tltl_runtime.regression.suite.dependencies import files_of
        from tltl_runtime.regression.suite.suite import SHIPPED, read_suite
        from tltl_runtime.regression.verdict.baseline import default_output
        from tltl_runtime.regression.verdict.baseline_run import partial_path, record_and_write_baseline

        loaded = read_suite(suite or SHIPPED)
        if not loaded.played_cases:
            click.echo("nothing to record: the baselines of the suite are recorded traces", err=True)
            return cli.exits.CLEAN
        output = path or default_output(loaded.path)
        check_apart({"--output": output}, files_of(loaded) - {loaded.baseline.resolve()})
        check_writable({"--output": output})
        existed, older = fileio.exists(output), _older_references(output)
        try:
            with RegressionDisplay() as display:
                can_pass = False
                for recorded in record_and_write_baseline(loaded, output, workers, display, older, fresh=fresh):
                    display.clear()
                    can_pass |= _print_reference(loaded, recorded, older, fresh=fresh)
        except KeyboardInterrupt:
            click.echo(f"stopped: {_stopped_text(output, partial_path(output), existed=existed)}", err=True)
            raise
        click.echo(f"wrote {output}", err=True)
        if output.resolve() != loaded.baseline.resolve():
            words = ["tltlc", "regress", *([str(suite)] if suite else []), "--baseline", str(output)]
            click.echo(f"to compare with it: {join(words)}", err=True)
        if not can_pass:
            click.echo("none of the cases can pass with this baseline, even if nothing changes", err=True)
            return cli.exits.FINDINGS
        return cli.exits.CLEAN
    return report.status


def _older_references(path: Path) -> tuple[Reference, ...]:
    """Return the references, that is, the recorded episodes, of the baseline in the output file.

    The result is empty if the file ``path`` is missing or is not a baseline.
    """
    from tltl_runtime.regression.verdict.baseline import read_baseline

    with suppress(TltlError):
        return read_baseline(path) if fileio.is_file(path) else ()
    return ()


def _stopped_text(path: Path, partial: Path | None, *, existed: bool) -> str:
    """Describe what a stopped recording of a baseline has written, and how to continue it.

    ``path`` is the output file, and ``existed`` says whether it existed before. ``partial`` is the file
    with the finished recordings, from which the same command continues; None if there is none.
    """
    from tltl_runtime.support.path_text import path_text

    if partial and not existed:
        return (
            f"`{path}` was not written; what is finished is kept in `{path_text(partial)}`: "
            "run the same command again to continue"
        )
    return f"`{path}` was not changed; run the same command again to {'continue' if partial else 'start again'}"


def _print_reference(suite: Suite, recorded: RecordedReference, older: tuple[Reference, ...], *, fresh: bool) -> bool:
    """Print how often a recorded policy met its spec, and which cases would not pass even if nothing changed.

    Return whether at least one of the cases can pass.

    A reference is the recorded episodes with which one or several cases are compared. ``older`` are
    the references that the output file had before.
    """
    from tltl_runtime.regression.verdict.baseline_run import verdict_if_unchanged

    reference = recorded.reference
    played, passed, count = reference.played, _success_count(reference), len(reference.episodes)
    before = _older_reference(reference, older)
    if reference in older and not fresh:
        note = "  (as before)"
    else:
        note = f"; before: {_success_count(before)} of {len(before.episodes)}" if before else ""
    click.echo(plain_text(f"{played.level}:{played.variant}: {played.spec} met in {passed} of {count} episodes") + note)
    if recorded.lost:
        click.echo(plain_text(f"    played again, because {recorded.lost.line}"), err=True)
    if recorded.outdated:
        click.echo(plain_text(f"    {recorded.outdated}"), err=True)
    can_pass = False
    for case in recorded.cases:
        verdict = verdict_if_unchanged(suite, case, reference) if case.plays_reference else "pass"
        if verdict != "pass":
            advice = _advice(passed / count, case, suite.error / len(suite.cases))
            click.echo(plain_text(f"    `{case.name}` is `{verdict}` even if nothing changes: {advice}"), err=True)
        can_pass |= verdict == "pass" and not recorded.outdated
    return can_pass


def _success_count(reference: Reference) -> int:
    return sum(episode.summary.success for episode in reference.episodes)


def _older_reference(reference: Reference, older: tuple[Reference, ...]) -> Reference | None:
    """Return the earlier recording in ``older`` that ``reference`` replaces; None if there is none.

    Candidates have the same level (name and place), variant and spec. Return the first candidate
    with the same policy. If none has it, return the only candidate, or None if there are several.
    """
    names = ("level", "variant", "place", "spec")
    played = reference.played
    candidates = [
        reference for reference in older if all(getattr(reference.played, key) == getattr(played, key) for key in names)
    ]
    same_policy = [reference for reference in candidates if reference.played.policy == played.policy]
    return same_policy[0] if same_policy else candidates[0] if len(candidates) == 1 else None


def _advice(pass_rate: float, case: Case, error: float) -> str:
    """Say what the user can change so that ``case`` passes.

    ``pass_rate`` is the pass rate of the case's baseline, from 0 to 1. ``error`` is the allowed
    probability of a wrong verdict on the case.
    """
    if pass_rate == 1.0:
        from tltl_runtime.regression.verdict.baseline_run import episodes_for_certainty

        episodes = episodes_for_certainty(case.thresholds.pass_rate, error)
        return f"{case.episodes} `episodes` are too few to be certain; give it at least {episodes}"
    if pass_rate < case.thresholds.pass_rate:
        return "train its policy further, or lower its `pass_rate`"
    return "train its policy further, lower its `pass_rate`, or give it more `episodes`"
