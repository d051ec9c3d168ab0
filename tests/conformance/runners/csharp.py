"""C# 6, by Mono's compiler with warnings as errors: one assembly of all monitors, since compiler starts are slow."""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from pathlib import Path

from tests.conformance.runner import LONGEST_BUILD_S, Runner

STRICT = ("-langversion:6", "-warn:4", "-warnaserror", "-define:TLTL_MAIN")


def assembled(folder: Path, names: Sequence[str]) -> None:
    """``monitors.exe``, whose first argument says which monitor runs."""
    lines = ["internal static class Monitors", "{", "    private static int Main(string[] words)", "    {"]
    lines += ["        var rest = new string[words.Length - 1];"]
    lines += ["        System.Array.Copy(words, 1, rest, 0, rest.Length);", "        switch (words[0])", "        {"]
    lines += [f'            case "{name}": return Tltl.{name}_monitor_program.Main(rest);' for name in names]
    lines += ["            default: return 70;", "        }", "    }", "}", ""]
    (folder / "monitors.cs").write_text("\n".join(lines))
    sources = ["monitors.cs", *(f"{name}_monitor.cs" for name in names)]
    command = ["mcs", *STRICT, "-main:Monitors", "-out:monitors.exe", *sources]
    done = subprocess.run(command, cwd=folder, capture_output=True, timeout=LONGEST_BUILD_S)
    assert done.returncode == 0, (done.stdout + done.stderr).decode(errors="replace")


RUNNERS = (
    Runner(
        name="csharp",
        target="csharp",
        build_all=assembled,
        run=("mono", "monitors.exe", "{name}"),
        tools=("mcs", "mono"),
    ),
)
