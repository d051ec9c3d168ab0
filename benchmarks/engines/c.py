"""C99 and C++17 by GNU's compilers, as a game would be compiled: each monitor is a header of one source file."""

from __future__ import annotations

import subprocess
from collections.abc import Mapping
from functools import partial

from benchmarks.engines.engine import BY_HAND, DRIVERS, Engine, Task, fill, make

_WHO = ("generated", "by_hand")


def _build(compiler: tuple[str, ...], task: Task) -> tuple[str, ...]:
    give = "\n".join(
        f"    sample.{signal.field} = numbers[{place}]{' != 0.0' if signal.is_bool else ''};"
        for place, signal in enumerate(task.signals)
    )
    for file in sorted((DRIVERS / "c").iterdir()):
        fill(file, task, spec=task.name, by_hand=str(BY_HAND / "c"), give=give)
    flags = (*compiler, "-O2", "-Wall", "-Wextra", "-Werror", f"-DCOLUMNS={len(task.signals)}")
    for who in _WHO:
        make(task, *flags, f'-DADAPTER="{who}.h"', f"-DWHO={who}", "-c", "pass.c", "-o", f"{who}.o")
    make(task, *flags, "-c", "driver.c", "-o", "driver.o")
    make(task, compiler[0], "driver.o", *(f"{who}.o" for who in _WHO), "-o", "driver", "-lm")
    return ("./driver",)


def _compiled(compiler: tuple[str, ...], task: Task) -> Mapping[str, Mapping[str, int]]:
    found: dict[str, dict[str, int]] = {}
    for who in _WHO:
        found[who] = {}
        for level in ("-O2", "-Os"):
            make(task, *compiler, level, f'-DADAPTER="{who}.h"', "-c", "object.c", "-o", "object.o")
            said = subprocess.run(["size", "object.o"], cwd=task.folder, capture_output=True, text=True, check=True)
            text, data, *_ = said.stdout.splitlines()[1].split()
            found[who][f"{compiler[0]} {level}"] = int(text) + int(data)
    return found


def _engine(name: str, title: str, *compiler: str) -> Engine:
    return Engine(
        name=name,
        title=title,
        target="c",
        version=(compiler[0], "--version"),
        sources=("{name}_monitor.h",),
        comments=("//",),
        build=partial(_build, compiler),
        compiled=partial(_compiled, compiler),
        tools=(compiler[0], "size"),
    )


ENGINES = (
    _engine("c", "C", "gcc", "-std=c99", "-x", "c"),
    _engine("c++", "C++", "g++", "-std=c++17", "-x", "c++"),
)
