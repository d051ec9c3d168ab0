"""``tltlc train``: train an agent to meet a spec in a scene of a game, or in a level."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Any, get_args

import click

from tltl_runtime.cli.support.level_options import level_options
from tltl_runtime.cli.support.missing_extra import name_missing_extra
from tltl_runtime.cli.support.options import output_folder
from tltl_runtime.cli.support.place_title import place_title
from tltl_runtime.cli.support.sensor_options import sensor_options
from tltl_runtime.cli.support.slow_starts import slow_starts_shown
from tltl_runtime.cli.support.worker_options import WorkersType
from tltl_runtime.support.number_text import duration, share
from tltl_runtime.training.files.choices import Method
from tltlc.api import cli

if TYPE_CHECKING:
    from tltl_runtime.training.files.report import TrainingReport
    from tltl_runtime.training.files.run_file import TrainingRun


def _setting(table: str, key: str) -> Callable[[click.Context, click.Parameter, Any], Any]:
    """Return a callback for a click option: it accepts only values that a training setting may have.

    The setting is ``key`` in the table ``table`` of a settings file; ``""`` is the top level.
    """

    def check(_: click.Context, parameter: click.Parameter, value: Any) -> Any:
        from tltl_runtime.training.files.settings_file import KINDS

        kind = KINDS[table][key]
        if value is not None and kind.read(value) is None:
            raise click.BadParameter(f"`{value}` is not {kind}", param=parameter)
        return value

    return check


@click.command(
    epilog="""\b
Examples:
  tltlc train --game lake.game.toml:small --out lake_agent
  tltlc train lake.tltl:cross --game lake.game.toml:small --minutes 15 --seed 3 --out runs/cross
  tltlc train --resume runs/cross --minutes 30
  tltlc train --game lake.game.toml:small --print-config > settings.toml
  tltlc train --game lake.game.toml:small --config settings.toml
  tltlc train --from lake_agent --game lake.game.toml:small:slippery
  tltlc train plans.tltl:careful --level my_level.toml:v1
  tltlc train --game lake.game.toml:small --method imitation --demonstrations mine

\b
Watching, from another terminal:
  tensorboard --logdir training
