"""C# 6, compiled by Mono's compiler with warnings as errors."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from tests.tools.conformance.runner import Runner, execute
from tltlc.program.enums import pascal_case

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
    cases = [f'            case "{name}": return Tltl.{pascal_case(name)}MonitorProgram.Main(rest);' for name in names]
    (folder / "monitors.cs").write_text(_DRIVER.replace("@@cases@@", "\n".join(cases)))
    sources = ["monitors.cs"]
    for name in names:
        sources += [f"{pascal_case(name)}Monitor.cs", f"{pascal_case(name)}MonitorProgram.cs"]
    execute(["mcs", *STRICT, "-main:Monitors", "-out:monitors.exe", *sources], folder)


RUNNERS = (
    Runner(
        name="csharp",
        target="csharp",
        build=("mcs", *STRICT, "{Name}Monitor.cs", "{Name}MonitorProgram.cs"),
        run=("mono", "{Name}Monitor.exe"),
        build_all=assemble,
        run_all=("mono", "monitors.exe"),
        tools=("mcs", "mono"),
    ),
)
