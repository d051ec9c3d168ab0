"""C99 and C++17 with GCC; each monitor is a header that one source file includes, as in a game."""

from __future__ import annotations

import subprocess
from collections.abc import Mapping
from functools import partial

from benchmarks.engines.engine import BY_HAND, DRIVERS, Engine, Task, fill, make

_AUTHORS = ("generated", "by_hand")
_MACROS = {"generated": ("-DTLTL_SPARSE",), "by_hand": ()}
"""As handwritten monitors, generated ones do not refuse a missing bool."""


def _build(compiler: tuple[str, ...], task: Task) -> tuple[str, ...]:
    assignments = "\n".join(
        f"    sample.{signal.field} = numbers[{place}]{' != 0.0' if signal.is_bool else ''};"
        for place, signal in enumerate(task.signals)
    )
    for file in sorted((DRIVERS / "c").iterdir()):
        fill(file, task, spec=task.name, by_hand=str(BY_HAND / "c"), assignments=assignments)
    flags = (*compiler, "-O2", "-Wall", "-Wextra", "-Werror", f"-DCOLUMNS={len(task.signals)}")
    for author in _AUTHORS:
        defines = (*_MACROS[author], f'-DADAPTER="{author}.h"', f"-DWHO={author}")
        make(task, *flags, *defines, "-c", "pass.c", "-o", f"{author}.o")
    make(task, *flags, "-c", "driver.c", "-o", "driver.o")
    make(task, compiler[0], "driver.o", *(f"{author}.o" for author in _AUTHORS), "-o", "driver", "-lm")
    return ("./driver",)


def _compiled_sizes(compiler: tuple[str, ...], task: Task) -> Mapping[str, Mapping[str, int]]:
    sizes: dict[str, dict[str, int]] = {}
    for author in _AUTHORS:
        sizes[author] = {}
        for level in ("-O2", "-Os"):
            defines = (*_MACROS[author], f'-DADAPTER="{author}.h"')
            make(task, *compiler, level, *defines, "-c", "object.c", "-o", "object.o")
            output = subprocess.run(["size", "object.o"], cwd=task.folder, capture_output=True, text=True, check=True)
            text, data, *_ = output.stdout.splitlines()[1].split()
            sizes[author][f"{compiler[0]} {level}"] = int(text) + int(data)
    return sizes


def _engine(name: str, title: str, *compiler: str) -> Engine:
    return Engine(
        name=name,
        title=title,
        target="c",
        version=(compiler[0], "--version"),
        sources=("{name}_monitor.h",),
        comments=("//",),
        build=partial(_build, compiler),
        compiled=partial(_compiled_sizes, compiler),
        tools=(compiler[0], "size"),
    )


ENGINES = (
    _engine("c", "C", "gcc", "-std=c99", "-x", "c"),
    _engine("c++", "C++", "g++", "-std=c++17", "-x", "c++"),
)
