"""What are the values of the atoms, the progress and the reward of a step?

``Samples`` checks samples of signals and computes the values of the atoms. ``STEP_LENGTH`` is the key
of a sample's length, if the clock varies. ``robustness`` computes
the robustness of a guard. ``nearest_edge`` finds, among some steps, the step that came nearest to
taking an edge towards acceptance. ``tables`` returns the lookup tables for progress. ``MODES`` has the
names of the reward modes; ``mode_function`` returns the function that computes the reward of a
``Transition`` in a mode.
``schedule`` returns the order in which a monitor computes atoms and registers. ``given_atoms`` and
``registers_from_atoms`` say which of them do not, or do, follow from the values of atoms.
``deciding_atoms`` returns the reasons for atoms that say that a rule is broken.
``tltlc.api.Monitor`` does all of this for one automaton, step by step.
"""

from tltlc.automaton.memory import deciding_atoms, given_atoms, registers_from_atoms, schedule
from tltlc.monitor.arguments import automaton_argument, reward_options_argument
from tltlc.monitor.errors import SUGGESTIONS
from tltlc.monitor.guards import bounding_literal, robustness
from tltlc.monitor.nearest_edge import nearest_edge
from tltlc.monitor.progress_and_reward import MODES, Mode, TerminalPenalty, Termination, ends_episode, terminal_penalty
from tltlc.monitor.reward_modes import Transition, mode_function
from tltlc.monitor.samples import (
    ROUNDING,
    STEP_LENGTH,
    Samples,
    finite_signal_value,
    name_list,
    number_text,
    param_values,
    range_text,
)
from tltlc.monitor.tables import tables

__all__ = [
    "MODES",
    "ROUNDING",
    "STEP_LENGTH",
    "SUGGESTIONS",
    "Mode",
    "Samples",
    "TerminalPenalty",
    "Termination",
    "Transition",
    "automaton_argument",
    "bounding_literal",
    "deciding_atoms",
    "ends_episode",
    "finite_signal_value",
    "given_atoms",
    "mode_function",
    "name_list",
    "nearest_edge",
    "number_text",
    "param_values",
    "range_text",
    "registers_from_atoms",
    "reward_options_argument",
    "robustness",
    "schedule",
    "tables",
    "terminal_penalty",
]
