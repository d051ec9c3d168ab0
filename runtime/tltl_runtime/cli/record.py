"""``tltlc record``: record demonstrations that meet the spec, for imitation learning."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from tltl_runtime.cli.support.closed_output import ignore_closed_pipe
from tltl_runtime.cli.support.keyboard_play import keyboard_of, keyboard_options, play_at_keyboard
from tltl_runtime.cli.support.level_faults import level_faults
from tltl_runtime.cli.support.options import output_folder
from tltl_runtime.cli.support.plain_text import plain_text
from tltl_runtime.cli.support.slow_starts import slow_starts_shown
from tltl_runtime.game.level_name import level_option, split_level
from tltl_runtime.gymnasium_games.level_scenes import level_of_scene
from tltlc.api import TltlError, cli

if TYPE_CHECKING:
    from tltl_runtime.game.episode import RecordedEpisode
    from tltl_runtime.game.keyboard import Crouch, Recordings
    from tltl_runtime.game.level import Level
    from tltl_runtime.game.recorder import EpisodeRecorder
    from tltl_runtime.training.imitation.demonstrations import Attempt, Demonstrations
    from tltlc.api import Diagnostic


@click.command(
    epilog="""\b
Examples:
  tltlc record hall.game.toml:small
  tltlc record lake.game.toml:small --by keyboard --episodes 10 -o mine
  tltlc record lake.game.toml:small --tape traces/trace-0001.tape.jsonl -o mine
  tltlc record my_level.toml --spec my_plan.tltl:careful
  tltlc train --method imitation --demonstrations mine --game lake.game.toml:small
