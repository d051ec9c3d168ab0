"""Python in isolated mode: without user site-packages, environment variables or modules beside the
script."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from tests.tools.conformance.runner import Runner

_DRIVER = """
import importlib
import sys
sys.path.insert(0, ".")
words = sys.argv[1:]
for name, path in zip(words[::2], words[1::2]):
    main = importlib.import_module(f"{name}_monitor").main
    for stream in (sys.stdout, sys.stderr):
        print(f"@@ {path}", file=stream, flush=True)
    status = main(["--full", path])
    print(f"@@status {status}", file=sys.stderr, flush=True)
"""


def gather(folder: Path, names: Sequence[str]) -> None:
    """Write ``monitors.py``, which imports the monitors' modules."""
    (folder / "monitors.py").write_text(_DRIVER)


RUNNERS = (
    Runner(
        name="python",
        target="python",
        run=(sys.executable, "-I", "{name}_monitor.py"),
        build_all=gather,
        run_all=(sys.executable, "-I", "monitors.py"),
    ),
)
