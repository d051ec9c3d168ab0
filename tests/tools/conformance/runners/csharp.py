"""C# 6, compiled by Mono's compiler with warnings as errors."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from tests.tools.conformance.runner import Runner, execute

STRICT = ("-langversion:6", "-warn:4", "-warnaserror", "-define:TLTL_MAIN")

_DRIVER = """
internal static class Monitors
{
    private static void Main(string[] words)
    {
        for (int i = 0; i + 1 < words.Length; i += 2)
        {
            System.Console.Out.Write("@@ " + words[i + 1] + "\\n");
            System.Console.Out.Flush();
            System.Console.Error.Write("@@ " + words[i + 1] + "\\n");
            System.Console.Error.Write("@@status " + Run(words[i], new[] {"--full", words[i + 1]}) + "\\n");
        }
    }

    private static int Run(string name, string[] rest)
    {
        switch (name)
        {
@@cases@@
            default: return 70;
        }
    }
}
"""


def assemble(folder: Path, names: Sequence[str]) -> None:
    """Build ``monitors.exe``, one assembly with all monitors."""
    cases = [f'            case "{name}": return Tltl.{name}_monitor_program.Main(rest);' for name in names]
    (folder / "monitors.cs").write_text(_DRIVER.replace("@@cases@@", "\n".join(cases)))
    sources = ["monitors.cs", *(f"{name}_monitor.cs" for name in names)]
    execute(["mcs", *STRICT, "-main:Monitors", "-out:monitors.exe", *sources], folder)


RUNNERS = (
    Runner(
        name="csharp",
        target="csharp",
        build=("mcs", *STRICT, "{name}_monitor.cs"),
        run=("mono", "{name}_monitor.exe"),
        build_all=assemble,
        run_all=("mono", "monitors.exe"),
        tools=("mcs", "mono"),
    ),
)
