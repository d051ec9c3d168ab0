"""Godot 4, where its program is called ``godot4``; Godot 3 (``gdscript3``) speaks for it where there is none."""

from __future__ import annotations

from tests.conformance.runner import Runner

# The engine prints lines of its own first.
_COMMAND = """
    set -o pipefail; script=$1; shift
    godot4 --headless --path . -s "$script" -- "$@" | sed -n '/^step,state,/,$p'
"""

RUNNERS = (
    Runner(
        name="gdscript",
        target="gdscript",
        build=("touch", "project.godot"),
        run=("bash", "-c", _COMMAND, "run", "{name}_monitor_main.gd"),
        tools=("godot4", "bash"),
    ),
)
