"""Lua by two interpreters; newer versions have no ``tanh``, and LuaJIT has its own powers."""

from __future__ import annotations

from tests.conformance.runner import Runner

RUNNERS = tuple(
    Runner(
        name=interpreter,
        target="lua",
        run=(interpreter, "{name}_monitor.lua"),
        tools=(interpreter,),
        tolerance=1e-12,
    )
    for interpreter in ("lua5.4", "luajit")
)
