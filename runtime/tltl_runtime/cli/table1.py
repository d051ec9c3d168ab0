"""``tltlc table1``: reproduce the paper's Table I with our levels, our expert and our trainings."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from shlex import join
from typing import TYPE_CHECKING, Any

import click

from tltl_runtime.cli.support.closed_output import ignore_closed_pipe
from tltl_runtime.cli.support.missing_extra import name_missing_extra
from tltl_runtime.cli.support.options import output_folder
from tltl_runtime.cli.support.worker_options import all_cores_option
from tltl_runtime.cli.support.writable_paths import check_no_training
from tltlc.api import Diagnostic, TltlError, cli, record

if TYPE_CHECKING:
    from tltl_runtime.regression.table1.paper_table import Model
    from tltl_runtime.regression.table1.table_trainings import TrainedModel

_ELSEWHERE = "name another place with --out"
_SAVING_S = 20.0
"""An interrupted training gets this many seconds to write its checkpoint."""


@record
class _Table1Options:
    """The options of ``tltlc table1``."""

    folder: Path
    shipped: bool
    minutes: float | None
    workers: Any

    @property
    def resume_command(self) -> str:
        """The shell command that continues a stopped run."""
        words = ["tltlc", "table1", "--out", str(self.folder), *["--shipped"] * self.shipped]
        words += [] if self.minutes is None else ["--minutes", f"{self.minutes:g}"]
        return join([*words, "--workers", str(self.workers)] if self.workers else words)


@click.command(
    epilog="""\b
Examples:
  tltlc table1 --shipped
  tltlc table1 --out table1 --minutes 60
"""
)
@output_folder("The folder for trainings, episodes and the table.", default=Path("table1"))
@click.option("--shipped", is_flag=True, help="Use the policies that come with the levels; train only by imitation.")
@click.option(
    "--minutes",
    metavar="M",
    type=cli.FiniteRange(min=0, max=1_000_000),
    help="The time limit of each training; 0 means no limit except that of steps (default: 60; with --shipped, the "
    "limit that the shipped policies had).",
)
@all_cores_option
def command(folder: Path, shipped: bool, minutes: float | None, workers: Any) -> int:
    """Train and play the models of the paper's Table I, and print our table next to it.

    Three models play each of three levels: the scripted expert (in place of a human), an agent that imitates the
    expert, and an agent that learns from its spec. Each model plays 100 episodes in each variant. All results stay in
    the folder, so that the same command continues a run. If a level, a spec, a setting or the code has changed, the
    command trains or plays again.
    """
    with cli.Report() as report, name_missing_extra("`tltlc table1`"), ignore_closed_pipe():
        from tltl_runtime.support.folder_lock import lock_folder
        from tltlc.api import fileio

        title = f"another run of `tltlc table1` is using `{folder}`"
        busy = Diagnostic("TLT0931", title, help="wait until it ends, or name another folder with --out")
        check_no_training(folder)
        with lock_folder(folder, busy, _ELSEWHERE):
            options = _Table1Options(folder, shipped, minutes, workers)
            try:
                text = _table(options)
            except KeyboardInterrupt:
                click.echo(
                    f"stopped: what is finished is kept in `{folder}`; to go on: {options.resume_command}", err=True
                )
                raise
            click.echo(text, nl=False)
            fileio.write_files(folder, {"table1.md": text}, _ELSEWHERE)
        return cli.exits.CLEAN
    return report.status


def _table(options: _Table1Options) -> str:
    """Return the text of two tables: one for the first 25 episodes of each cell, as in the paper, one for all 100.

    First, run the trainings and play the episodes that are not in the folder yet.
    """
    from tltl_runtime.regression.table1.paper_table import LEVELS, MODELS, RUNS, VARIANTS, TableRow, markdown
    from tltl_runtime.regression.table1.table_cells import EPISODES, SEED, cell_episodes, figures
    from tltl_runtime.training.files.versions import versions

    seeds = []
    rows: dict[int, dict[tuple[str, Model], TableRow]] = {RUNS: {}, EPISODES: {}}
    for level in LEVELS:
        for model in MODELS:
            training = _training_result(options, level, model)
            policy, hours, cloning_share = (
                (training.policy, training.hours, training.cloning_share) if training else (None, None, None)
            )
            seeds += [f"{level} {model} {training.seed}"] if training else []
            cells = {}
            for variant in VARIANTS:
                click.echo(f"{level}:{variant}, {model}", err=True)
                cells[variant] = cell_episodes(options.folder, model, level, variant, policy, options.workers)
            for runs, table in rows.items():
                figures_by_variant = {name: figures(cell, runs) for name, cell in cells.items()}
                table[level, model] = TableRow(figures_by_variant, hours, cloning_share)
    tables = [
        f"{runs} episodes each of ours, {RUNS} of the paper's:\n\n{markdown(table)}" for runs, table in rows.items()
    ]
    made_by = ", ".join(f"{name} {version}" for name, version in versions().items())
    footer = (
        f"Episodes of seed {SEED}, with sampled actions. Seeds of trainings: {', '.join(seeds)}. Made by {made_by}.\n"
    )
    return "\n".join((*tables, footer))


def _training_result(options: _Table1Options, level: str, model: Model) -> TrainedModel | None:
    """Return the trained policy of a model, with figures of its training; None for the expert.

    If the training is missing or unfinished, start or continue it. With ``--shipped``, the policy of
    the model ``ours`` is the one that comes with the level.

    Raises:
        TltlError: TLT0930, the training did not finish.
    """
    from tltl_runtime.policies.file import read_policy
    from tltl_runtime.policies.shipped import shipped_policies
    from tltl_runtime.regression.table1 import table_trainings
    from tltl_runtime.regression.table1.table_trainings import (
        TrainedModel,
        finished_training,
        table_training,
        train_arguments,
    )

    if model == "expert":
        return None
    limits = table_trainings.limits(options.minutes)
    if options.shipped:
        path = shipped_policies()[level]
        card = read_policy(path).card
        if model == "ours":
            return TrainedModel(path, card.training["seed"], float(card.training["seconds"]) / 3600, None)
        limits = table_trainings.limits_of_policy(card, options.minutes)
    training = table_training(options.folder, level, model, limits)
    result = finished_training(training)
    if result is None:
        _train(train_arguments(training))
        result = finished_training(training)
    if result is None:
        title = f"the training in `{training.folder}` did not finish"
        raise TltlError([Diagnostic("TLT0930", title, help="run the command again")])
    return result


def _train(arguments: list[str]) -> None:
    """Run ``tltlc train`` with ``arguments`` in another process, which shows its progress on standard error.

    If Ctrl-C interrupts it, wait up to 20 seconds until it has saved its state, and raise
    KeyboardInterrupt. No exception is raised if it fails in another way.
    """
    with subprocess.Popen([sys.executable, "-m", "tltlc", "train", *arguments], stdout=sys.stderr) as training:
        try:
            training.wait()
        except BaseException:
            # The training may have received Ctrl-C, too, and be saving its state: a second signal would interrupt it.
            try:
                training.wait(_SAVING_S)
            except subprocess.TimeoutExpired:
                training.terminate()
                training.wait()
            raise
    cli.raise_if_interrupted(training.returncode)
