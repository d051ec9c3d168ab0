"""Run the program of a monitor over many traces in one process, for tests that have hundreds of them."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from tltlc import backends
from tltlc.automaton.fspa import Fspa
from tltlc.record import record

LONGEST_RUN_S = 300
NAME = "odd"

_C = r"""
#define main monitor_main
#include "odd_monitor.h"
#undef main
#include <sys/wait.h>
#include <unistd.h>

int main(int argc, char **argv) {
    for (int i = 1; i < argc; i++) {
        int status = 0;
        printf("@@ %s\n", argv[i]);
        fprintf(stderr, "@@ %s\n", argv[i]);
        fflush(stdout);
        char *arguments[] = {argv[0], (char *)"--full", argv[i], NULL};
        const pid_t child = fork();
        if (child == 0) exit(monitor_main(3, arguments));
        waitpid(child, &status, 0);
        fprintf(stderr, "@@status %d\n", WEXITSTATUS(status));
    }
    return 0;
}
"""

_JAVASCRIPT = """
import { main } from "./odd_monitor_and_main.mjs";
process.stdout.setMaxListeners(0);
for (const path of process.argv.slice(2)) {
  process.stdout.write(`@@ ${path}\\n`);
  process.stderr.write(`@@ ${path}\\n`);
  const status = await main(["--full", path]);
  process.stderr.write(`@@status ${status}\\n`);
}
"""

_LUA = """
local paths, leave = arg, os.exit
os.exit = function(status) error({ status = status }) end
for _, path in ipairs(paths) do
  io.write("@@ ", path, "\\n")
  io.stderr:write("@@ ", path, "\\n")
  arg = { [0] = "odd_monitor.lua", "--full", path }
  local _, ended = pcall(dofile, "odd_monitor.lua")
  io.stderr:write("@@status ", type(ended) == "table" and ended.status or tostring(ended), "\\n")
end
leave(0)
"""

_PYTHON = """
import sys
from odd_monitor import main
for path in sys.argv[1:]:
    for stream in (sys.stdout, sys.stderr):
        print(f"@@ {path}", file=stream, flush=True)
    status = main(["--full", path])
    print(f"@@status {status}", file=sys.stderr, flush=True)
"""

_RUST = """
mod odd_monitor;

fn main() {
    for path in std::env::args_os().skip(1) {
        println!("@@ {}", path.to_string_lossy());
        eprintln!("@@ {}", path.to_string_lossy());
        let status = odd_monitor::program::run(vec!["--full".into(), path]);
        eprintln!("@@status {status}");
    }
}
"""

_CSHARP = """
internal static class Batch
{
    private static void Main(string[] paths)
    {
        foreach (string path in paths)
        {
            System.Console.Out.Write("@@ " + path + "\\n");
            System.Console.Out.Flush();
            System.Console.Error.Write("@@ " + path + "\\n");
            int status = Tltl.odd_monitor_program.Main(new[] {"--full", path});
            System.Console.Error.Write("@@status " + status + "\\n");
        }
    }
}
"""


@record
class Batch:
    """How the programs of one language run over many traces; ``build`` is a command, ``drivers`` are files."""

    name: str
    target: str
    drivers: Mapping[str, str]
    run: tuple[str, ...]
    build: tuple[str, ...] = ()

    def missing(self) -> str | None:
        """Why it cannot be used here, if it cannot."""
        lacking = [tool for tool in (self.run[0], *self.build[:1]) if "/" not in tool and shutil.which(tool) is None]
        return f"{self.name}: {', '.join(lacking)} is not installed" if lacking else None


_MCS = ("mcs", "-langversion:6", "-define:TLTL_MAIN", "-main:Batch", "-out:batch.exe", "batch.cs", "odd_monitor.cs")

BATCHES = (
    Batch("c", "c", {"batch.c": _C}, ("./batch_c",), ("gcc", "-O1", "-DTLTL_MAIN", "batch.c", "-o", "batch_c", "-lm")),
    Batch("node", "javascript", {"batch.mjs": _JAVASCRIPT}, ("node", "batch.mjs")),
    Batch("lua5.4", "lua", {"batch.lua": _LUA}, ("lua5.4", "batch.lua")),
    Batch("luajit", "lua", {"batch.lua": _LUA}, ("luajit", "batch.lua")),
    Batch("python", "python", {"batch.py": _PYTHON}, (sys.executable, "batch.py")),
    Batch(
        "rust",
        "rust",
        {"batch.rs": _RUST},
        ("./batch_rs",),
        ("rustc", "--edition", "2021", "--cfg", "tltl_main", "batch.rs", "-o", "batch_rs"),
    ),
    Batch("csharp", "csharp", {"batch.cs": _CSHARP}, ("mono", "batch.exe"), _MCS),
)

Outcome = tuple[int, str, str]
"""Exit status, standard output, standard error."""


def built(batch: Batch, fspa: Fspa, folder: Path) -> Callable[[Sequence[bytes]], list[Outcome]]:
    """A function that runs the program of an automaton, whose name is ``NAME``, over many traces."""
    for name, content in {**backends.emit(batch.target, fspa), **batch.drivers}.items():
        (folder / name).write_bytes(content.encode() if isinstance(content, str) else content)
    if batch.target == "javascript":
        module = (folder / "odd_monitor.mjs").read_text(encoding="utf-8")
        (folder / "odd_monitor_and_main.mjs").write_text(f"{module}\nexport {{ main }};\n", encoding="utf-8")
    if batch.build:
        done = subprocess.run(batch.build, cwd=folder, capture_output=True, timeout=LONGEST_RUN_S)
        assert done.returncode == 0, (done.stdout + done.stderr).decode(errors="replace")
    return lambda traces: _ran(batch, folder, traces)


def _ran(batch: Batch, folder: Path, traces: Sequence[bytes]) -> list[Outcome]:
    names = [f"{number}.csv" for number in range(len(traces))]
    for name, trace in zip(names, traces, strict=True):
        (folder / name).write_bytes(trace)
    done = subprocess.run([*batch.run, *names], cwd=folder, capture_output=True, timeout=LONGEST_RUN_S)
    out, err = (_pieces(text.decode(errors="replace"), names) for text in (done.stdout, done.stderr))
    outcomes = []
    for name in names:
        said, _, status = err[name].rpartition("@@status ")
        assert re.fullmatch(r"\d+\s*", status), f"{batch.name}, {name}: {err[name]}"
        outcomes.append((int(status), out[name], said))
    return outcomes


def _pieces(text: str, names: Sequence[str]) -> dict[str, str]:
    """What was said of each trace."""
    pieces = re.split(r"^@@ (\d+\.csv)\n", text, flags=re.MULTILINE)
    found = dict(zip(pieces[1::2], pieces[2::2], strict=True))
    assert [*found] == [*names], f"it ended before its time: {text[-2000:]}"
    return found
