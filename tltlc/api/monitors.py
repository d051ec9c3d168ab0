"""Rewards, the tables of Algorithm 1, and the checks of samples."""

from tltlc.monitor.arguments import automaton as automaton_argument
from tltlc.monitor.arguments import reward_options
from tltlc.monitor.guards import bounding_literal, robustness
from tltlc.monitor.reward import MODES, Mode, TerminalPenalty, Termination, ends_episode, terminal_penalty
from tltlc.monitor.samples import ROUNDING, WAYS_OUT, Samples, listed, number, param_values, range_text, shown
from tltlc.monitor.tables import tables

__all__ = [
    "MODES",
    "ROUNDING",
    "WAYS_OUT",
    "Mode",
    "Samples",
    "TerminalPenalty",
    "Termination",
    "automaton_argument",
    "bounding_literal",
    "ends_episode",
    "listed",
    "number",
    "param_values",
    "range_text",
    "reward_options",
    "robustness",
    "shown",
    "tables",
    "terminal_penalty",
]
