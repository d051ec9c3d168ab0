"""``tltlc record``: demonstrations for an agent to imitate, which meet the spec all of them."""

from __future__ import annotations

from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING

import click

from tltl_runtime.cli.support.at_keyboard import keyboard_options, play_at_keyboard
from tltl_runtime.cli.support.closed_output import on_without_readers
from tltl_runtime.cli.support.level_faults import level_faults
from tltl_runtime.cli.support.options import output_folder
from tltl_runtime.cli.support.printable import plain
from tltl_runtime.stealth.levels.place import level_place
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.interfaces.cli import exits
from tltlc.interfaces.cli.numbers import WholeRange
from tltlc.interfaces.cli.report import Report

if TYPE_CHECKING:
    from tltl_runtime.stealth.keyboard import Recordings
    from tltl_runtime.stealth.recording import RecordEpisode
    from tltl_runtime.stealth.recordings.episode import Episode
    from tltl_runtime.stealth.rendering.camera import View
    from tltl_runtime.training.imitation.demonstrations import Demonstrations, Tried


@click.command(
    epilog="""\b
Examples:
  tltlc record cover_and_hide
  tltlc record branching:v1 --by keyboard --episodes 10 -o mine
  tltlc record --spec my_plan.tltl:careful
  tltlc train --method imitation --demonstrations mine --level branching:v1
"""
)
@click.argument("level", metavar="[LEVEL[:VARIANT]]", required=False)
@click.option("--by", type=click.Choice(("expert", "keyboard")), default="expert", show_default=True, help="Who plays.")
@click.option(
    "--spec", metavar="SPEC[:NAME]", help="What is to be done; by default the spec that the level is made for."
)
@click.option(
    "--episodes",
    metavar="N",
    type=WholeRange(min=1),
    default=20,
    show_default=True,
    help="How many demonstrations there are to be in the folder.",
)
@click.option(
    "--seed",
    metavar="N",
    type=WholeRange(min=0),
    help="Of the first episode (default: 0, with the keyboard another one each time); where the expert fails in one "
    "after the other, those from another seed on may go better.",
)
@output_folder("The folder for the recordings (default: demonstrations/LEVEL-VARIANT-SPEC).")
@keyboard_options
@level_faults()
def command(
    level: str | None,
    by: str,
    spec: str | None,
    episodes: int,
    seed: int | None,
    folder: Path | None,
    view: View,
    crouch: str,
) -> int:
    """Record demonstrations: episodes of the scripted expert, or of a person at the keyboard, that meet the spec.

    Each is a recording LEVEL-VARIANT-SEED.episode.npz.  An episode that does not meet the spec is not kept, and it is
    said why it failed.  What the folder holds already counts, so that the same command goes on where it was stopped;
    recordings there that are no demonstrations of this level and spec, or cannot be read, stay as they are.  LEVEL may
    be left out where the spec names it.

    The exit status is 0 where there are N demonstrations, and 1 where the player stopped before.
    """
    with Report() as report, on_without_readers():
        from tltl_runtime.stealth.env import make_env
        from tltl_runtime.stealth.recording import RecordEpisode
        from tltl_runtime.training.imitation.demonstrations import Demonstrations

        file, variant = _place(level, spec)
        env = RecordEpisode(make_env(file, variant, spec), by)
        made: Demonstrations | None = None
        try:
            shown, task = env.get_wrapper_attr("level"), env.get_wrapper_attr("task")
            folder = folder or Path("demonstrations") / f"{shown.name}-{shown.variant}-{task.fspa.name}"
            made = Demonstrations(folder, shown, task)
            for line in _begins(made, episodes):
                click.echo(line, err=True)
            if made.count < episodes and by == "keyboard":
                _by_keyboard(env, made, episodes, seed, view, crouch)
            elif made.count < episodes:
                _by_expert(env, made, episodes, seed or 0, report)
        except KeyboardInterrupt:
            if made:
                click.echo(f"stopped: {_there(made, episodes)}; the same command goes on", err=True)
            raise
        finally:
            env.close()
        click.echo(_there(made, episodes))
        if made.count < episodes:
            return exits.FINDINGS
        asked = f"--level {shown.name if file == shown.name else quote(file)}:{quote(variant)}"
        about = f"{quote(spec)} {asked}" if spec else asked
        click.echo(f"to imitate them: tltlc train {about} --method imitation --demonstrations {quote(str(folder))}")
        return exits.CLEAN
    return report.status


