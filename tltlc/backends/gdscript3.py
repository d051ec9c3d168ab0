"""A stand-alone monitor in GDScript, for Godot 3."""

from __future__ import annotations

from tltlc.automaton.fspa import Fspa
from tltlc.backends import Files, Options, Target
from tltlc.backends.godot.dialect import Dialect
from tltlc.backends.godot.source import ENDINGS, files

TARGET = Target("gdscript3", "a stand-alone monitor in GDScript, for Godot 3", ENDINGS, ("godot3",))

DIALECT = Dialect(
    version="godot3",
    title="Godot 3",
    base="Reference",
    functions={"abs": "abs", "tanh": "tanh"},
    swapped=frozenset(),
    typed=False,
    wide=False,
)


def emit(fspa: Fspa, options: Options) -> Files:
    """Return the monitor ``NAME_monitor.gd``, and ``NAME_monitor_main.gd``, which runs it as a program.

    NAME is the name of the automaton.
    """
    return files(fspa, DIALECT)
