"""``tltlc table1``: the paper's Table I with our levels, our expert and our trainings."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tltl_runtime.commands.ending import requests_heard
from tltl_runtime.commands.learning import learning_for
from tltl_runtime.commands.options import output_folder
from tltl_runtime.commands.workers import all_cores_option
from tltlc.cli import exits
from tltlc.cli.report import Report
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError

if TYPE_CHECKING:
    from tltl_runtime.regression.paper_table import Model


@click.command(
    epilog="""\b
Examples:
  tltlc table1 --shipped
  tltlc table1 --out table1 --minutes 60
"""
)
@output_folder("The folder for trainings, episodes and the table.", default=Path("table1"))
@click.option("--shipped", is_flag=True, help="Take the policies that come with the levels, and train imitation alone.")
@click.option(
    "--minutes", metavar="M", type=click.FloatRange(min=0), default=60.0, show_default=True, help="Of each training."
)
@all_cores_option
def command(folder: Path, shipped: bool, minutes: float, workers: Any) -> int:
    """Train and play what the paper's Table I is of, and print our table beside it.

    On each of the three levels: the scripted expert in place of the human, an agent that learns by imitation of it, and
    one that learns from its spec.  Each plays 100 episodes in each variant.  What is done stays in the folder: called
    again, the command goes on.
    """
    with Report() as report, learning_for("`tltlc table1`"), requests_heard():
        from tltl_runtime.regression.paper_table import LEVELS, MODELS, RUNS, VARIANTS, Row, markdown
        from tltl_runtime.regression.table_cells import EPISODES, figures, measured
        from tltlc.writing import write_files

        rows: dict[int, dict[tuple[str, Model], Row]] = {RUNS: {}, EPISODES: {}}
        for level in LEVELS:
            for model in MODELS:
                policy, hours = _policy(folder, level, model, shipped, minutes)
                found = {}
                for variant in VARIANTS:
                    click.echo(f"{level}:{variant}, {model}", err=True)
                    found[variant] = measured(folder, model, level, variant, policy, workers)
                for runs, table in rows.items():
                    table[level, model] = Row({name: figures(cell, runs) for name, cell in found.items()}, hours)
        text = "\n".join(f"{runs} episodes each:\n\n{markdown(table)}" for runs, table in rows.items())
        click.echo(text, nl=False)
        write_files(folder, {"table1.md": text}, "name another place with --out")
        return exits.CLEAN
    return report.status


def _policy(folder: Path, level: str, model: Model, shipped: bool, minutes: float) -> tuple[Path | None, float | None]:
    """The policy of a model, trained now if it is not there yet, and the hours that this took; none of the expert."""
    if model == "expert":
        return None, None
    if shipped and model == "ours":
        from tltl_runtime.policies.file import read_policy
        from tltl_runtime.policies.shipped import shipped_policies

        path = shipped_policies()[level]
        return path, float(read_policy(path).card.training["seconds"]) / 3600
    from tltl_runtime.training.run import POLICY, RECORD, RUN

    place = folder / f"{level}-{model}"
    if not (place / RECORD).exists():
        limit = ("--minutes", str(minutes))
        if (place / RUN).exists():
            _train("--resume", str(place), *limit)
        else:
            method = ("--method", "imitation") if model == "imitation" else ()
            _train("--level", level, "--out", str(place), *method, *limit)
    if not (place / RECORD).exists():
        raise TltlError([Diagnostic("TLT0930", f"the training in `{place}` did not end", help="run the command again")])
    made = json.loads((place / RECORD).read_text(encoding="utf-8"))
    return place / POLICY, made["seconds"] / 3600


def _train(*arguments: str) -> None:
    """Train as ``tltlc train`` does, which shows how it goes; Ctrl-C reaches it, too."""
    with subprocess.Popen([sys.executable, "-m", "tltlc", "train", *arguments], stdout=sys.stderr) as training:
        try:
            training.wait()
        except BaseException:
            training.terminate()
            training.wait()
            raise
