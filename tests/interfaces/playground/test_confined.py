"""The files that a text may read: only files in the server's folder, and the libraries of tltlc."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.interfaces.playground.test_server import JSON, ask, running_server
from tltlc.interfaces.playground import view
from tltlc.interfaces.playground.child import readable_folders
from tltlc.io.confinement import confine_reads, may_read, outside_diagnostic
from tltlc.io.files import exists, is_dir, is_file, read_source
from tltlc.resolve.imports import standard_library

SECRET = "signal the_secret: bool\n  the_password = 12345\n"
SPEC = "spec x = F the_secret\n"
needs_links = pytest.mark.skipif(os.name == "nt", reason="Windows allows few users to make links")


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The folder of the server, with a secret file beside it."""
    (tmp_path / "secret.tltl").write_text(SECRET, encoding="utf-8")
    own = tmp_path / "own"
    (own / "below").mkdir(parents=True)
    (own / "below" / "common.tltl").write_text("signal a: bool\n", encoding="utf-8")
    monkeypatch.chdir(own)
    with confine_reads(readable_folders()):
        yield own


def messages(text: str) -> list[tuple[str, str]]:
    """Return the codes and titles of the diagnostics for a text, and assert that the answer
    contains no part of the secret."""
    answer: dict[str, Any] = view(text)
    assert "password" not in json.dumps(answer)
    assert "12345" not in json.dumps(answer)
    return [(diagnostic["code"], diagnostic["title"]) for diagnostic in answer["diagnostics"]]


def refusal(name: str) -> list[tuple[str, str]]:
    return [("TLT0777", f"`{name}` is outside the folder of the playground, so it is not read")]


@pytest.mark.parametrize(
    "target",
    [
        "../secret.tltl",
        "../none.tltl",
        "below/../../secret.tltl",
        "./.././secret.tltl",
        "/etc/passwd",
        "/etc/none",
        "/",
        "..",
        "//etc/passwd",
        "/proc/self/environ",
        "/dev/zero",
    ],
)
def test_a_path_that_leads_out_is_rejected_even_without_a_file(folder: Path, target: str) -> None:
    assert messages(f'import "{target}"\n{SPEC}')[:1] == refusal(target)


def test_an_absolute_path_is_treated_like_a_relative_one(folder: Path) -> None:
    assert messages(f'import "{(folder.parent / "secret.tltl").as_posix()}"\n{SPEC}')[0][0] == "TLT0777"
    assert messages(f'import "{(folder / "below" / "common.tltl").as_posix()}"\nspec x = F a\n') == []


def test_a_tilde_is_not_expanded(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(folder.parent))
    assert messages(f'import "~/secret.tltl"\n{SPEC}')[0][0] == "TLT0010"


@needs_links
def test_links_are_judged_by_their_targets(folder: Path) -> None:
    (folder / "linked.tltl").symlink_to(folder.parent / "secret.tltl")
    (folder / "up").symlink_to(folder.parent)
    (folder / "inside.tltl").symlink_to(folder / "below" / "common.tltl")
    assert messages(f'import "linked.tltl"\n{SPEC}')[:1] == refusal("linked.tltl")
    assert messages(f"import linked\n{SPEC}")[:1] == refusal("linked")
    assert messages(f'import "up/secret.tltl"\n{SPEC}')[:1] == refusal("up/secret.tltl")
    assert messages(f"import up.secret\n{SPEC}")[:1] == refusal("up.secret")
    # After links are resolved, this is the folder above again.
    assert messages(f'import "up/own/../secret.tltl"\n{SPEC}')[:1] == refusal("up/own/../secret.tltl")
    assert messages('import "inside.tltl"\nspec x = F a\n') == []
    # A suggestion must not reveal the name of a file outside.
    assert "secret" not in messages("import up.secre\nspec x = true\n")[0][1].replace("up.secre", "")


def test_an_imported_file_cannot_import_from_outside(folder: Path) -> None:
    (folder / "first.tltl").write_text('import "../secret.tltl"\n', encoding="utf-8")
    assert messages(f'import "first.tltl"\n{SPEC}')[:1] == refusal("../secret.tltl")


def test_files_below_and_the_libraries_of_tltlc_are_read(folder: Path) -> None:
    text = 'import stealth\nimport "below/common.tltl"\nimport below.common as c\nspec x = F (alive and a)\n'
    assert not [diagnostic for diagnostic in view(text)["diagnostics"] if diagnostic["severity"] == "error"]


def test_a_project_file_above_is_not_read(folder: Path) -> None:
    (folder.parent / "tltl.toml").write_text("the_password = 12345\n", encoding="utf-8")
    assert messages("signal a: bool\nspec x = F a\n") == []


