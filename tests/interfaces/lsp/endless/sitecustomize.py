"""Python runs this file at the start of each process of a test's server. It makes the analysis of
marked texts endless.

So no test depends on how long it takes to build an automaton. The environment variable ``BEGUN``
names a file that gets a line for each such slow_analysis.
"""

from __future__ import annotations

import os
import sys
import time
from typing import Final

NEVER_ENDS: Final = "// an analysis of this text never ends\n"

if "--multiprocessing-fork" in sys.orig_argv and "BEGUN" in os.environ:
    from tltlc.interfaces.lsp import slow_analysis

    _analyse = slow_analysis.analyse

    def _analyse_or_never_end(request: slow_analysis.Request) -> slow_analysis.DocumentAnalysis:
        if NEVER_ENDS in request.source.text:
            with open(os.environ["BEGUN"], "a", encoding="utf-8") as file:  # noqa: PTH123
                file.write(f"{request.source.name}\n")
            # Sleep: a process that computes would take the time of the other tests.
            while True:
                time.sleep(3600)
        return _analyse(request)

    slow_analysis.analyse = _analyse_or_never_end
