"""Godot 3, which speaks for Godot 4, too: the two scripts differ in a few lines, and no test has Godot 4."""

from __future__ import annotations

from tests.conformance.runner import Runner

RUNNERS = (
    Runner(
        name="gdscript3",
        target="gdscript3",
        build=("touch", "project.godot"),
        # It takes no locale C.
        run=("env", "LANG=en", "godot3-server", "--path", ".", "-s", "{name}_monitor_main.gd"),
        tools=("godot3-server",),
    ),
)
