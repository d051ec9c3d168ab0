"""The commands and constants of the guide to mining."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tests.docs.blocks import DOCS
from tests.docs.sessions import Shell, run_page
from tltlc.tools.mine.chance import LEVEL
from tltlc.tools.mine.score import PRICE

GUIDE = (DOCS / "guides" / "mining.md").read_text(encoding="utf-8")


@pytest.mark.skipif(os.name == "nt", reason="the page speaks to a POSIX shell")
def test_the_commands_of_the_guide_print_what_it_shows(tmp_path: Path) -> None:
    assert run_page(GUIDE, Shell(tmp_path)) == 9


def test_the_guide_has_the_constants_of_the_code() -> None:
    assert f"- {PRICE} * atoms" in GUIDE
    assert f"a probability of {LEVEL} at most" in GUIDE
