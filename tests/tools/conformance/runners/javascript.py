"""JavaScript, run by Node, whose ``exp``, ``tanh`` and ``pow`` differ from the C library's."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from tests.tools.conformance.runner import Runner

_DRIVER = """
process.stdout.setMaxListeners(0);
const words = process.argv.slice(2);
for (let i = 0; i + 1 < words.length; i += 2) {
  const { main } = await import(`./${words[i]}_monitor_and_main.mjs`);
  process.stdout.write(`@@ ${words[i + 1]}\\n`);
  process.stderr.write(`@@ ${words[i + 1]}\\n`);
  const status = await main(["--full", words[i + 1]]);
  process.stderr.write(`@@status ${status}\\n`);
}
"""


def gather(folder: Path, names: Sequence[str]) -> None:
    """Write ``monitors.mjs``, and a copy of each module that also exports its ``main``."""
    (folder / "monitors.mjs").write_text(_DRIVER)
    for name in names:
        module = (folder / f"{name}_monitor.mjs").read_text(encoding="utf-8")
        (folder / f"{name}_monitor_and_main.mjs").write_text(f"{module}\nexport {{ main }};\n", encoding="utf-8")


RUNNERS = (
    Runner(
        name="node",
        target="javascript",
        run=("node", "{name}_monitor.mjs"),
        build_all=gather,
        run_all=("node", "monitors.mjs"),
        tools=("node",),
        tolerance=1e-12,
    ),
)
