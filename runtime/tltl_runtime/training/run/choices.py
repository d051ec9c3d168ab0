"""The texts that settings choose from, apart from those of the network and of the rewards."""

from __future__ import annotations

from typing import Literal

Method = Literal["automaton", "imitation"]
"""What an agent learns from: the rewards of the spec's automaton, or demonstrations."""

EntropySchedule = Literal["fading", "fixed"]
"""Whether the entropy bonus weighs the less, the more often the spec is met."""

PenaltySchedule = Literal["rising", "fixed"]
"""Whether what a violation costs rises as the spec is met."""

Pool = Literal["processes", "ray"]
"""Where the processes run that play: on this machine, or in a Ray cluster."""
