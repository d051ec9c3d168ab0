"""Types of settings whose value is one of a few words.

The settings of the network and of the rewards have their types elsewhere.
"""

from __future__ import annotations

from typing import Literal

Method = Literal["automaton", "imitation"]
"""Whether an agent learns from the rewards of the spec's automaton or from demonstrations."""

EntropySchedule = Literal["fading", "fixed"]
"""Whether the weight of the entropy bonus falls as the spec is met more often."""

PenaltySchedule = Literal["rising", "fixed"]
"""Whether the terminal penalty of failed episodes rises as the spec is met more often."""

Pool = Literal["processes", "ray"]
"""Whether the environments run in processes on this machine or on a Ray cluster."""
