"""Play the actions of a recording again, and compare the episodes bit for bit."""

from __future__ import annotations

from tltl_runtime.game.recording_check import replay_difference
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.recordings.versions import versions
from tltlc.api import Diagnostic


def resimulate(episode: Episode) -> int | None:
    """Play an episode's actions again from its seed; return the first step that differs in any bit.

    Return None if no step differs. Step 0 is the moment of the reset. A step differs if its
    snapshot differs, or if a signal of the spec that the game supplies differs.

    Raises:
        TltlError: TLT0730, pybullet is not installed.
    """
    from tltl_runtime.stealth.simulation import Simulation
    from tltl_runtime.stealth.world.physics import WorldError

    names = [(column, signal.name) for column, signal in enumerate(episode.fspa.signals)]
    row = 0
    game = None
    try:
        game = Simulation(episode.level)
        game.reset(episode.seed)
        own = [(column, name) for column, name in names if name in game.readers]
        for row, snapshot in enumerate(episode.snapshots):
            if row:
                game.step(episode.actions[row - 1].tolist())
            signals = game.signals()
            if game.snapshot() != snapshot or any(
                signals[name] != episode.signals[row, column] for column, name in own
            ):
                return row
    except WorldError:
        return row
    finally:
        if game is not None:
            game.close()
    return None


def check_replay(episode: Episode) -> tuple[Diagnostic, ...]:
    """Return an error (TLT0824) if :func:`resimulate` finds a difference, else an empty tuple.

    The help of the diagnostic says which versions have changed since the recording. Raises the
    errors of :func:`resimulate`.
    """
    row = resimulate(episode)
    return () if row is None else (replay_difference(episode, row, versions()),)
