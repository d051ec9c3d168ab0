"""Run the programs in the guides."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from tests.docs.blocks import ROOT, Block
from tests.waiting import HANG_S


def check_program(program: Block, printed: Block, path: Path) -> None:
    """Run a ``program`` of a guide from the file ``path``, and check what it prints.

    ``printed`` is the block of the guide that shows the output.
    """
    path.write_text(program.text, encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "runtime")])}
    done = subprocess.run(
        [sys.executable, path.name],
        cwd=path.parent,
        env=environment,
        capture_output=True,
        encoding="utf-8",
        timeout=HANG_S,
        check=False,
    )
    assert (done.stdout, done.returncode) == (printed.text, 0), done.stderr
