"""Lua with its own interpreter and with LuaJIT; the size is that of stripped bytecode."""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping
from functools import partial

from benchmarks.engines.engine import BY_HAND, DRIVERS, Engine, Task, fill, make


def _build(interpreter: str, task: Task) -> tuple[str, ...]:
    assignments = ", ".join(
        f"[{json.dumps(signal.name)}] = row[{place}]{' ~= 0' if signal.is_bool else ''}"
        for place, signal in enumerate(task.signals, start=1)
    )
    fill(DRIVERS / "lua/driver.lua", task, spec=task.name, by_hand=str(BY_HAND / "lua"), assignments=assignments)
    return (interpreter, "driver.lua")


def _compiled_sizes(
    name: str, compiler: tuple[str, ...], output: tuple[str, ...], task: Task
) -> Mapping[str, Mapping[str, int]]:
    if shutil.which(compiler[0]) is None:
        return {}
    by_hand = [BY_HAND / f"lua/{file}.lua" for file in ("common", task.name)]
    sizes: dict[str, dict[str, int]] = {}
    for author, files in (("generated", [task.folder / f"{task.name}_monitor.lua"]), ("by_hand", by_hand)):
        sizes[author] = {name: 0}
        for file in files:
            words = (*output, str(file)) if output[0] == "-o" else (str(file), *output)
            make(task, *compiler, *words)
            sizes[author][name] += (task.folder / output[-1]).stat().st_size
    return sizes


def _engine(interpreter: str, title: str, kind: str, compiler: tuple[str, ...], output: tuple[str, ...]) -> Engine:
    return Engine(
        name=interpreter,
        title=title,
        target="lua",
        version=(interpreter, "-v"),
        sources=("{name}_monitor.lua",),
        comments=("--",),
        build=partial(_build, interpreter),
        compiled=partial(_compiled_sizes, kind, compiler, output),
        tools=(interpreter,),
    )


ENGINES = (
    _engine("lua5.4", "Lua 5.4", "luac -s", ("luac5.4", "-s"), ("-o", "bytecode")),
    _engine("luajit", "LuaJIT", "luajit -b -s", ("luajit", "-b", "-s", "-t", "raw"), ("bytecode",)),
)
