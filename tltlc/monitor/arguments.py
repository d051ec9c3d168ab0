"""What monitors are made of, refused where it is of another kind: an automaton, and options of the reward."""

from __future__ import annotations

from tltlc.automaton.fspa import Fspa
from tltlc.monitor.reward import RewardOptions


def automaton(given: object) -> Fspa:
    """The automaton that was given; raises TypeError where it is none."""
    if isinstance(given, Fspa):
        return given
    way_out = "`tltlc.compile_file` returns a tuple of them, `tltlc.load` the one of an artefact"
    raise TypeError(f"an automaton is needed, not {given!r:.60}: {way_out}")


def reward_options(given: object) -> RewardOptions:
    """The options that were given, for None the default ones; raises TypeError where they are none."""
    if given is None:
        return RewardOptions()
    if isinstance(given, RewardOptions):
        return given
    raise TypeError(f'a reward is given as RewardOptions, e.g. RewardOptions(mode="sparse"), not {given!r:.60}')
