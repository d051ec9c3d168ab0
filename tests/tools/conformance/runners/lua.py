"""Lua, run by two interpreters. Newer versions have no ``tanh``, and LuaJIT computes powers
differently."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from tests.tools.conformance.runner import Runner

_DRIVER = """
local words, leave = arg, os.exit
os.exit = function(status) error({ status = status }) end
for i = 1, #words - 1, 2 do
  local module, path = words[i] .. "_monitor.lua", words[i + 1]
  io.write("@@ ", path, "\\n")
  io.stderr:write("@@ ", path, "\\n")
  arg = { [0] = module, "--full", path }
  local _, ended = pcall(dofile, module)
  io.stderr:write("@@status ", type(ended) == "table" and ended.status or tostring(ended), "\\n")
end
leave(0)
"""


def gather(folder: Path, names: Sequence[str]) -> None:
    """Write ``monitors.lua``, which runs the monitors' files."""
    (folder / "monitors.lua").write_text(_DRIVER)


RUNNERS = tuple(
    Runner(
        name=interpreter,
        target="lua",
        run=(interpreter, "{name}_monitor.lua"),
        build_all=gather,
        run_all=(interpreter, "monitors.lua"),
        tools=(interpreter,),
        tolerance=1e-12,
    )
    for interpreter in ("lua5.4", "luajit")
)