def _place(level: str | None, spec: str | None) -> tuple[str, str]:
    """Level and variant: those that are named, or the level that the spec names."""
    if level is not None:
        file, variant = level_place(level)
        return file, variant or "v0"
    if spec is None:
        raise click.UsageError("say what to play: a level, or a --spec that names one", click.get_current_context())
    from tltl_runtime.cli.support.level_argument import own_level

    return own_level(spec, "as LEVEL"), "v0"


def _begins(made: Demonstrations, wanted: int) -> list[str]:
    """What the folder holds already."""
    # Of enough the end tells.
    said = [f"{_there(made, wanted)} already"] if 0 < made.count < wanted else []
    if others := len(made.others):
        kept = f"{others} recording{'s' * (others > 1)} there" + (" is none" if others == 1 else " are none")
        first, more = made.others[0], " and others" * (others > 1)
        said.append(plain(f"{kept} of this level and spec: `{first.path.name}` ({first.why}){more}"))
    return said


def _by_expert(env: RecordEpisode, made: Demonstrations, wanted: int, seed: int, report: Report) -> None:
    from tltl_runtime.stealth.capabilities.feasible import reach_warnings
    from tltl_runtime.training.imitation.demonstrations import by_expert

    report.add(reach_warnings(env.get_wrapper_attr("level"), env.get_wrapper_attr("task").fspa))
    for tried in by_expert(env, made, wanted, seed):
        click.echo(_line(tried, wanted))


def _by_keyboard(
    env: RecordEpisode, made: Demonstrations, wanted: int, seed: int | None, view: View, crouch: str
) -> None:
    from tltl_runtime.stealth.recording import writable_folder

    writable_folder(made.folder)

    def recordings(_: str) -> Recordings:
        return _Kept(made, wanted)

    def enough() -> bool:
        return made.count >= wanted

    play_at_keyboard(env, recordings, seed=seed, view=view, crouch=crouch, enough=enough)


class _Kept:
    """Takes the episodes of a person, of which those are written that meet the spec.

    One that its folder refuses goes to the folder for temporary files, and does not count.

    Raises:
        TltlError: TLT0005, of ``save``: that refuses it, too.
    """

    def __init__(self, made: Demonstrations, wanted: int) -> None:
        self._made, self._wanted = made, wanted

    def keep(self, episode: Episode) -> None:
        """An episode that goes on has not met the spec, so there is nothing to write yet."""

    def save(self, episode: Episode) -> str:
        """Write the episode where it is a demonstration; what the player reads of it."""
        try:
            tried = self._made.add(episode)
        except TltlError as refused:
            return self._elsewhere(episode, refused)
        click.echo(_line(tried, self._wanted))
        there = f"{tried.kept} of {self._wanted}"
        return f"{tried.path.name}, {there}" if tried.path else f"not kept, {there}"

    def _elsewhere(self, episode: Episode, refused: TltlError) -> str:
        from tltl_runtime.cli.support.episode_text import episode_line
        from tltl_runtime.cli.support.recording_files import write_elsewhere
        from tltl_runtime.stealth.recordings.file import file_stem

        path = write_elsewhere(episode, file_stem(episode), refused)
        there = f"{self._made.count} of {self._wanted}"
        click.echo(episode_line(episode, f"{path} ({there}, until it is moved to {self._made.folder})"))
        return f"{path}, {there}"


def _line(tried: Tried, wanted: int) -> str:
    from tltl_runtime.cli.support.episode_text import episode_line

    kept = f"{tried.kept} of {wanted}"
    return episode_line(tried.episode, f"{tried.path} ({kept})" if tried.path else f"not kept ({kept})")


def _there(made: Demonstrations, wanted: int) -> str:
    if made.count > wanted:
        asked = f"{wanted} {'is' if wanted == 1 else 'are'} asked for"
        return f"{made.count} demonstrations are in {made.folder}, and {asked}"
    return f"{made.count} of {wanted} demonstrations are in {made.folder}"
