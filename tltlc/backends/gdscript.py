"""A stand-alone monitor in GDScript, for Godot 4."""

from __future__ import annotations

from tltlc.automaton.fspa import Fspa
from tltlc.backends import Files, Options, Target
from tltlc.backends.godot.dialect import Dialect
from tltlc.backends.godot.source import ENDINGS, files

TARGET = Target("gdscript", "a stand-alone monitor in GDScript, for Godot 4", ENDINGS, ("gd", "godot", "godot4"))

DIALECT = Dialect(
    version="godot4",
    title="Godot 4",
    base="RefCounted",
    functions={"abs": "absf", "tanh": "tanh", "min": "minf", "max": "maxf"},
    swapped=frozenset({"min", "max"}),
    typed=True,
    wide=True,
)


def emit(fspa: Fspa, options: Options) -> Files:
    """Return the monitor ``NAME_monitor.gd``, and ``NAME_monitor_main.gd``, which runs it as a program.

    NAME is the name of the automaton.
    """
    return files(fspa, DIALECT)
