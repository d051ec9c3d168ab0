"""Incremental updates of the workspace give the same results as a new workspace."""

from __future__ import annotations

import os
from itertools import count
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests import pipes
from tests.fuzzing import times
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic
from tltlc.interfaces.lsp.workspace import Workspace

TEXTS = {
    "common.tltl": (
        "signal loud: bool\nsignal dark: ratio\nlet quiet = G not loud\n",
        "signal loud: ratio\nlet quiet = G loud > 50 %\n",
        "signal loud bool\n",
    ),
    "middle.tltl": (
        'import "common.tltl"\nlet both = quiet and F loud\n',
        'import "common.tltl"\nsignal on: bool\nlet both = F on\n',
        "signal on: bool\nlet both = F on\n",
    ),
    "main.tltl": (
        'import "middle.tltl"\nspec main = both and quiet\n',
        'import "common.tltl" as c\nspec main = c.quiet or F c.dark > 10 %\n',
        "import common\nspec main = quiet and F loud\n",
    ),
    "tltl.toml": ("", "libaries = []\n", 'libraries = ["shared"]\n'),
    "shared/common.tltl": ("let quiet = true\n",),
}
STEPS = st.tuples(
    st.sampled_from(["type", "type", "close", "write", "delete"]),
    st.sampled_from([*TEXTS]),
    st.integers(0, 2),
)
BEGINNING = [("write", "common.tltl", 0), ("write", "middle.tltl", 0), ("write", "shared/common.tltl", 0)]
Diagnostics = tuple[Diagnostic, ...]


def diagnostics_of(workspace: Workspace, uri: str) -> tuple[Diagnostics, Diagnostics]:
    """Return the diagnostics of a document and of its project, without help and fixes, which search
    whole folders."""
    document = workspace.document(uri)
    assert document is not None
    diagnostics = tuple(replace(diagnostic, help=None, fixes=()) for diagnostic in document.diagnostics)
    return diagnostics, workspace.project(document.source)[1]


@given(st.integers(0, 2), st.lists(STEPS, min_size=1, max_size=12))
@times(60)
def test_every_history_gives_the_results_of_a_new_workspace(main: int, steps: list[tuple[str, str, int]]) -> None:
    times = count(1)
    with TemporaryDirectory() as place:
        folder = Path(place)
        (folder / "shared").mkdir()
        workspace, published, texts = Workspace(), {}, {}
        for action, name, number in (*BEGINNING, ("type", "main.tltl", main), *steps):
            file, text = folder / name, TEXTS[name][number % len(TEXTS[name])]
            uri = file.as_uri()
            if action == "type":
                texts[uri] = text
                touched = workspace.put(uri, None, text)
            elif action == "close":
                texts.pop(uri, None)
                published.pop(uri, None)
                touched = workspace.close(uri)
            else:
                if action == "write":
                    file.write_text(text, encoding="utf-8")
                    # The file system's clock is too coarse for edits this fast, so the times are set.
                    os.utime(file, ns=(next(times), next(times)))
                else:
                    file.unlink(missing_ok=True)
                touched = workspace.refresh()
            for changed_uri in touched:
                published[changed_uri] = diagnostics_of(workspace, changed_uri)
        fresh = Workspace()
        for uri, text in texts.items():
            fresh.put(uri, None, text)
        assert published == {uri: diagnostics_of(fresh, uri) for uri in texts}


def test_a_virtual_document_with_the_name_of_a_project_file_affects_no_other_document(tmp_path: Path) -> None:
    workspace, uri = Workspace(), (tmp_path / "main.tltl").as_uri()
    workspace.put(uri, None, "signal seen: bool\n")
    diagnostics_of(workspace, uri)
    virtual = "vscode-vfs://github/games/rules/tltl.toml"
    assert workspace.put(virtual, None, TEXTS["tltl.toml"][1]) == [virtual]
    real = (tmp_path / "tltl.toml").as_uri()
    assert workspace.put(real, None, TEXTS["tltl.toml"][1]) == [real, uri]


def test_pipes_in_the_folders_of_the_workspace_are_not_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "main.tltl").write_text("signal seen: bool\n")
    pipes.put_beside(tmp_path / "pipe.tltl")
    pipes.forbid(monkeypatch)
    workspace = Workspace()
    workspace.folders = [str(tmp_path)]
    assert [Path(document.source.name).name for document in workspace.all()] == ["main.tltl"]
