"""Check the types of a monitor's arguments: the automaton and the options of the reward."""

from __future__ import annotations

from tltlc.automaton.fspa import Fspa
from tltlc.monitor.progress_and_reward import RewardOptions


def automaton_argument(given: object) -> Fspa:
    """Return ``given`` if it is an automaton; raise TypeError otherwise."""
    if isinstance(given, Fspa):
        return given
    advice = "`tltlc.compile_file` returns a tuple of automata, `tltlc.load` returns the automaton of an artefact"
    raise TypeError(f"an automaton is needed, not {given!r:.60}: {advice}")


def reward_options_argument(given: object) -> RewardOptions:
    """Return ``given`` if it is a RewardOptions, the default options if it is None; raise TypeError otherwise."""
    if given is None:
        return RewardOptions()
    if isinstance(given, RewardOptions):
        return given
    raise TypeError(f'RewardOptions are needed, e.g. RewardOptions(mode="sparse"), not {given!r:.60}')
