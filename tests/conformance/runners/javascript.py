"""JavaScript by Node, whose ``exp``, ``tanh`` and ``pow`` are not those of the C library."""

from __future__ import annotations

from tests.conformance.runner import Runner

RUNNERS = (
    Runner(
        name="node",
        target="javascript",
        run=("node", "{name}_monitor.mjs"),
        tools=("node",),
        tolerance=1e-12,
    ),
)
