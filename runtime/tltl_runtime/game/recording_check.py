"""Check a recording: run its spec's automaton again on its signals, and describe how a replay differs from it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from tltl_runtime.game.episode import RecordedEpisode
from tltlc.api import Diagnostic, Monitor, TltlError

_Difference = tuple[str, object, object]
"""The name of what differs, the recorded value, and the recomputed value."""


def check(episode: RecordedEpisode) -> tuple[Diagnostic, ...]:
    """Run the spec's automaton again on the recorded signals, and compare the results with the recording.

    Atoms, states, progress, rewards and the kind of end must be equal. Return the diagnostic TLT0823 for
    the first step that differs, and an empty tuple if no step does. If the monitor rejects the signals,
    return the monitor's diagnostics.
    """
    try:
        first = next(_differences(episode), None)
    except TltlError as error:
        return error.diagnostics
    if first is None:
        return ()
    step, (name, recorded, recomputed) = first
    title = f"step {step} of the recording does not follow from its signals: {name} was recorded as "
    help_ = "the recording was changed, or comes from another version of tltlc"
    return (Diagnostic("TLT0823", f"{title}{recorded}, but is {recomputed}", help=help_),)


def replay_difference(episode: RecordedEpisode, row: int, versions: Mapping[str, str]) -> Diagnostic:
    """Return the diagnostic TLT0824: played again, an episode differs from its recording at step ``row``.

    Step 0 is the moment of the reset. ``versions`` are the present versions of Python and of the packages
    that play; the help says which of them have changed since the recording.
    """
    when = f"at step {row}" if row else "at the start"
    title = f"played again from seed {episode.seed}, the episode is different {when}"
    changed = [
        f"{name} {recorded} (now {versions.get(name)})"
        for name, recorded in episode.versions.items()
        if recorded != versions.get(name)
    ]
    help_ = (
        f"it was recorded with {', '.join(changed)}"
        if changed
        else "the game's code or the recording has changed since"
    )
    return Diagnostic("TLT0824", title, help=help_)


def _differences(episode: RecordedEpisode) -> Iterator[tuple[int, _Difference]]:
    """Yield each difference between a recorded and a recomputed value, with the number of its step.

    Step 0 is the moment of the reset.
    """
    names = [signal.name for signal in episode.fspa.signals]
    monitor = Monitor(episode.fspa, episode.params, episode.reward)
    count = len(episode.actions)
    dt = float(episode.times[1] - episode.times[0]) if episode.fspa.clock_varies and count else None
    verdict = episode.fspa.states[0].verdict
    if episode.states[0] or episode.progress[0]:
        yield 0, ("the start", "another one", "state 0 without progress")
    for row in range(1, count + 1):
        if monitor.done:
            yield row, ("its end", "not yet reached", f"step {row - 1}")
        last = row == count and episode.end != "stopped"
        step = monitor.step(dict(zip(names, episode.signals[row].tolist(), strict=True)), dt, last=last)
        verdict = step.verdict
        pairs: list[_Difference] = [
            (f"`{atom.name}`", recorded, value)
            for atom, recorded, value in zip(
                episode.fspa.atoms, episode.atoms[row - 1].tolist(), monitor.values, strict=True
            )
        ]
        pairs += [
            ("the state", int(episode.states[row]), step.state),
            ("the progress", float(episode.progress[row]), step.progress),
            ("the reward", float(episode.rewards[row - 1]), step.reward),
        ]
        yield from ((row, pair) for pair in pairs if pair[1] != pair[2])
    ends: list[_Difference] = [
        ("the verdict", episode.verdict, verdict),
        ("success", episode.success, monitor.success),
        ("the end", episode.end, _end(monitor, verdict)),
    ]
    yield from ((count, pair) for pair in ends if pair[1] != pair[2])


def _end(monitor: Monitor, verdict: str) -> str:
    if not monitor.done:
        return "stopped"
    if monitor.success:
        return "success"
    return "violation" if verdict == "violated" else "limit"
