from __future__ import annotations

import sys

from tests.conformance.runner import Runner

RUNNERS = (
    Runner(
        name="python",
        target="python",
        run=(sys.executable, "-I", "{name}_monitor.py"),
    ),
)
