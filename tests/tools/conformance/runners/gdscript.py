"""Godot 4, if a program ``godot4`` is installed; otherwise Godot 3 (``gdscript3``) stands in for
it."""

from __future__ import annotations

from tests.tools.conformance.runner import Runner

RUNNERS = (
    Runner(
        name="gdscript",
        target="gdscript",
        build=("touch", "project.godot"),
        run=("godot4", "--headless", "--path", ".", "-s", "{name}_monitor_main.gd", "--"),
        tools=("godot4",),
    ),
)
