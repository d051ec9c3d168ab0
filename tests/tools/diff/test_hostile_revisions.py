"""Git trees that ``git add`` never makes: with paths out of the folder, or with too many paths."""

from __future__ import annotations

import io
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.tools.diff.repository import _repository, git, needs_git  # noqa: F401
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.io.limits import Limit
from tltlc.tools.diff import git as revisions

Run = Callable[..., Outcome]

pytestmark = needs_git

PLAIN, FOLDER = b"100644", b"40000"


def store(kind: str, content: bytes) -> bytes:
    """Store a git object without checks, and return its hash in hexadecimal."""
    command = ["git", "hash-object", "-t", kind, "-w", "--stdin", "--literally"]
    return subprocess.run(command, input=content, check=True, capture_output=True).stdout.strip()


def tree(*entries: tuple[bytes, bytes, bytes]) -> bytes:
    """Store a tree with these entries: mode, name, and hash of the object. Return its hash."""
    lines = (mode + b" " + name + b"\0" + bytes.fromhex(object_name.decode()) for mode, name, object_name in entries)
    return store("tree", b"".join(lines))


def revision(name: str, top: bytes) -> str:
    """Make a branch whose commit has this tree, and return its name."""
    people_and_message = b"author t <t@t> 0 +0000\ncommitter t <t@t> 0 +0000\n\nx\n"
    git("update-ref", f"refs/heads/{name}", store("commit", b"tree " + top + b"\n" + people_and_message).decode())
    return name


