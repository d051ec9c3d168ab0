"""Godot 3, which speaks for Godot 4, too: the two scripts differ in a few lines, and no test has Godot 4."""

from __future__ import annotations

from tests.conformance.runner import Runner

# The engine prints two lines of its own first; it takes no locale C, and asks for a project.
_COMMAND = 'set -o pipefail; LANG=en godot3-server --path . -s "$@" | tail -n +3'

RUNNERS = (
    Runner(
        name="gdscript3",
        target="gdscript3",
        build=("touch", "project.godot"),
        run=("bash", "-c", _COMMAND, "run", "{name}_monitor_main.gd"),
        tools=("godot3-server", "bash"),
    ),
)
