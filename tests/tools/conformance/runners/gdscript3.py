"""Godot 3. It also stands in for Godot 4, which is not installed where the tests run; the two
scripts differ in a few lines."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from tests.tools.conformance.runner import Runner

# Godot does not accept the locale C.
_ENGINE = ("env", "LANG=en", "godot3-server", "--path", ".", "-s")

_DRIVER = """extends SceneTree


func _init() -> void:
	var words: Array = []
	for argument in OS.get_cmdline_args():
		words.append(argument)
	words = words.slice(words.find("monitors.gd") + 1, words.size())
	for i in range(0, words.size() - 1, 2):
		print("@@ " + words[i + 1])
		printerr("@@ " + words[i + 1])
		var program = load("res://" + words[i] + "_monitor_run.gd").new()
		printerr("@@status " + str(program._run(["--full", words[i + 1]])))
	quit()
"""

_BASE = "extends SceneTree\n"
_START = "func _init() -> void:\n\tquit(_run(_arguments()))\n"


def gather(folder: Path, names: Sequence[str]) -> None:
    """Write ``monitors.gd``, and a copy of each program without the code that makes it quit the
    engine."""
    (folder / "project.godot").touch()
    (folder / "monitors.gd").write_text(_DRIVER)
    for name in names:
        program = (folder / f"{name}_monitor_main.gd").read_text(encoding="utf-8")
        assert program.count(_BASE) == program.count(_START) == 1
        program = program.replace(_BASE, "extends Reference\n").replace(_START, "")
        (folder / f"{name}_monitor_run.gd").write_text(program, encoding="utf-8")


RUNNERS = (
    Runner(
        name="gdscript3",
        target="gdscript3",
        build=("touch", "project.godot"),
        run=(*_ENGINE, "{name}_monitor_main.gd"),
        build_all=gather,
        run_all=(*_ENGINE, "monitors.gd"),
        tools=("godot3-server",),
    ),
)
