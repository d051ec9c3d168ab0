"""The summary of a recorded episode that ``tltlc replay`` prints, as JSON and as text."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tltl_runtime.game.episode import RecordedEpisode
from tltl_runtime.support.number_text import column, number, share
from tltlc.api import EMPTY, Notation, label_text, record


@record
class GameFigures:
    """Figures of an episode that only its game has, such as the player's health.

    ``values`` are for programs, by name. ``lines`` are for people: each has a name of at most 8
    characters and a text.
    """

    values: Mapping[str, float] = EMPTY
    lines: tuple[tuple[str, str], ...] = ()


def summary(episode: RecordedEpisode, notation: Notation = "english") -> dict[str, Any]:
    """Return a summary of an episode as JSON data.

    The key ``changes`` has a row for the start and for each change of the automaton's state. The
    label in a row says, in ``notation``, what remains to be satisfied in that state. Figures that only
    the episode's game has, such as health, follow the key ``reward``.
    """
    level, fspa, game = episode.level, episode.fspa, episode.level.game
    result, reason = game.summary(episode), game.cause(episode)
    states, times = episode.states.tolist(), episode.times.tolist()
    rows = [row for row in range(result.steps + 1) if row == 0 or states[row] != states[row - 1]]
    return {
        "level": level.name,
        "variant": level.variant,
        "spec": fspa.name,
        "player": episode.player,
        "seed": episode.seed,
        "steps": result.steps,
        "seconds": result.seconds,
        "limit_steps": fspa.limit_steps,
        "end": result.end,
        "success": result.success,
        "cause": {
            "kind": reason.kind,
            "by": reason.by,
            "time": reason.time,
            "place": reason.place,
            "text": reason.text,
        },
        "verdict": result.verdict,
        "progress": result.progress,
        "reward": result.reward,
        **game.figures(episode).values,
        "params": dict(episode.params),
        "versions": dict(episode.versions),
        "changes": [
            {
                "step": row,
                "time": times[row],
                "state": states[row],
                "progress": float(episode.progress[row]),
                "label": label_text(fspa, states[row], notation),
            }
            for row in rows
        ],
    }


def summary_text(values: Mapping[str, Any], figures: GameFigures) -> str:
    """Return the result of :func:`summary` as text for people.

    ``figures`` come from :meth:`Game.figures <tltl_runtime.game.game.Game.figures>`.
    """
    limit = "" if values["limit_steps"] is None else f" of {values['limit_steps']}"
    # Without a clock, the times are the numbers of the steps.
    is_timed = values["seconds"] != values["steps"]
    seconds = f", {values['seconds']:.2f} s" if is_timed else ""
    end = values["end"] if values["verdict"] in ("satisfied", "violated") else f"{values['end']}, {values['verdict']}"
    lines = [
        f"  level    {values['level']}:{values['variant']}, spec {values['spec']}",
        column("  player   ", f"{values['player']}, seed {values['seed']}"),
        f"  end      {end}, after {values['steps']}{limit} steps{seconds}",
        *([] if values["success"] else [column("  why      ", values["cause"]["text"])]),
        f"  reward   {number(values['reward'], 3)}, progress {share(values['progress'], 3)}",
        *(f"  {name:<8} {text}" for name, text in figures.lines),
        "",
        f"    {'time' if is_timed else 'step'}  state  progress  what remains",
    ]
    moments = [f"{change['time']:8.2f}" if is_timed else f"{change['step']:8}" for change in values["changes"]]
    lines += [
        column(f"{moment}  {change['state']:5}  {share(change['progress'], 3):>8}  ", change["label"])
        for moment, change in zip(moments, values["changes"], strict=True)
    ]
    return "\n".join(lines) + "\n"
