"""Check the types of a monitor's arguments: an automaton, and options of the reward."""

from __future__ import annotations

from tltlc.automaton.fspa import Fspa
from tltlc.monitor.reward import RewardOptions


def automaton(given: object) -> Fspa:
    """Return the given automaton; raises TypeError if it is not one."""
    if isinstance(given, Fspa):
        return given
    advice = "`tltlc.compile_file` returns a tuple of them, `tltlc.load` the one of an artefact"
    raise TypeError(f"an automaton is needed, not {given!r:.60}: {advice}")


def reward_options(given: object) -> RewardOptions:
    """Return the given options, the defaults for None; raises TypeError for anything else."""
    if given is None:
        return RewardOptions()
    if isinstance(given, RewardOptions):
        return given
    raise TypeError(f'a reward is given as RewardOptions, e.g. RewardOptions(mode="sparse"), not {given!r:.60}')
