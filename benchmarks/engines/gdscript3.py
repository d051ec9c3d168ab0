"""GDScript with Godot 3, whose monitors are nearly those of Godot 4; scripts are compiled when they are loaded."""

from __future__ import annotations

import shutil
from collections.abc import Mapping

from benchmarks.engines.engine import BY_HAND, DRIVERS, Engine, Task, fill

# Godot does not accept the locale C, and needs a project.
_COMMAND = 'LANG=en exec godot3-server --path . -s driver.gd "$@"'


def _build(task: Task) -> tuple[str, ...]:
    assignments = "\n".join(
        f"\t\tsample.{signal.field} = row[{place}]{' != 0.0' if signal.is_bool else ''}"
        for place, signal in enumerate(task.signals)
    )
    fill(DRIVERS / "gdscript3/driver.gd", task, spec=task.name, assignments=assignments)
    for file in ("common", task.name):
        shutil.copy(BY_HAND / f"gdscript3/{file}.gd", task.folder)
    (task.folder / "project.godot").touch()
    return ("bash", "-c", _COMMAND, "driver")


def _compiled_sizes(_: Task) -> Mapping[str, Mapping[str, int]]:
    return {}


ENGINES = (
    Engine(
        name="gdscript3",
        title="GDScript, Godot 3",
        target="gdscript3",
        version=("godot3-server", "--version"),
        sources=("{name}_monitor.gd",),
        comments=("#",),
        build=_build,
        compiled=_compiled_sizes,
        tools=("godot3-server", "bash"),
    ),
)
