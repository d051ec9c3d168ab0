"""C# with Mono's compiler and runtime, optimised; the size is that of a library."""

from __future__ import annotations

from collections.abc import Mapping

from benchmarks.engines.engine import BY_HAND, DRIVERS, Engine, Task, fill, make
from tltlc.program.enums import pascal_case

_COMPILER = ("mcs", "-langversion:6", "-optimize+", "-debug-")


def _build(task: Task) -> tuple[str, ...]:
    assignments = ", ".join(
        f"{pascal_case(signal.field)} = row[{place}]{' != 0.0' if signal.is_bool else ''}"
        for place, signal in enumerate(task.signals)
    )
    generated = f"Tltl.{pascal_case(task.name)}Monitor"
    for author, pass_, types in (
        ("generated", "Generated", (generated, f"{generated}.Result", f"{generated}.Signals")),
        ("by_hand", "ByHandPass", ("ByHand.Monitor", "ByHand.Result", "ByHand.Signals")),
    ):
        monitor, result, signals = types
        tokens = {"who": author, "monitor": monitor, "result": result, "signals": signals, "assignments": assignments}
        fill(DRIVERS / "csharp/Pass.cs", task, **tokens, **{"pass": pass_})
        (task.folder / "Pass.cs").replace(task.folder / f"{pass_}.cs")
    sources = ("Generated.cs", "ByHandPass.cs", *_generated(task), *_by_hand(task))
    make(task, *_COMPILER, "-out:driver.exe", str(DRIVERS / "csharp/Driver.cs"), *sources)
    return ("mono", "driver.exe")


def _compiled_sizes(task: Task) -> Mapping[str, Mapping[str, int]]:
    sizes: dict[str, Mapping[str, int]] = {}
    for author, sources in (("generated", _generated(task)), ("by_hand", _by_hand(task))):
        make(task, *_COMPILER, "-target:library", f"-out:{author}.dll", *sources)
        sizes[author] = {"mcs, library": (task.folder / f"{author}.dll").stat().st_size}
    return sizes


def _generated(task: Task) -> tuple[str, ...]:
    return (f"{pascal_case(task.name)}Monitor.cs",)


def _by_hand(task: Task) -> tuple[str, ...]:
    return tuple(str(BY_HAND / f"csharp/{file}.cs") for file in ("Common", task.name))


ENGINES = (
    Engine(
        name="csharp",
        title="C#, Mono",
        target="csharp",
        version=("mono", "--version"),
        sources=("{Name}Monitor.cs",),
        comments=("//",),
        build=_build,
        compiled=_compiled_sizes,
        tools=("mcs", "mono"),
    ),
)
