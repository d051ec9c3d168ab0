"""JavaScript with Node; nothing is compiled in advance."""

from __future__ import annotations

import json
from collections.abc import Mapping

from benchmarks.engines.engine import BY_HAND, DRIVERS, Engine, Task, fill


def _build(task: Task) -> tuple[str, ...]:
    assignments = ", ".join(
        f"{json.dumps(signal.name)}: row[{place}]{' !== 0' if signal.is_bool else ''}"
        for place, signal in enumerate(task.signals)
    )
    fill(
        DRIVERS / "javascript/driver.mjs",
        task,
        spec=task.name,
        by_hand=str(BY_HAND / "javascript"),
        assignments=assignments,
    )
    return ("node", "driver.mjs")


def _compiled_sizes(_: Task) -> Mapping[str, Mapping[str, int]]:
    return {}


ENGINES = (
    Engine(
        name="javascript",
        title="JavaScript, Node",
        target="javascript",
        version=("node", "--version"),
        sources=("{name}_monitor.mjs",),
        comments=("//", "/*", "*"),
        build=_build,
        compiled=_compiled_sizes,
        tools=("node",),
    ),
)