"""
)
@click.argument("level", metavar="[LEVEL[:VARIANT]]", required=False)
@click.option(
    "--by",
    type=click.Choice(("expert", "keyboard")),
    default="expert",
    show_default=True,
    help="Who plays: the expert of the game or you.",
)
@click.option("--spec", metavar="SPEC[:NAME]", help="The spec that judges the player (default: the spec of the level).")
@click.option(
    "--episodes",
    metavar="N",
    type=cli.WholeRange(min=1),
    default=20,
    show_default=True,
    help="The number of demonstrations wanted in the folder.",
)
@click.option(
    "--seed",
    metavar="N",
    type=cli.WholeRange(min=0),
    help="The seed of the first episode (default: 0; with the keyboard a new seed each time). Try another seed if the "
    "expert fails again and again.",
)
@click.option(
    "--tape",
    "tapes",
    metavar="FILE",
    multiple=True,
    help="Play this tape of a person again instead, from its own seed. May be given several times.",
)
@output_folder("The folder for the recordings (default: demonstrations/LEVEL-VARIANT-SPEC).")
@keyboard_options
@level_faults()
@slow_starts_shown()
def command(
    level: str | None,
    by: str,
    spec: str | None,
    episodes: int,
    seed: int | None,
    tapes: tuple[str, ...],
    folder: Path | None,
    view: str,
    crouch: Crouch,
) -> int:
    """Record demonstrations: episodes of an expert or of a person that meet the spec.

    LEVEL is a scene of your game, `FILE.game.toml:SCENE`, or a level of the stealth game that comes with tltlc: its
    name (`tltlc list levels`) or its file. Each demonstration is a recording LEVEL-VARIANT-SEED.episode.npz. An episode
    that fails is not kept, and the command says why it failed. If a game in another process ends or hangs, the command
    continues with the next episode. Demonstrations that are already in the folder count, so the same command continues
    where it stopped. Other recordings in the folder, and files that cannot be read, stay as they are. You may omit
    LEVEL if the spec names it.

    With --tape, each tape that meets the spec becomes a demonstration.

    The exit status is 0 if there are N demonstrations, and 1 if the player stopped earlier. With --tape, it is 0 if all
    tapes are demonstrations.
    """
    with cli.Report() as report, ignore_closed_pipe():
        from tltl_runtime.game.capability_error import no_expert_error
        from tltl_runtime.game.recorder import closing_on_error
        from tltl_runtime.game.registry import game_of
        from tltl_runtime.training.imitation.demonstrations import Demonstrations
        from tltl_runtime.training.imitation.tape_episode import PLAYER as TAPE_PLAYER

        if tapes and any(_is_given(name) for name in ("by", "episodes", "seed")):
            raise click.UsageError("a tape is one play, with its own seed: leave out --by, --episodes and --seed")
        file, variant = _level_and_variant(level, spec)
        game = game_of(file)
        loaded = game.load_level(file, variant)
        player = TAPE_PLAYER if tapes else by
        mode = keyboard_of(loaded).render_mode if player == "keyboard" else None
        env = closing_on_error(
            game.make_env(file, variant, spec, render_mode=mode), partial(game.recorder, player=player)
        )
        demonstrations: Demonstrations | None = None
        try:
            if player == "expert" and not game.has_expert(env):
                raise no_expert_error(loaded)
            task = env.get_wrapper_attr("task")
            folder = folder or Path("demonstrations") / f"{loaded.name}-{loaded.variant}-{task.fspa.name}"
            demonstrations = Demonstrations(folder, loaded, task)
            for line in _existing_lines(demonstrations, 0 if tapes else episodes):
                click.echo(line, err=True)
            if tapes:
                episodes = demonstrations.count + len(tapes)
                episodes = _record_tapes(env, demonstrations, tapes, report)
            elif demonstrations.count < episodes and by == "keyboard":
                _record_person(env, loaded, demonstrations, episodes, seed, view, crouch)
            elif demonstrations.count < episodes:
                report.add(game.play_warnings(loaded, task.fspa))
                _record_expert(env, demonstrations, episodes, seed or 0, report)
        except KeyboardInterrupt:
            if demonstrations:
                click.echo(
                    f"stopped: {_count_text(demonstrations, episodes)}; run the same command again to continue",
                    err=True,
                )
            raise
        finally:
            env.close()
        click.echo(_count_text(demonstrations, episodes))
        if demonstrations.count < episodes:
            return report.status or cli.exits.FINDINGS
        place = f"{level_option(file)} {loaded.name if file == loaded.name else quote(file)}:{quote(variant)}"
        arguments = f"{quote(spec)} {place}" if spec else place
        click.echo(f"to imitate them: tltlc train {arguments} --method imitation --demonstrations {quote(str(folder))}")
        return cli.exits.CLEAN
    return report.status


def _is_given(option: str) -> bool:
    """Whether an option of the command is on the command line."""
    return click.get_current_context().get_parameter_source(option) is ParameterSource.COMMANDLINE


def _level_and_variant(level: str | None, spec: str | None) -> tuple[str, str]:
    """Return the level and the variant to play.

    ``level`` is ``LEVEL`` or ``LEVEL:VARIANT``. If it is None, return the level that the spec names.
    The default variant is ``v0``.
    """
    if level is not None:
        file, variant = split_level(level_of_scene(level))
        return file, variant or "v0"
    if spec is None:
        raise click.UsageError("say what to play: a level, or a --spec that names one", click.get_current_context())
    from tltl_runtime.cli.support.level_argument import own_level

    return own_level(spec, "as LEVEL"), "v0"


def _existing_lines(demonstrations: Demonstrations, requested: int) -> list[str]:
    """Describe, in at most two lines, the recordings that the folder of demonstrations already has."""
    # If there are enough demonstrations, the last line of the output says so.
    lines = [f"{_count_text(demonstrations, requested)} already"] if 0 < demonstrations.count < requested else []
    if number := len(demonstrations.rejected):
        count_text = f"{number} recording{'s' * (number > 1)} in the folder "
        count_text += "is not a demonstration" if number == 1 else "are not demonstrations"
        first, suffix = demonstrations.rejected[0], f" and {number - 1} more" if number > 1 else ""
        lines.append(plain_text(f"{count_text} of this level and spec: `{first.path.name}` ({first.reason}){suffix}"))
    return lines


def _record_expert(
    env: EpisodeRecorder[Any], demonstrations: Demonstrations, requested: int, seed: int, report: cli.Report
) -> None:
    from tltl_runtime.training.imitation.demonstrations import expert_attempts
    from tltl_runtime.wire.lost_episodes import lost_episodes

    faults: list[Diagnostic] = []
    try:
        for attempt in expert_attempts(env, demonstrations, requested, seed, on_lost=faults.append):
            click.echo(_attempt_line(attempt, requested))
    finally:
        if lost := lost_episodes(faults):
            report.add([lost.warning])


def _record_tapes(
    env: EpisodeRecorder[Any], demonstrations: Demonstrations, tapes: Sequence[str], report: cli.Report
) -> int:
    """Play tapes again and write those that meet the spec. Return how many demonstrations there are if all do."""
    from tltl_runtime.cli.support.episode_text import episode_line
    from tltl_runtime.game.tape import read_tape
    from tltl_runtime.training.imitation.tape_episode import tape_episode

    failed = 0
    for name in tapes:
        try:
            attempt = demonstrations.add(tape_episode(env, read_tape(name), name))
        except TltlError as error:
            report.add(error.diagnostics)
            failed += 1
            continue
        failed += attempt.path is None
        click.echo(episode_line(attempt.episode, str(attempt.path or f"not kept ({name})")))
    return demonstrations.count + failed


def _record_person(
    env: EpisodeRecorder[Any],
    level: Level,
    demonstrations: Demonstrations,
    requested: int,
    seed: int | None,
    view: str,
    crouch: Crouch,
) -> None:
    from tltl_runtime.support.writable_folder import writable_folder

    writable_folder(demonstrations.folder)

    def recordings(_: str) -> Recordings:
        return _DemonstrationRecorder(demonstrations, requested)

    def enough() -> bool:
        return demonstrations.count >= requested

    play_at_keyboard(env, level, recordings, seed=seed, view=view, crouch=crouch, enough=enough)


class _DemonstrationRecorder:
    """Writes the episodes that meet the spec, while a person plays.

    ``requested`` is the number of demonstrations wanted in the folder; messages show it.

    If the folder of demonstrations cannot be written, an episode goes to the folder for temporary
    files instead, and does not count as a demonstration.

    Raises:
        TltlError: TLT0005, from ``save``: the folder for temporary files cannot be written, either.
    """

    def __init__(self, demonstrations: Demonstrations, requested: int) -> None:
        self._demonstrations, self._requested = demonstrations, requested

    def keep(self, episode: RecordedEpisode) -> None:
        """Do nothing: an unfinished episode has not met the spec yet."""

    def save(self, episode: RecordedEpisode) -> str:
        """Write the episode if it meets the spec; return the text that the player sees.

        Examples of the text: ``NAME.episode.npz, 3 of 20`` and ``not kept, 2 of 20``.
        """
        try:
            attempt = self._demonstrations.add(episode)
        except TltlError as error:
            return self._save_elsewhere(episode, error)
        click.echo(_attempt_line(attempt, self._requested))
        count = f"{attempt.kept} of {self._requested}"
        return f"{attempt.path.name}, {count}" if attempt.path else f"not kept, {count}"

    def _save_elsewhere(self, episode: RecordedEpisode, error: TltlError) -> str:
        from tltl_runtime.cli.support.episode_text import episode_line
        from tltl_runtime.cli.support.recording_files import write_elsewhere
        from tltl_runtime.game.recording_path import file_stem

        path = write_elsewhere(episode, file_stem(episode), error)
        count = f"{self._demonstrations.count} of {self._requested}"
        click.echo(
            episode_line(episode, f"{path} ({count}, not counted until you move it to {self._demonstrations.folder})")
        )
        return f"{path}, {count}"


def _attempt_line(attempt: Attempt, requested: int) -> str:
    from tltl_runtime.cli.support.episode_text import episode_line

    count = f"{attempt.kept} of {requested}"
    return episode_line(attempt.episode, f"{attempt.path} ({count})" if attempt.path else f"not kept ({count})")


def _count_text(demonstrations: Demonstrations, requested: int) -> str:
    if demonstrations.count > requested:
        return f"{demonstrations.count} demonstrations are in {demonstrations.folder}; you asked for {requested}"
    return f"{demonstrations.count} of {requested} demonstrations are in {demonstrations.folder}"
