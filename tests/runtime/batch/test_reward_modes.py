"""Every reward mode is registered by its name: the code for one and for many automata, and the pages, agree."""

from __future__ import annotations

import re
from pathlib import Path
from pkgutil import iter_modules
from types import ModuleType

import pytest

from tltl_runtime.spec.batch import reward_modes as batch_modes
from tltl_runtime.training.files.settings import default_text
from tltlc.monitor import reward_modes as scalar_modes
from tltlc.monitor.progress_and_reward import MODES

ROOT = Path(__file__).parents[3]


@pytest.mark.parametrize("package", [scalar_modes, batch_modes], ids=["one automaton", "many automata"])
def test_every_mode_but_progress_has_a_module(package: ModuleType) -> None:
    assert {module.name for module in iter_modules(package.__path__)} == {*MODES} - {"progress"}


def test_the_semantics_page_has_a_row_for_every_mode_but_progress() -> None:
    page = (ROOT / "docs" / "semantics.md").read_text(encoding="utf-8")
    assert re.findall(r'^\| `mode="(\w+)"` \|', page, re.MULTILINE) == [name for name in MODES if name != "progress"]


def test_the_default_settings_name_every_mode() -> None:
    (names,) = re.findall(r"^mode = .* # (.*)$", default_text(), re.MULTILINE)
    assert tuple(re.split(", | or ", names)) == MODES
