"""Rust, edition 2021, optimised; the generated monitor is a module of the driver."""

from __future__ import annotations

import subprocess
from collections.abc import Mapping

from benchmarks.engines.engine import BY_HAND, DRIVERS, Engine, Task, fill, make

_FLAGS = ("rustc", "--edition", "2021", "-O", "-C", "debuginfo=0")


def _build(task: Task) -> tuple[str, ...]:
    assignments = ", ".join(
        f"{signal.field}: {f'(row[{place}] != 0.0).into()' if signal.is_bool else f'row[{place}]'}"
        for place, signal in enumerate(task.signals)
    )
    for file in sorted((DRIVERS / "rust").iterdir()):
        fill(file, task, spec=task.name, by_hand=str(BY_HAND / "rust"), assignments=assignments)
    make(task, *_FLAGS, "-D", "warnings", "driver.rs", "-o", "driver")
    return ("./driver",)


def _compiled_sizes(task: Task) -> Mapping[str, Mapping[str, int]]:
    sizes: dict[str, Mapping[str, int]] = {}
    for author, file in (("generated", f"{task.name}_monitor.rs"), ("by_hand", "by_hand.rs")):
        make(task, *_FLAGS, "--crate-type", "lib", "--crate-name", author, "--emit", "obj=object.o", file)
        output = subprocess.run(["size", "object.o"], cwd=task.folder, capture_output=True, text=True, check=True)
        text, data, *_ = output.stdout.splitlines()[1].split()
        sizes[author] = {"rustc -O": int(text) + int(data)}
    return sizes


ENGINES = (
    Engine(
        name="rust",
        title="Rust",
        target="rust",
        version=("rustc", "--version"),
        sources=("{name}_monitor.rs",),
        comments=("//",),
        build=_build,
        compiled=_compiled_sizes,
        tools=("rustc", "size"),
    ),
)
