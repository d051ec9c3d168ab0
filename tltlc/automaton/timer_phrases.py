"""What is said of the timers that :mod:`tltlc.resolve.timers` makes: where they hold, and where they do not."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tltlc.resolve.spec import RegisterKind

TIMERS: Final[Mapping[RegisterKind, Mapping[str, tuple[str, str]]]] = {
    "waiting": {"late": ("{2} later than {0} after {1}", "{2} within {0} after {1}")},
    "due": {"due": ("{1} is due after {0}", "{1} is not due after {0}")},
    "breach": {"breach": ("{3} within {0} after {1}", "{2} for {0} after {1}")},
    "samples": {
        "passed": ("{0} have passed", "less than {0} have passed"),
        "lasted": ("{0} are over", "less than {0} have passed"),
        "over": ("more than {0} have passed", "at most {0} have passed"),
    },
    "elapsed": {
        "lasted": ("{0} are over", "less than {0} have passed"),
        "over": ("more than {0} have passed", "at most {0} have passed"),
    },
    "time_since": {
        "lately": ("{1} in the last {0}", "no {1} in the last {0}"),
        "passed": ("{0} have passed since {1}", "less than {0} have passed since {1}"),
    },
    "age": {"recent": ("{1} in the {0} before", "no {1} in the {0} before")},
    "time_holding": {"held": ("{1} for {0}", "{1} for less than {0}")},
    "run": {"held": ("{1} for {0}", "{1} for less than {0}")},
}
"""The two texts of a timer.

The keys are the kind of the register that a timer reads, and the base of its name. The numbers stand
for the arguments of the atom.
"""
ALWAYS: Final[Mapping[str, tuple[str, str]]] = {
    "late": ("no {1} for more than {0}", "{1} again within {0}"),
    "due": ("{0} is due", "{0} is not due"),
}
"""The same for an answer that is due at all times, which has no event before it."""
FROM_START: Final = ("{2} in the first {0}", "{1} for the first {0}")
"""The same for a rule that applies from the first sample on."""
