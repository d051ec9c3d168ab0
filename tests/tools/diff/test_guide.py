"""The commands of the guide to changes run as printed."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tests.docs.blocks import DOCS
from tests.docs.sessions import Shell, run_page


@pytest.mark.skipif(os.name == "nt", reason="the page speaks to a POSIX shell")
def test_the_commands_of_the_guide_to_changes_print_what_it_shows(tmp_path: Path) -> None:
    assert run_page((DOCS / "guides" / "changes.md").read_text(encoding="utf-8"), Shell(tmp_path)) == 4
