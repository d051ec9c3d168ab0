"""Large workspaces: requests end early with an error, or when the editor cancels them."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

from tests.interfaces.lsp.client import Client, RefusedError
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.interfaces.lsp import workspace as module
from tltlc.interfaces.lsp.workspace import Workspace
from tltlc.io.limits import Limit

TEXT = "signal quiet: bool\nspec hide = G quiet\n"
OTHER = "signal on: bool\nlet start = F on\n" + "// A comment.\n" * 10_000


def _workspace(folder: Path, files: int) -> Workspace:
    for number in range(files):
        (folder / f"{number}.tltl").write_text(TEXT)
    workspace = Workspace()
    workspace.folders = [str(folder)]
    return workspace


@pytest.mark.parametrize(
    ("limit", "most", "message"),
    [
        ("WORKSPACE", Limit(size=3 * len(TEXT), values=100), "MiB of sources"),
        ("WORKSPACE", Limit(size=1000, values=3), "3 files and folders"),
        ("WORKSPACE_PARSED", Limit(size=3 * len(TEXT)), "MiB of sources that may matter here"),
    ],
)
def test_a_workspace_that_is_too_large_is_not_parsed(
    limit: str, most: Limit, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    workspace = _workspace(tmp_path, 4)
    monkeypatch.setattr(module, limit, most)
    with pytest.raises(TltlError, match=f"TLT0004: the folders in the editor contain more than .*{message}"):
        asyncio.run(workspace.parse(lambda text: True))


def test_only_relevant_texts_are_parsed_and_counted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    workspace = _workspace(tmp_path, 4)
    (tmp_path / "other.tltl").write_text(OTHER)
    monkeypatch.setattr(module, "WORKSPACE_PARSED", Limit(size=4 * len(TEXT)))
    asyncio.run(workspace.parse(lambda text: "quiet" in text))
    parsed = {Path(document.source.name).stem for document in workspace.all() if "names" in document.__dict__}
    assert parsed == {"0", "1", "2", "3"}


@pytest.mark.parametrize(
    ("method", "more"),
    [
        ("textDocument/references", {"context": {"includeDeclaration": True}}),
        ("textDocument/rename", {"newName": "calm"}),
        ("textDocument/prepareRename", {}),
    ],
)
def test_a_request_over_many_files_can_be_cancelled(
    client: Client, tmp_path: Path, method: str, more: dict[str, object]
) -> None:
    """The request is cancelled immediately, long before it reaches the last file."""
    declarations = "".join(f"signal s{number}: bool\n" for number in range(2_000))
    for number in range(40):
        (tmp_path / f"{number}.tltl").write_text(f"{TEXT}{declarations}")
    uri = client.open(tmp_path / "0.tltl", TEXT)
    at = {"textDocument": {"uri": uri}, "position": {"line": 0, "character": 8}}
    number = client.start(method, {**at, **more})
    client.tell("$/cancelRequest", {"id": number})
    # A later request is answered while the first one is unfinished.
    assert client.ask("textDocument/foldingRange", {"textDocument": {"uri": uri}}) is not None
    assert client.answer(number)["error"]["code"] == -32800


def test_a_rename_in_a_workspace_that_is_too_large_is_rejected(client: Client, tmp_path: Path) -> None:
    filler = "// Nothing else.\n" * 60_000
    for number in range(6):
        (tmp_path / f"{number}.tltl").write_text(f"{TEXT}{filler}")
    uri = client.open(tmp_path / "0.tltl", TEXT)
    at = {"textDocument": {"uri": uri}, "position": {"line": 0, "character": 8}}
    with pytest.raises(RefusedError, match=r"contain more than 4 MiB of sources that may matter here.*TLT0004"):
        client.ask("textDocument/rename", {**at, "newName": "calm"})
