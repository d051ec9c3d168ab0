"""``tltlc evaluate``: let a trained policy play episodes, and report how often it meets the spec."""

from __future__ import annotations

import hashlib
import json
import sys
from collections import Counter
from collections.abc import Iterator
from contextlib import closing, nullcontext
from pathlib import Path
from shlex import join
from typing import TYPE_CHECKING, Any, Final

import click

from tltl_runtime.cli.support.level_faults import level_faults
from tltl_runtime.cli.support.level_options import level_options
from tltl_runtime.cli.support.missing_extra import name_missing_extra
from tltl_runtime.cli.support.options import output_folder, seed_option
from tltl_runtime.cli.support.slow_starts import slow_starts_shown
from tltl_runtime.cli.support.worker_options import WorkersType
from tltl_runtime.cli.support.writable_paths import check_writable
from tltl_runtime.game.level_name import level_option
from tltl_runtime.support.number_text import short_list
from tltlc.api import cli

if TYPE_CHECKING:
    from tltl_runtime.cli.support.evaluation_files import EvaluationFiles
    from tltl_runtime.evaluation.player import PlayedEpisode, RecordMode


_MOST_NAMED: Final = 6
"""The most removed files that a message names."""


@click.command(
    epilog="""\b
Examples:
  tltlc evaluate lake_agent
  tltlc evaluate lake_agent --game lake.game.toml:small:slippery --episodes 500 --seed 7 --workers 0
  tltlc evaluate lake_agent --json - > lake.json
  tltlc evaluate lake_agent --out evaluation --record all
  tltlc evaluate --level cover_and_hide           a policy that comes with tltlc, in its level of the stealth game
"""
)
@click.argument("policy", metavar="[POLICY]", required=False, type=click.Path(path_type=Path))
@level_options("The level to play (default: the level or the scene of the training; VARIANT: v0).")
@click.option(
    "--episodes",
    metavar="N",
    type=cli.WholeRange(1, 10**6),
    default=100,
    show_default=True,
    help="How many episodes the policy plays.",
)
@seed_option("The seed of the evaluation. Equal seeds give equal episodes.")
@click.option(
    "--first",
    metavar="I",
    type=cli.WholeRange(min=0),
    default=0,
    show_default=True,
    help="The number of the first episode, to play a part of an evaluation again.",
)
@click.option(
    "--spec", metavar="SPEC[:NAME]", help="The spec that judges the policy (default: the spec of the training)."
)
@click.option(
    "--workers",
    metavar="N|ray",
    type=WorkersType(),
    default=1,
    show_default=True,
    help="The number of processes that play (0: one per core), or `ray` for a Ray cluster.",
)
@click.option(
    "--json", "json_file", metavar="FILE", type=cli.OutputPath("file", stdout=True, checked=True),
    help="Write the report as JSON, too; `-` prints it instead of the text.",
)  # fmt: skip
@output_folder("Write recordings, their plans, a picture of all paths and the report to this folder.")
@click.option(
    "--record",
    "recorded",
    type=click.Choice(("failures", "all", "none")),
    help="Which episodes to record in the folder of --out (default: failures).",
)
@level_faults()
@slow_starts_shown()
def command(
    policy: Path | None,
    level: str | None,
    episodes: int,
    seed: int,
    first: int,
    spec: str | None,
    workers: Any,
    json_file: Path | None,
    folder: Path | None,
    recorded: RecordMode | None,
) -> int:
    """Let a trained policy play, and report how often it meets the spec.

    POLICY is a .safetensors file, the folder of a training, or the name of a level for the policy that comes with it.
    Without POLICY, the policy of the level in --level plays.
    Each episode is played twice: with sampled actions, as in training, and with the most probable actions. The exit
    status is 0 for any pass rate. After Ctrl-C, the report covers the episodes that were played.
    """
    if policy is None and level is None:
        raise click.UsageError("name a POLICY or a --level, or both")
    if recorded and not folder:
        raise click.UsageError("--record needs a folder for the recordings: add --out DIR")
    with cli.Report() as report, name_missing_extra("`tltlc evaluate`"):
        from tltl_runtime.cli.support.level_argument import check_named, check_no_toml

        check_no_toml(spec)
        check_named(policy, level)
        from tltl_runtime.cli.support.evaluation_files import EvaluationFiles
        from tltl_runtime.cli.support.policy_path import check_level_is_shipped, policy_place
        from tltl_runtime.evaluation.evaluate import results, set_up
        from tltl_runtime.evaluation.player import EpisodeRequest, PlayerName
        from tltl_runtime.game.registry import game_of
        from tltl_runtime.policies.file import MAX_BYTES, from_bytes
        from tltlc.api import fileio, replace

        path, name, variant = policy_place(policy, level, "tltlc evaluate")
        # Read the file once: a running training may replace it meanwhile.
        data = fileio.read_bytes(path, str(path), MAX_BYTES)
        loaded_policy, recording = from_bytes(data, str(path)), (recorded or "failures") if folder else None
        sha256 = hashlib.sha256(data).hexdigest()
        if name is None:
            check_level_is_shipped(loaded_policy.card, path, "tltlc evaluate")
        setup = set_up(loaded_policy, name, variant, spec, seed, recording)
        # The spec of a level often has the level's name: do not repeat it.
        labels = tuple(dict.fromkeys((loaded_policy.card.level, loaded_policy.card.fspa.name)))
        setup = replace(setup, player=PlayerName(labels, sha256))
        game = game_of(setup.level)
        report.add(game.play_warnings(game.load_level(setup.level, setup.variant), setup.fspa))
        command_line = _replay_command(policy, level, spec, seed)
        files = EvaluationFiles(setup, path, sha256, first, command_line, folder, json_file)
        # Check this only now: the report may go into the folder, which EvaluationFiles has created.
        check_writable({"--json": None if cli.is_stdout(json_file) else json_file})
        requests = [
            EpisodeRequest(index, sampled) for sampled in (True, False) for index in range(first, first + episodes)
        ]
        try:
            with closing(results(setup, requests, workers, _print_waiting, on_lost=files.add_lost)) as playing:
                for result in _with_progress(playing, len(requests)):
                    files.add(result)
        finally:
            _print_results(files, json_file, folder, episodes)
            if lost := files.lost_episodes:
                report.add([lost.warning])
    return report.status


