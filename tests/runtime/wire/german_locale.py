"""Make a locale that writes numbers with a comma."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

from tests.waiting import HANG_S


def make_german_locale(folder: Path) -> bool:
    """Make the locale ``de_DE.UTF-8`` in a folder, for the variable LOCPATH; return whether that was possible."""
    words = ["localedef", "-i", "de_DE", "-f", "UTF-8", str(folder / "de_DE.UTF-8")]
    if shutil.which(words[0]) is None:
        return False
    return subprocess.run(words, capture_output=True, timeout=HANG_S, check=False).returncode == 0