"""
)
@click.argument("spec", metavar="[SPEC[:NAME]]", required=False)
@level_options(
    "A level of the stealth game that comes with tltlc (default: the level that the spec names; VARIANT: v0)."
)
@output_folder(
    "The folder for the policy and the measurements (default: training/LEVEL-VARIANT-SPEC-SEED; imitation appends "
    "-imitation, --from appends -tuned)."
)
@click.option(
    "--seed", metavar="N", type=cli.WholeRange(min=0, max=2**31 - 1), help="The seed of the training (default: 0)."
)
@click.option(
    "--resume",
    metavar="DIR",
    type=click.Path(path_type=Path, file_okay=False),
    help="Continue the training in this folder from its last checkpoint.",
)
@click.option(
    "--config",
    metavar="FILE.toml",
    type=click.Path(path_type=Path),
    help="A file with settings that differ from the defaults. --print-config shows all settings.",
)
@click.option(
    "--method",
    type=click.Choice(get_args(Method)),
    help="What the agent learns from: rewards of the spec's automaton (default), or demonstrations.",
)
@click.option(
    "--demonstrations",
    metavar="DIR",
    type=click.Path(path_type=Path, file_okay=False),
    help="The demonstrations to imitate, from `tltlc record` (default: demonstrations of the expert, recorded first).",
)
@click.option(
    "--from",
    "policy",
    metavar="POLICY",
    type=click.Path(path_type=Path),
    help="Start with the weights of this policy, named as for `tltlc evaluate`. Its spec and level are the defaults.",
)
@click.option(
    "--steps",
    metavar="N",
    type=cli.WholeRange(),
    callback=_setting("stop", "steps"),
    help="Stop after this many steps, counted over all environments (default of new trainings: 4,000,000).",
)
@click.option(
    "--minutes",
    metavar="M",
    type=float,
    callback=_setting("stop", "minutes"),
    help="Stop after this many minutes, but not before the end of the first iteration (default of new trainings: 0, no "
    "limit). The starts of the games, the search, and earlier runs of a resumed training count.",
)
@click.option(
    "--workers",
    metavar="N|ray",
    type=WorkersType(),
    help="The number of processes that play (0: one per core), or `ray` for a Ray cluster.",
)
@click.option("--device", metavar="cpu|cuda|cuda:N", callback=_setting("", "device"), help="The device of the network.")
@sensor_options
@click.option("--print-config", is_flag=True, help="Print all settings as a file for --config, and exit.")
@slow_starts_shown()
def command(
    spec: str | None,
    folder: Path | None,
    resume: Path | None,
    sensors: Mapping[str, Any],
    print_config: bool,
    **options: Any,
) -> int:
    """Train an agent until it meets a spec.

    The agent plays a scene of your game (--game), or a level (--level) of the stealth game that comes with tltlc. SPEC
    judges and rewards it; the default is the spec that the scene or the level names. The training ends when 100
    episodes in a row have met the spec, and then 300 new episodes with the policy unchanged; or at a limit. The folder
    then contains the policy (policy.safetensors), the record of the training (record.json, curve.png) and the
    measurements (metrics.jsonl, and event files for TensorBoard). After Ctrl-C, --resume continues.

    The exit status is 0 if the spec was met, and 1 if a limit ended the training.
    """
    began = time.perf_counter()
    if resume is not None and folder is not None:
        raise click.UsageError(
            "--resume continues in the folder of the training: leave out --out", click.get_current_context()
        )
    with cli.Report() as report, name_missing_extra("`tltlc train`"):
        from tltl_runtime.cli.support.level_argument import check_no_toml

        check_no_toml(spec, settings="--config")
        from tltl_runtime.cli.support.training_run import (
            TrainOptions,
            check_limits,
            new_run,
            resumed_run,
            settings_to_print,
        )
        from tltl_runtime.training.files.run_file import resume_command
        from tltl_runtime.training.files.settings import settings_text
        from tltl_runtime.training.ppo.distributed import process_group

        train_options = TrainOptions(spec=spec, sensors=sensors, **options)
        if print_config:
            settings = (
                settings_to_print(train_options) if resume is None else resumed_run(train_options, resume).settings
            )
            click.echo(settings_text(settings), nl=False)
            return cli.exits.CLEAN
        run = new_run(train_options, folder) if resume is None else resumed_run(train_options, resume)
        again, is_first = resume_command(run.folder), process_group().rank == 0
        if resume is not None:
            from tltl_runtime.training.files.record import finished_record

            if record := finished_record(run):
                if is_first:
                    click.echo(_finished_text(run, record, again))
                return cli.exits.CLEAN if record["end"] == "met" else cli.exits.FINDINGS
            check_limits(run)
        if is_first:
            for line in _start_lines(run, resume=resume is not None):
                click.echo(line, err=True)
        # These imports take seconds, so they come after the first messages.
        from tltl_runtime.cli.support.training_progress import stopped_line, train_with_display
        from tltl_runtime.game.registry import game_of
        from tltl_runtime.training.files.record import write_record

        if is_first:
            game = game_of(run.level)
            report.add(game.play_warnings(game.load_level(run.level, run.variant), run.fspa))
        try:
            last = train_with_display(run, resume=resume is not None, again=again, began=began)
        except KeyboardInterrupt:
            if is_first and (stopped := stopped_line(run, again)):
                click.echo(stopped, err=True)
            raise
        if not is_first:
            # The exit status is 0 even if a limit ended the training. If it were not, torchrun would end all
            # processes, while the first one is still writing the record.
            return cli.exits.CLEAN
        write_record(run, last)
        for line in _end_lines(run, last, again):
            click.echo(line)
        if last.lost:
            report.add([last.lost.warning])
        return cli.exits.CLEAN if last.stop == "met" else cli.exits.FINDINGS
    return report.status


def _start_lines(run: TrainingRun, *, resume: bool) -> Iterator[str]:
    """Yield lines that describe the training.

    If the training is resumed without a checkpoint, it starts again. Then the last line says what
    happens to its files.
    """
    from tltl_runtime.cli.support.training_text import kept_ways_text, limits_line
    from tltl_runtime.training.files.found_ways import WaysFile
    from tltl_runtime.training.files.metrics import METRICS
    from tltl_runtime.training.files.run_file import CHECKPOINT, POLICY, RECORD

    place = place_title(run.level, run.variant.text)
    how = f" by {run.settings.method}" if run.settings.imitates else ""
    yield f"training {run.fspa.name} on {place}{how}, seed {run.seed}, in {run.folder}"
    yield limits_line(run.settings.stop)
    if run.initial and not (run.folder / CHECKPOINT).exists():
        count = run.settings.ppo.warm_up
        iterations = "iteration" if count == 1 else f"{count} iterations"
        critic_note = f"; its critic is new: only the critic learns in the first {iterations}" if count else ""
        yield f"it begins with the weights of {run.initial.path}{critic_note}"
    files = [name for name in (METRICS, RECORD, POLICY) if (run.folder / name).exists()]
    if not resume or (run.folder / CHECKPOINT).exists():
        return
    ways = WaysFile(run).read() if run.settings.searches else None
    if ways and not files:
        yield f"it was stopped during its search, which goes on {kept_ways_text(len(ways.demonstrations))}"
        return
    if not files:
        yield f"it was interrupted before it learned anything: with no {CHECKPOINT}, it starts from its beginning"
        return
    fates = {
        METRICS: "its measurements are lost",
        RECORD: "so is its record" if METRICS in files else "its record is lost",
        POLICY: f"{POLICY} stays until there is a new one",
    }
    fate = ", and ".join(fates[name] for name in files)
    kept = "these files as they are" if len(files) > 1 else "this file as it is"
    warning = f"; Ctrl-C before the end of its search leaves {kept}" if run.settings.searches else ""
    yield f"there is no {CHECKPOINT} in {run.folder}: the training starts again, {fate}{warning}"


def _end_lines(run: TrainingRun, last: TrainingReport, again: str) -> Iterator[str]:
    """Say how a training ended, where its files are, and what the user can do next.

    ``again`` is the command that resumes the training.
    """
    from tltlc.api import traces

    window, folder = last.window, quote(str(run.folder))
    ending = "the spec is met" if last.stop == "met" else f"ended by the limit of {last.stop}"
    met = f"met in {window.successes} of the last {window.count} episodes, progress {share(window.progress)}"
    spent = f"after {last.steps:,} steps, {duration(last.seconds)}"
    yield f"{ending} {spent}: {met if window.count else 'no episode has ended'}"
    yield from (f"  {traces.group_text(group, window.count)}" for group in window.causes)
    yield f"{folder}: policy.safetensors, record.json, curve.png"
    yield f"to evaluate it: tltlc evaluate {folder}"
    if last.stop != "met":
        if run.settings.searches and last.searched is None:
            from tltl_runtime.cli.support.training_text import no_search_line

            yield no_search_line(last.plan)
        elif last.searched:
            from tltl_runtime.cli.support.training_text import search_advice

            if advice := search_advice(last.plan, last.searched):
                yield f"the search found no way: {advice}"
        yield f"to go on with a higher limit: {again} --{last.stop} N"


def _finished_text(run: TrainingRun, record: Mapping[str, Any], again: str) -> str:
    """Say that a training is finished and therefore not resumed.

    ``record`` is the content of its ``record.json``. ``again`` is the command that resumes the
    training. The text suggests this command with a higher limit if a limit ended the training.
    """
    from tltl_runtime.cli.support.training_text import minutes

    prefix, stop = f"the training in `{run.folder}` is finished", run.settings.stop
    if record["end"] == "met":
        return f"{prefix}, and stays as it is: the spec was met after {record['steps']:,} steps"
    if record["end"] == "steps":
        spent, limit = f"{record['steps']:,} steps", f"{stop.steps:,}"
    else:
        spent, limit = duration(record["seconds"]), minutes(stop.minutes)
    resume = f"{again} --{record['end']} N"
    limit_text = f"it took {spent}, and its limit is {limit}"
    return f"{prefix}, and stays as it is: {limit_text}; to go on with a higher limit: {resume}"
