"""``tltlc replay``: summarize and check recorded episodes, and draw plans and films of them."""

from __future__ import annotations

import json
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import click

from tltl_runtime.cli.support.film import FILMS, Film, write_film
from tltl_runtime.cli.support.input_files import read_each
from tltl_runtime.cli.support.level_options import game_option
from tltl_runtime.cli.support.notation import notation_option
from tltl_runtime.cli.support.options import output_file, summary_format
from tltl_runtime.game.level_name import is_scene, split_level, split_scene
from tltl_runtime.gymnasium_games.level_scenes import level_of_scene
from tltlc.api import cli

if TYPE_CHECKING:
    from tltl_runtime.game.episode import RecordedEpisode
    from tltlc.api import Notation

_VIEWS: Final = ("third_person", "top_down", "overview", "plan")
_ENDINGS: Final = (".png", *FILMS, ".csv")
_ONLY_FOR: Final = {
    "view": FILMS,
    "speed": FILMS,
    "rate": FILMS,
    "size": (".png", *FILMS),
    "start": (*FILMS, ".csv"),
    "stop": (*FILMS, ".csv"),
}
"""For each option, by its parameter name: the file extensions of the outputs that it applies to."""

_SIZES: Final = (160, 4096)
"""The least and the greatest width and height, in pixels."""


def _size(_: click.Context, __: click.Parameter, text: str | None) -> tuple[int, int] | None:
    if text is None:
        return None
    width, cross, height = text.lower().partition("x")
    low, high = _SIZES
    if cross and width.isdecimal() and height.isdecimal() and low <= int(width) <= high and low <= int(height) <= high:
        return int(width), int(height)
    raise click.BadParameter(f"write WIDTHxHEIGHT, each from {low} to {high}, e.g. 640x480")


@click.command(
    epilog="""\b
Examples:
  tltlc replay run.episode.npz                          a summary
  tltlc replay runs/*.episode.npz --check               check the recordings
  tltlc replay run.episode.npz -o run.png               the path, coloured by state
  tltlc replay run.episode.npz -o run.mp4 --view top_down --speed 2 --fps 20
  tltlc replay run.episode.npz -o run.gif --view plan --from 4 --to 9.5
  tltlc replay run.episode.npz -o run.csv               then: tltlc monitor SPEC run.csv
"""
)
@click.argument("files", metavar="FILE...", nargs=-1, required=True)
@output_file("OUT", "Write a plan (.png), a film (.gif, .mp4) or the signals (.csv) instead of the summary.")
@click.option("--view", type=click.Choice(_VIEWS), help="The view of a film (default: third_person).")
@click.option(
    "--speed",
    type=cli.FiniteRange(0.05, 100.0),
    help="The speed of a film (default: 1). 2 is twice as fast as the game.",
)
@click.option(
    "--fps",
    "rate",
    type=cli.FiniteRange(1.0, 60.0),
    help="The frames per second of a film (default: one frame per decision, but at most 30 per second).",
)
@click.option(
    "--size", metavar="WxH", callback=_size, help="The size of a film (default: 640x480) or a plan, in pixels."
)
@click.option(
    "--from",
    "start",
    metavar="SECONDS",
    type=cli.FiniteRange(min=0.0),
    help="The start of a film or of the signals.",
)
@click.option(
    "--to",
    "stop",
    metavar="SECONDS",
    type=cli.FiniteRange(min=0.0),
    help="The end of a film or of the signals.",
)
@game_option("The scene that was recorded: --check and films play it again.")
@notation_option
@click.option("--check", "checked", is_flag=True, help="Check the recording: judge and play the episode again.")
@summary_format
@click.pass_context
def command(
    context: click.Context,
    files: tuple[str, ...],
    path: Path | None,
    view: str | None,
    speed: float | None,
    rate: float | None,
    size: tuple[int, int] | None,
    start: float | None,
    stop: float | None,
    game: str | None,
    notation: Notation,
    checked: bool,
    format: str,  # noqa: A002
) -> int:
    """Show recorded episodes: a summary, a plan of the path, a film, the signals.

    --check judges the recorded signals again, and reports whether the spec gives the recorded atoms, states and
    rewards. It also plays the recorded actions again with the same seed, and reports whether the level gives the same
    episode.
    """
    _check_usage(context, files, path, size)
    from tltl_runtime.game.recording_summary import summary, summary_text
    from tltl_runtime.game.trace import monitor_command

    film = Film(view, speed or 1.0, rate, size or (640, 480), notation)
    summaries: list[dict[str, Any]] = []
    with cli.Report(format, results=True) as report:
        for name, episode in read_each(files, partial(_read, game), report):
            fields = {"file": name, **summary(episode, notation)}
            if checked:
                fields |= _check(episode, report)
            if path is not None:
                _write(path, episode, _span(episode, start, stop), film, size)
                report.say(f"wrote {path}")
                if path.suffix.lower() == ".csv":
                    report.say(f"judge it with: {monitor_command(episode, str(path))}")
            elif format == "text":
                figures = episode.level.game.figures(episode)
                is_elsewhere = not episode.level.game.recordings_have_levels
                print(f"{name}\n{summary_text(fields, figures)}{_check_text(fields, is_elsewhere)}")
            summaries.append(fields)
        if format == "json" and path is None:
            print(json.dumps(summaries, indent=2, ensure_ascii=False))
    return report.status