def _replay_command(policy: Path | None, level: str | None, spec: str | None, seed: int) -> str:
    """Return the shell command that repeats this evaluation, without ``--first`` and ``--episodes``."""
    words = ["tltlc", "evaluate", *([] if policy is None else [str(policy)])]
    words += [] if level is None else [level_option(level), level]
    words += [] if spec is None else ["--spec", spec]
    return join([*words, "--seed", str(seed)])


def _with_progress(playing: Iterator[PlayedEpisode], count: int) -> Iterator[PlayedEpisode]:
    """Yield the episodes of ``playing``, and report progress on standard error.

    On a terminal, the progress is a bar; elsewhere, it is a line for each tenth of the episodes.
    """
    from tltl_runtime.evaluation.player import CHOICES

    played, passed = Counter[bool](), Counter[bool]()
    with _bar(count) as bar:
        for number, result in enumerate(playing, 1):
            yield result
            sampled = result.request.sampled
            played[sampled] += 1
            passed[sampled] += result.summary.success
            so_far = [f"{passed[mode]} of {played[mode]} {name}" for mode, name in CHOICES.items() if played[mode]]
            text = f"passed: {', '.join(so_far)}"
            if bar is not None:
                bar.update(bar.task_ids[0], completed=number, description=text)
            elif number * 10 // count > (number - 1) * 10 // count:
                click.echo(f"{number / count:.0%} played; {text}", err=True)


def _print_waiting(left: float) -> None:
    click.echo(f"waiting for a worker to start on the Ray cluster, for at most {left:.0f} s", err=True)


def _bar(count: int) -> Any:
    if not sys.stderr.isatty():
        return nullcontext()
    from rich.console import Console
    from rich.progress import Progress

    bar = Progress(console=Console(stderr=True), transient=True)
    bar.add_task("starting", total=count)
    return bar


def _print_results(files: EvaluationFiles, json_file: Path | None, folder: Path | None, requested: int) -> None:
    """Print the report on the played episodes; write the JSON report and pictures, if requested.

    ``requested`` episodes were to be played with sampled actions, and as many with the most probable
    actions. If the evaluation was stopped before, first print how many were played. If no episode was
    played, do nothing.
    """
    played = files.episode_counts
    if not any(played.values()):
        return
    lost = files.lost_counts
    complete = all(count + lost[name] == requested for name, count in played.items())
    if not complete:
        counts = " and ".join(f"{count} of {requested} {name}" for name, count in played.items())
        click.echo(f"stopped: {counts} episodes were played", err=True)
    text = json.dumps(files.document(complete), indent=2, ensure_ascii=False) + "\n"
    if not cli.is_stdout(json_file):
        click.echo(files.text(), nl=False)
    else:
        click.echo(text, nl=False)
    contents = files.write(text)
    if removed := files.removed_files:
        click.echo(
            f"removed files of an earlier evaluation from {folder}: {short_list(removed, _MOST_NAMED)}", err=True
        )
    if contents:
        click.echo(f"wrote {contents}", err=True)