@pytest.fixture
def inside(repository: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Make temporary folders in a folder with a file of the user, and return that folder."""
    place = tmp_path / "temporary"
    (place / "deep").mkdir(parents=True)
    (place / "mine.tltl").write_text("my work")
    monkeypatch.setattr("tempfile.tempdir", str(place / "deep"))
    return place


def files(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize("levels", [1, 2, 5])
@pytest.mark.parametrize("command", ["breaking", "diff"])
def test_an_entry_above_the_folder_is_rejected(inside: Path, tltlc: Run, levels: int, command: str) -> None:  # noqa: F811
    top = tree((PLAIN, b"mine.tltl", store("blob", b"overwritten")))
    for _ in range(levels):
        top = tree((FOLDER, b"..", top))
    name = revision("bad", top)
    before = files(inside)
    if command == "breaking":
        outcome = tltlc("breaking", "specs/leave.tltl", "--against", name)
    else:
        outcome = tltlc("diff", f"{name}:specs/leave.tltl", "specs/leave.tltl")
    assert (outcome.status, outcome.out) == (3, "")
    path = "../" * levels + "mine.tltl"
    assert outcome.err == (
        f"error[TLT0009]: the revision `bad` contains the path `{path}`, which leads out of its folder\n"
        "  help: use another revision: `git fsck` names the damaged tree (`git add` never makes such a tree)\n"
    )
    assert files(inside) == before


def test_an_absolute_entry_is_rejected(inside: Path, tltlc: Run) -> None:  # noqa: F811
    target = inside / "mine.tltl"
    name = revision("bad", tree((PLAIN, str(target).encode(), store("blob", b"overwritten"))))
    outcome = tltlc("breaking", "specs/leave.tltl", "--against", name)
    assert (outcome.status, target.read_text()) == (3, "my work")
    assert "error[TLT0009]" in outcome.err


def test_an_entry_that_is_a_file_and_a_folder_is_rejected(inside: Path, tltlc: Run) -> None:  # noqa: F811
    blob = store("blob", b"")
    below = tree((PLAIN, b"b.tltl", blob))
    name = revision("bad", tree((PLAIN, b"a.tltl", blob), (FOLDER, b"a.tltl", below)))
    outcome = tltlc("breaking", "specs/leave.tltl", "--against", name)
    assert outcome.status == 3
    assert "contains `a.tltl` and `a.tltl/b.tltl`, which cannot both exist" in outcome.err


def test_the_help_for_names_that_differ_in_case_suggests_linux(
    inside: Path,
    tltlc: Run,  # noqa: F811
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The revision is sound, but the file system ignores case, as on macOS and Windows."""
    blob = store("blob", b"")
    name = revision("capitals", tree((PLAIN, b"Leave.tltl", blob), (PLAIN, b"leave.tltl", blob)))
    monkeypatch.setattr("tltlc.io.archive.entry_path", lambda folder, path, archive: folder / path.lower())
    outcome = tltlc("breaking", "specs/leave.tltl", "--against", name)
    assert outcome.status == 3
    assert outcome.err == (
        "error[TLT0009]: the revision `capitals` contains `Leave.tltl` and `leave.tltl`, which cannot both exist "
        "in this file system\n"
        "  help: run this on Linux, or name a revision in which the file has another name\n"
    )


def test_a_tree_of_billions_of_paths_is_rejected(
    inside: Path,
    tltlc: Run,  # noqa: F811
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    top = tree((PLAIN, b"x", store("blob", b"")))
    for _ in range(10):
        top = tree(*((FOLDER, b"%02d" % number, top) for number in range(10)))
    monkeypatch.setattr(revisions, "REVISION_PATHS", Limit(size=1 << 20, values=1000))
    outcome = tltlc("breaking", "specs/leave.tltl", "--against", revision("bomb", top))
    assert (outcome.status, outcome.out) == (3, "")
    assert outcome.err == (
        "error[TLT0764]: the revision `bomb` contains more than 1,000 paths\n"
        "  help: check out the part to compare, and name its folder: `--against DIR`\n"
    )


def test_a_tree_of_too_many_specs_is_rejected(inside: Path, tltlc: Run) -> None:  # noqa: F811
    blob = store("blob", b"spec a = true\n")
    folder = tree(*((PLAIN, b"%03d.tltl" % number, blob) for number in range(200)))
    name = revision("bomb", tree(*((FOLDER, b"%03d" % number, folder) for number in range(101))))
    outcome = tltlc("breaking", "specs/leave.tltl", "--against", name)
    assert outcome.status == 3
    assert "the revision `bomb` contains more than 20,000 specs and artefacts" in outcome.err


def test_specs_that_are_too_large_together_are_rejected(inside: Path, tltlc: Run) -> None:  # noqa: F811
    blob = store("blob", bytes(10 << 20))
    name = revision("bomb", tree(*((PLAIN, b"%03d.tltl" % number, blob) for number in range(30))))
    outcome = tltlc("breaking", "specs/leave.tltl", "--against", name)
    assert outcome.status == 3
    assert "the revision `bomb` contains more than 256 MiB of specs and artefacts" in outcome.err


def nested(name: bytes, levels: int, top: bytes) -> bytes:
    """Return the tree ``top`` nested in ``levels`` folders of the same name."""
    for _ in range(levels):
        top = tree((FOLDER, name, top))
    return top


def doubled(levels: int, names: tuple[bytes, bytes], top: bytes) -> bytes:
    """Return a tree with two to the power of ``levels`` times the paths of ``top``."""
    for _ in range(levels):
        top = tree(*((FOLDER, name, top) for name in names))
    return top


@pytest.mark.parametrize("kind", ["empty", "long"])
def test_endless_folders_are_rejected(inside: Path, tltlc: Run, monkeypatch: pytest.MonkeyPatch, kind: str) -> None:  # noqa: F811
    """Folders without files, and a few very long paths: counting files would catch neither."""
    monkeypatch.setattr(revisions, "REVISION_PATHS", Limit(size=1 << 20, values=1000))
    if kind == "empty":
        top = doubled(60, (b"a", b"b"), tree())
    else:
        top = doubled(60, (b"a" * 4000, b"b" * 4000), tree((PLAIN, b"x", store("blob", b""))))
    outcome = tltlc("breaking", "specs/leave.tltl", "--against", revision("bomb", top))
    assert (outcome.status, outcome.out) == (3, "")
    reason = "paths of more than 1 MiB" if kind == "long" else "more than 1,000 paths"
    assert f"error[TLT0764]: the revision `bomb` contains {reason}" in outcome.err


def test_reading_stops_early_in_a_path_of_many_megabytes(monkeypatch: pytest.MonkeyPatch) -> None:
    stream = io.BytesIO(b"100644 blob 0\t" + bytes([97]) * (50 << 20))
    with pytest.raises(TltlError, match="TLT0764: the revision `bomb` contains a path of more than 1 MiB"):
        list(revisions._parse_listing(stream, "bomb"))
    assert stream.tell() < 2 << 20


def test_a_path_across_two_blocks_of_the_stream_is_read_whole() -> None:
    names = [b"a" * length + b".tltl" for length in (1, 65_000, 65_516, 65_517, 65_518, 200_000, 3)]
    listing = b"".join(b"100644 blob %d\t%s\0" % (place, name) for place, name in enumerate(names))
    files = list(revisions._parse_listing(io.BytesIO(listing), "v1"))
    assert [(file.name, file.path.encode()) for file in files] == [(str(i), name) for i, name in enumerate(names)]


@pytest.mark.parametrize(
    ("name", "levels", "why"),
    [
        (b"d", 1000, "which has more than 100 parts"),
        (b"d" * 200, 60, "which is longer than 4,096 bytes"),
        (b"d" * 400, 1, "with a part that is longer than 255 bytes"),
    ],
    ids=["deep", "long", "long part"],
)
def test_a_path_that_no_folder_can_hold_is_rejected(
    inside: Path,
    tltlc: Run,  # noqa: F811
    name: bytes,
    levels: int,
    why: str,
) -> None:
    top = nested(name, levels, tree((PLAIN, b"leave.tltl", store("blob", b"spec a = true\n"))))
    outcome = tltlc("breaking", "specs/leave.tltl", "--against", revision("bad", top))
    assert (outcome.status, outcome.out) == (3, "")
    assert "error[TLT0009]: the revision `bad` contains the path `dd" in outcome.err or "`d/d" in outcome.err
    assert why in outcome.err
    # The message shortens the name.
    assert len(outcome.err) < 700
    assert "…" in outcome.err