def _read(game: str | None, path: str) -> RecordedEpisode:
    """Read the recording ``path``.

    ``game``, the value of ``--game``, is None or the scene that was recorded, such as
    ``FILE.game.toml:SCENE``; without ``:SCENE``, the scene in the recording. With it, the episode can be
    played again.
    """
    from tltl_runtime.game.registry import game_of_recording

    recorded = game_of_recording(path)
    episode: RecordedEpisode = recorded.read_episode(Path(path))
    if game is None:
        return episode
    place, variant = split_level(game)
    level = level_of_scene(place if split_scene(place)[1] else f"{place}:{episode.level.name}")
    if recorded.recordings_have_levels and is_scene(level):
        message = f"--game is for recordings of scenes of game files, and `{path}` contains its level: leave it out"
        raise click.UsageError(message, click.get_current_context())
    located: RecordedEpisode = recorded.located(episode, level, variant)
    return located


def _check(episode: RecordedEpisode, report: cli.Report) -> dict[str, bool | None]:
    """Report where a recording contradicts its spec or its game; return the results of both checks.

    ``follows_from_spec`` says whether the spec gives the recorded states and rewards for the recorded
    signals. ``plays_again`` says whether the same episode results if the game plays the actions again;
    None if the game cannot do this.
    """
    from tltl_runtime.game.recording_check import check

    judgement_errors, replay_errors = check(episode), episode.level.game.check_replay(episode)
    report.add((*judgement_errors, *(replay_errors or ())))
    plays_again = None if replay_errors is None else not replay_errors
    return {"follows_from_spec": not judgement_errors, "plays_again": plays_again}


def _check_usage(
    context: click.Context, files: tuple[str, ...], path: Path | None, size: tuple[int, int] | None
) -> None:
    """Raise UsageError for options that the requested output does not use, and for other wrong options."""
    extension = None if path is None else path.suffix.lower()
    if extension is not None and extension not in _ENDINGS:
        raise click.UsageError(f"`{path}` does not end with a known extension: use one of {', '.join(_ENDINGS)}")
    for option in context.command.params:
        kinds = _ONLY_FOR.get(option.name or "", ())
        if kinds and context.params[option.name or ""] is not None and extension not in kinds:
            raise click.UsageError(f"{option.opts[0]} works only if -o writes a {_alternatives(kinds)} file")
    if path is not None and len(files) > 1:
        raise click.UsageError("-o takes one FILE")
    if extension == ".mp4" and size and (size[0] % 2 or size[1] % 2):
        raise click.UsageError("the width and the height of an .mp4 must be even numbers")


def _alternatives(names: Sequence[str]) -> str:
    *begin, last = names
    return f"{', '.join(begin)} or {last}"


def _check_text(fields: dict[str, Any], is_elsewhere: bool) -> str:
    """Return the line that describes the result of ``--check``; an empty text without ``--check``.

    ``fields`` contains the result of :func:`_check`. ``is_elsewhere`` says that recordings of the game
    do not contain their level, so that ``--game`` must name it.
    """
    if "plays_again" not in fields:
        return ""
    follows = "follows" if fields["follows_from_spec"] else "does NOT follow"
    judged = f"\n  checked  the judgement {follows} from the signals"
    if fields["plays_again"] is None:
        missing = "to play it again, say where its game is: --game" if is_elsewhere else "its game cannot play it again"
        return f"{judged}; {missing}\n"
    return f"{judged}; played again it is {'the same' if fields['plays_again'] else 'ANOTHER'} episode\n"


def _span(episode: RecordedEpisode, start: float | None, stop: float | None) -> tuple[float, float]:
    """Return the start and the end of the part of an episode to draw or write, in seconds.

    By default, these are the start and the end of the episode.

    Raises:
        UsageError: the part would be empty.
    """
    end = float(episode.times[-1])
    begin, last = start or 0.0, end if stop is None else stop
    if begin > last and stop is not None:
        raise click.UsageError(f"--from {begin:g} is after --to {last:g}")
    if begin > min(last, end):
        raise click.UsageError(f"there is nothing from {begin:g} s to {last:g} s: the episode ends at {end:.2f} s")
    return begin, min(last, end)


def _write(
    path: Path, episode: RecordedEpisode, span: tuple[float, float], film: Film, size: tuple[int, int] | None
) -> None:
    """Write a plan, a film or the signals of an episode: the extension of ``path`` selects which.

    ``span``, the start and the end in seconds, applies to films and signals, and ``film`` to films.
    ``size``, in pixels, applies to plans. If it is None, the plan has a size that fits its
    contents.

    Raises:
        TltlError: TLT0731, the game draws no pictures; the errors of :func:`write_film`.
    """
    from tltlc.api import fileio

    extension = path.suffix.lower()
    if extension == ".csv":
        from tltl_runtime.game.trace import trace_csv

        fileio.write_file(path, trace_csv(episode, *span))
    elif extension == ".png":
        from tltl_runtime.game.capability_error import capability_error

        pictures = episode.level.game.pictures
        if pictures is None or not pictures.draws(episode):
            raise capability_error(episode.level, "draws no pictures", "write the signals instead: `-o NAME.csv`")
        fileio.write_file(path, pictures.episode(episode, size, film.notation))
    else:
        write_film(path, episode, span, film)
