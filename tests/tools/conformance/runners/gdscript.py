"""Godot 4, where its program is called ``godot4``; Godot 3 (``gdscript3``) speaks for it where there is none."""

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
