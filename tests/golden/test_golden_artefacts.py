"""The artefacts of the paper's specifications, and of one over infinite traces, equal the files in ``artefacts/``.

With the environment variable ``UPDATE_GOLDEN=1``, the test rewrites the files; review the changes.
"""

from __future__ import annotations

import os
from pathlib import Path

import pytest

import tltlc
from tltlc.backends import emit

EXAMPLES = Path(__file__).parents[2] / "examples"
ARTEFACTS = Path(__file__).parent / "artefacts"
SPECS = ("cover_and_hide", "navigation", "branching", "branching_as_printed", "patrol")
TARGETS = ("json", "dot", "hoa", "mermaid", "python")


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("spec", SPECS)
def test_an_artefact_equals_its_golden_file(spec: str, target: str) -> None:
    file = EXAMPLES / f"{spec.removesuffix('_as_printed')}.tltl"
    (fspa,) = (fspa for fspa in tltlc.compile_file(file) if fspa.name == spec)
    for name, content in emit(target, fspa).items():
        # A golden monitor is stored as a text file, so that no tool takes it for a module of the project.
        golden = ARTEFACTS / (f"{name}.txt" if name.endswith(".py") else name)
        data = content if isinstance(content, bytes) else content.encode()
        if os.environ.get("UPDATE_GOLDEN") == "1":
            golden.write_bytes(data)
        assert data == golden.read_bytes()


def test_no_golden_is_left_over() -> None:
    assert len(list(ARTEFACTS.iterdir())) == len(SPECS) * len(TARGETS)
