"""Measure the figures that are missing, then write the report.

``python -m benchmarks`` resumes where an earlier run stopped; ``--fresh`` discards earlier results.
"""

from __future__ import annotations

import argparse
import signal
import sys

from benchmarks import (
    batch,
    bounds,
    compile_table,
    edits,
    engine_speed,
    expert,
    game,
    godot,
    infinite,
    judge,
    mine,
    monitors,
    process,
    report,
    safety,
    suite,
    table1,
    tables,
    tools,
    training,
    verdicts,
)
from benchmarks.machine import facts
from benchmarks.store import Store

SECTIONS = {
    module.SECTION: module
    for module in (
        process,
        monitors,
        batch,
        game,
        godot,
        safety,
        expert,
        training,
        verdicts,
        suite,
        edits,
        table1,
        tables,
        bounds,
        infinite,
        mine,
        judge,
        tools,
        engine_speed,
        compile_table,
    )
}


def main() -> None:
    """Parse the options, measure the sections, and write the report after each measurement."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("--fresh", action="store_true", help="discard earlier results, of that section with --only")
    parser.add_argument("--only", choices=sorted(SECTIONS), help="measure one section")
    parser.add_argument("--timeout", type=float, default=20.0, metavar="SECONDS", help="for a peer on one formula")
    options = parser.parse_args()
    # End by an exception, so that a training that was started is ended, too.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))
    store = Store()
    if options.fresh:
        store.discard(options.only)
        for module in (training, edits, table1):
            if options.only in (None, module.SECTION):
                module.discard()
    if options.only is None or not store.section("machine"):
        # A run of one section, perhaps without the peers, must not change how the other sections were measured.
        store.put("machine", "facts", facts())
        store.put("machine", "options", {"peer_timeout_s": options.timeout})

    def say(text: str) -> None:
        print(text, file=sys.stderr, flush=True)
        report.RESULTS.write_text(report.render(store), encoding="utf-8")

    for name, section in SECTIONS.items():
        if options.only in (None, name):
            section.measure(store, options.timeout, say)
    report.RESULTS.write_text(report.render(store), encoding="utf-8")


if __name__ == "__main__":
    main()
