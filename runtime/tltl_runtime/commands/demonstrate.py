"""``tltlc demonstrate``: the scripted expert plays a level, and its episodes are recorded."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from tltlc.cli import exits
from tltlc.cli.report import Report
from tltlc.spec_file import split

if TYPE_CHECKING:
    from tltl_runtime.stealth.episodes.episode import Episode


@click.command(
    epilog="""\b
Examples:
  tltlc demonstrate cover_and_hide
  tltlc demonstrate branching:v1 --episodes 20 -o branching_runs
  tltlc demonstrate my_level.toml --spec my_plan.tltl:careful
"""
)
@click.argument("level", metavar="LEVEL[:VARIANT]")
@click.option(
    "--spec", metavar="SPEC[:NAME]", help="What is to be done; by default the spec that the level is made for."
)
@click.option("--episodes", metavar="N", type=click.IntRange(min=1), default=1, show_default=True)
@click.option(
    "--seed",
    metavar="N",
    type=click.IntRange(min=0),
    default=0,
    show_default=True,
    help="Of the first episode; those of the next follow.",
)
@click.option(
    "--output",
    "-o",
    "folder",
    metavar="DIR",
    type=click.Path(path_type=Path, file_okay=False),
    default=Path("demonstrations"),
    show_default=True,
    help="The folder for recordings and plans, made where it is missing.",
)
@click.option("--careless", is_flag=True, help="Play as if nobody could see.")
def command(level: str, spec: str | None, episodes: int, seed: int, folder: Path, careless: bool) -> int:
    """Have the scripted expert play a level.

    Writes for each episode the recording LEVEL-VARIANT-SEED.episode.npz and the plan of its way as a .png.
    The exit status is 1 where an episode does not succeed.
    """
    from tltl_runtime.stealth.env import make_env
    from tltl_runtime.stealth.expert.expert import Expert, play_episode
    from tltl_runtime.stealth.recording import RecordEpisode
    from tltl_runtime.stealth.supply.feasible import warnings

    with Report() as report:
        path, variant = split(level)
        env = RecordEpisode(make_env(path, variant or "v0", spec), "careless expert" if careless else "expert")
        succeeded = 0
        try:
            report.add(warnings(env.get_wrapper_attr("level"), env.get_wrapper_attr("task").fspa))
            expert = Expert(env, careful=not careless)
            for number in range(seed, seed + episodes):
                play_episode(env, expert, number)
                succeeded += env.episode.success
                click.echo(_line(number, env.episode, _write(folder, number, env.episode)))
        finally:
            env.close()
        if episodes > 1:
            click.echo(f"{succeeded} of {episodes} succeeded")
        return exits.CLEAN if succeeded == episodes else exits.FINDINGS
    return report.status


def _write(folder: Path, seed: int, episode: Episode) -> Path:
    """Write the recording and the plan of an episode; the path of the recording."""
    from tltl_runtime.stealth.episodes.file import SUFFIX, write_episode
    from tltl_runtime.stealth.pictures.plan import draw_episode
    from tltlc.writing import write_files

    name = f"{episode.level.name}-{episode.level.variant}-{seed}"
    write_files(folder, {f"{name}.png": draw_episode(episode)})
    path = folder / f"{name}{SUFFIX}"
    write_episode(path, episode)
    return path


def _line(seed: int, episode: Episode, path: Path) -> str:
    """How an episode went."""
    steps, seconds = len(episode.actions), episode.snapshots[-1].time
    ended = f"{episode.end} after {steps} steps, {seconds:.2f} s"
    return f"seed {seed}: {ended}, progress {episode.progress[-1]:.2f}, return {episode.rewards.sum():.3f}: {path}"