@needs_links
def test_a_project_file_that_links_outside_is_not_read(folder: Path) -> None:
    (folder.parent / "other.toml").write_text("the_password = 12345\n", encoding="utf-8")
    (folder / "tltl.toml").symlink_to(folder.parent / "other.toml")
    assert messages("signal a: bool\nspec x = F a\n") == []


def test_libraries_outside_are_rejected(folder: Path) -> None:
    for library in ("..", "../none", "/etc", "below/../.."):
        (folder / "tltl.toml").write_text(f'libraries = ["{library}"]\n', encoding="utf-8")
        assert messages("import secret\n") == refusal(library)
    (folder / "tltl.toml").write_text('libraries = ["below"]\n', encoding="utf-8")
    assert messages("import common\nspec x = F a\n") == []


def test_a_game_outside_is_rejected(folder: Path) -> None:
    (folder / "tltl.toml").write_text('game = "../other.game.toml"\n', encoding="utf-8")
    assert messages("import secret\n") == refusal("../other.game.toml")


@needs_links
def test_libraries_are_read_if_the_folder_of_the_server_was_deleted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "secret.tltl").write_text(SECRET, encoding="utf-8")
    gone = tmp_path / "gone"
    gone.mkdir()
    monkeypatch.chdir(gone)
    gone.rmdir()
    with confine_reads(readable_folders()):
        assert messages("import stealth\nspec x = G alive\n") == []
        assert messages("import none\nspec x = true\n")[0] == ("TLT0010", "there is no library `none`")
        # The system would still resolve the parent of the deleted folder.
        for target in ("secret.tltl", "../secret.tltl", "../none.tltl"):
            assert messages(f'import "{target}"\nspec x = true\n')[0][0] == "TLT0010"
        assert messages(f'import "{tmp_path.as_posix()}/secret.tltl"\nspec x = true\n')[0][0] == "TLT0777"


def test_no_reader_sees_a_file_outside(folder: Path) -> None:
    secret = folder.parent / "secret.tltl"
    for path in (secret, Path("../secret.tltl"), folder / ".." / "secret.tltl", Path("a\0b")):
        assert not (may_read(path) or exists(path) or is_file(path) or is_dir(path))
    assert not is_dir(folder.parent)
    with pytest.raises(Exception, match="is outside the folder of the playground"):
        read_source(secret)
    assert may_read(standard_library() / "stealth.tltl")
    # A folder whose name has the same prefix is a different folder.
    (folder.parent / "own2").mkdir()
    assert not may_read(folder.parent / "own2" / "a.tltl")
    assert not may_read(f"{folder}2")
    assert outside_diagnostic("a").code == "TLT0777"


def test_without_confinement_everything_may_be_read(tmp_path: Path) -> None:
    assert may_read(tmp_path / "a")
    assert may_read("/")


NAMES = st.lists(st.sampled_from(["..", ".", "", "below", "up", "loop", "own", "secret.tltl", "common.tltl", "~"]))


@needs_links
@given(st.booleans(), NAMES)
def test_every_allowed_path_is_inside(
    tmp_path_factory: pytest.TempPathFactory, absolute: bool, names: list[str]
) -> None:
    root = tmp_path_factory.getbasetemp() / "fuzzed"
    own = root / "own"
    if not root.exists():
        (own / "below").mkdir(parents=True)
        (root / "secret.tltl").write_text(SECRET)
        (own / "common.tltl").write_text("")
        (own / "up").symlink_to(root)
        (own / "below" / "loop").symlink_to(own / "below")
    path = "/".join([str(own if absolute else os.path.relpath(own)), *names])
    with confine_reads([own]):
        allowed = may_read(path)
    if allowed:
        assert Path(os.path.realpath(path)).is_relative_to(os.path.realpath(own))


def test_the_server_confines_its_requests(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "secret.tltl").write_text(SECRET, encoding="utf-8")
    (tmp_path / "own").mkdir()
    monkeypatch.chdir(tmp_path / "own")
    with running_server() as server:
        for target in ("../secret.tltl", "/etc/passwd"):
            text = json.dumps({"text": f'import "{target}"\n{SPEC}'})
            answer = json.loads(ask(server, "POST", "/api", text, JSON)[2])
            assert [(diagnostic["code"], diagnostic["title"]) for diagnostic in answer["diagnostics"]] == refusal(
                target
            )
            assert answer["diagnostics"][0]["labels"][0]["start"] == len("import ")


@pytest.mark.parametrize("target", ["\0", "a\0.tltl", "a\0b/c.tltl", "below/\0", "../\0"])
def test_a_path_with_a_nul_is_reported_as_missing(folder: Path, target: str) -> None:
    """Such a path leads nowhere, so it does not lead out of the folder."""
    (code, title), *_ = messages(f'import "{target}"\n{SPEC}')
    assert (code, title) == ("TLT0010", f"there is no file `{target}` beside this one")
