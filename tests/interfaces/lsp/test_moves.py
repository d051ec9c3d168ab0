"""Renamed files and folders, and the files that import them."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.interfaces.lsp.client import Client
from tltlc.interfaces.lsp.edits import apply_edits
from tltlc.interfaces.lsp.file_renames import edits_of_moves
from tltlc.interfaces.lsp.workspace import Workspace

FILES = {
    "tltl.toml": 'libraries = ["shared"]\n',
    "shared/noise.tltl": "signal loud: bool\n",
    "levels/common.tltl": "import noise\nlet quiet = G not loud\n",
    "levels/vault.tltl": 'import common\nimport "../shared/noise.tltl"\nimport core\nspec v = quiet\n',
    "main.tltl": 'import levels.common as c\nimport "levels/common.tltl"\nspec m = c.quiet\n',
}


@pytest.mark.parametrize(
    ("moves", "expected"),
    [
        (
            {"levels/common.tltl": "levels/basics.tltl"},
            {
                "main.tltl": 'import levels.basics as c\nimport "levels/basics.tltl"\nspec m = c.quiet\n',
                "levels/vault.tltl": 'import basics\nimport "../shared/noise.tltl"\nimport core\nspec v = quiet\n',
            },
        ),
        (
            {"levels": "stages"},
            {"main.tltl": 'import stages.common as c\nimport "stages/common.tltl"\nspec m = c.quiet\n'},
        ),
        (
            {"levels/common.tltl": "levels/a b.tltl"},
            {
                "main.tltl": 'import "levels/a b.tltl" as c\nimport "levels/a b.tltl"\nspec m = c.quiet\n',
                "levels/vault.tltl": 'import "a b.tltl"\nimport "../shared/noise.tltl"\nimport core\nspec v = quiet\n',
            },
        ),
        (
            {"levels/vault.tltl": "vault.tltl", "shared/noise.tltl": "shared/sound.tltl"},
            {
                "levels/common.tltl": "import sound\nlet quiet = G not loud\n",
                "levels/vault.tltl": 'import levels.common\nimport "shared/sound.tltl"\nimport core\nspec v = quiet\n',
            },
        ),
        ({"levels/vault.tltl": "levels/strongroom.tltl"}, {}),
    ],
    ids=["file", "folder", "no_name", "two", "importing"],
)  # fmt: skip
def test_imports_follow_renamed_files(moves: dict[str, str], expected: dict[str, str], tmp_path: Path) -> None:
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    workspace = Workspace()
    workspace.folders = [str(tmp_path)]
    moved = edits_of_moves([(str(tmp_path / old), str(tmp_path / new)) for old, new in moves.items()], workspace)
    after = {
        str(Path(document.source.name).relative_to(tmp_path)): apply_edits(document.source.text, edits)
        for document, edits in moved
    }
    assert after == expected
    # After the files are moved, every text is still free of errors.
    for name, text in after.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    for old, new in moves.items():
        (tmp_path / old).rename(tmp_path / new)
    assert [document.diagnostics for document in workspace.all()] == [()] * 4


@pytest.mark.parametrize("name", ['p"q', "p\nq", "p\rq"])
def test_a_path_that_no_import_can_contain_is_not_written(name: str, tmp_path: Path) -> None:
    """The import does not change, and then has an error."""
    for path, text in FILES.items():
        (tmp_path / path).parent.mkdir(exist_ok=True)
        (tmp_path / path).write_text(text, encoding="utf-8")
    workspace = Workspace()
    workspace.folders = [str(tmp_path)]
    assert edits_of_moves([(str(tmp_path / "levels"), str(tmp_path / name))], workspace) == []


def test_an_editor_asks_before_it_renames(tmp_path: Path) -> None:
    client = Client(tmp_path, workspace={"fileOperations": {"willRename": True, "didRename": True}})
    (filters,) = {
        str(filters_of_operation)
        for filters_of_operation in client.capabilities["workspace"]["fileOperations"].values()
    }
    assert "**/*.tltl" in filters
    (tmp_path / "common.tltl").write_text("signal loud: bool\n", encoding="utf-8")
    text = 'import "common.tltl"\nspec hush = G !loud\n'
    uri = client.open(tmp_path / "main.tltl", text)
    files = [{"oldUri": (tmp_path / "common.tltl").as_uri(), "newUri": (tmp_path / "noise.tltl").as_uri()}]
    changes = client.ask("workspace/willRenameFiles", {"files": files})["changes"]
    assert [edit["newText"] for edit in changes.pop(uri)] == ['"noise.tltl"']
    assert changes == {}
    (tmp_path / "common.tltl").rename(tmp_path / "noise.tltl")
    client.change(uri, text.replace("common", "noise"))
    client.tell("workspace/didRenameFiles", {"files": files})
    assert client.diagnostics(uri, lambda diagnostics: not diagnostics) == []
    assert client.close() == 0
