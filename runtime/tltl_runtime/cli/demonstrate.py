"""``tltlc demonstrate``: record episodes of the expert of a game."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tltl_runtime.cli.support.film import FILMS, Film, films_of, write_film
from tltl_runtime.cli.support.level_faults import level_faults
from tltl_runtime.cli.support.notation import notation_option
from tltl_runtime.cli.support.options import output_folder, seed_option
from tltl_runtime.cli.support.slow_starts import slow_starts_shown
from tltl_runtime.game.level_name import split_level
from tltl_runtime.gymnasium_games.level_scenes import level_of_scene
from tltlc.api import Diagnostic, cli

if TYPE_CHECKING:
    from tltl_runtime.game.episode import RecordedEpisode
    from tltlc.api import Notation


@click.command(
    epilog="""\b
Examples:
  tltlc demonstrate hall.game.toml:small
  tltlc demonstrate hall.game.toml:small:dark --episodes 20 -o runs
  tltlc demonstrate my_level.toml --spec my_plan.tltl:careful --film gif
"""
)
@click.argument("level", metavar="LEVEL[:VARIANT]")
@click.option("--spec", metavar="SPEC[:NAME]", help="The spec that judges the player (default: the spec of the level).")
@click.option(
    "--episodes",
    metavar="N",
    type=cli.WholeRange(min=1),
    default=1,
    show_default=True,
    help="How many episodes the expert plays.",
)
@seed_option("The seed of the first episode. Each following episode adds 1.")
@output_folder("The folder for recordings and plans. It is created if it is missing.", default=Path("demonstrations"))
@click.option("--film", type=click.Choice([ending[1:] for ending in FILMS]), help="Write a film of each episode, too.")
@notation_option
@click.option("--careless", is_flag=True, help="In the stealth game: play as if no guard could see the player.")
@level_faults()
@slow_starts_shown()
def command(
    level: str,
    spec: str | None,
    episodes: int,
    seed: int,
    folder: Path,
    film: str | None,
    notation: Notation,
    careless: bool,
) -> int:
    """Let the expert of a game play, and record it.

    LEVEL is a scene of your game, `FILE.game.toml:SCENE`, or a level of the stealth game that comes with tltlc: its
    name (`tltlc list levels`) or its file. A game of your own has an expert if its environment has a method
    `tltl_expert()`. For each episode, the command writes the recording LEVEL-VARIANT-SEED.episode.npz and a plan of the
    path (.png), and says why an episode failed. Existing files are kept: a different episode with the same name becomes
    LEVEL-VARIANT-SEED-2, and so on. If a game in another process ends or hangs, its episode is lost, and counts neither
    as a success nor as a failure. The exit status is 1 if an episode fails.
    """
    from tltl_runtime.cli.support.episode_text import episode_line
    from tltl_runtime.game.capability_error import no_expert_error
    from tltl_runtime.game.recorder import closing_on_error
    from tltl_runtime.game.registry import game_of
    from tltl_runtime.wire.lost_episodes import LossLimit, going_on, lost_episodes, most_lost

    with cli.Report() as report:
        file, variant = split_level(level_of_scene(level))
        game = game_of(file)
        loaded = game.load_level(file, variant or "v0")
        if film:
            films_of(loaded)
        player = "careless expert" if careless else "expert"
        env = closing_on_error(game.make_env(file, variant or "v0", spec), partial(game.recorder, player=player))
        played = succeeded = 0
        left, faults = iter(range(seed, seed + episodes)), list[Diagnostic]()
        begin = partial(game.expert_episodes, env, left, careful=not careless)
        try:
            if not game.has_expert(env):
                raise no_expert_error(loaded)
            report.add(game.play_warnings(loaded, env.get_wrapper_attr("task").fspa))
            for episode in going_on(begin, LossLimit(most_lost(episodes)), faults.append):
                path = _write(folder, episode, film, notation)
                played, succeeded = played + 1, succeeded + episode.success
                click.echo(episode_line(episode, str(path)))
        except KeyboardInterrupt:
            click.echo(f"stopped: {played} of {episodes} episodes were recorded", err=True)
            raise
        finally:
            env.close()
            lost = lost_episodes(faults)
            if lost and episodes > 1:
                report.add([lost.warning])
        if episodes > 1:
            click.echo(f"{succeeded} of {played} succeeded")
        return cli.exits.CLEAN if succeeded == played else cli.exits.FINDINGS
    return report.status


def _write(folder: Path, episode: RecordedEpisode, film: str | None, notation: Notation) -> Path:
    """Write the recording of an episode, and a picture of its path if the game can draw one.

    If ``film`` is not None, also write a film: ``film`` is the extension of its file, ``gif`` or
    ``mp4``. All files have the same name, apart from their extensions. Return the recording's path.
    """
    from tltl_runtime.game.recording_path import SUFFIX, file_stem, new_path
    from tltlc.api import fileio

    game = episode.level.game
    recording = game.episode_bytes(episode)
    pictures = game.pictures if game.pictures and game.pictures.draws(episode) else None
    endings = [*([".png"] if pictures else []), *([f".{film}"] if film else [])]
    path = new_path(folder, file_stem(episode), recording, endings)
    name = path.name.removesuffix(SUFFIX)
    plan = {f"{name}.png": pictures.episode(episode, notation=notation)} if pictures else {}
    fileio.write_files(folder, {**plan, path.name: recording})
    if film:
        span = (0.0, float(episode.times[-1]))
        write_film(folder / f"{name}.{film}", episode, span, Film(notation=notation))
    return path
