"""``tltlc diff REV:FILE``: a file in a git revision, with the imports of that revision."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.tools.diff.repository import LIBRARY, SPEC, _repository, commit, git, needs_git, write  # noqa: F401

Run = Callable[..., Outcome]

pytestmark = needs_git


def relation(outcome: Outcome) -> str:
    (spec,) = json.loads(outcome.out)["specs"]
    return str(spec["relation"])


def test_a_file_is_compared_with_its_revision(repository: Path, tltlc: Run) -> None:  # noqa: F811
    assert tltlc("diff", "v1:specs/leave.tltl", "specs/leave.tltl").status == 0
    write(specs__leave=SPEC.replace("keep alive", "keep alive\n    avoid door and not alive"))
    write(libs__mine=LIBRARY.replace("= health", "= health - 10 %"))
    outcome = tltlc("diff", "v1:specs/leave.tltl", "specs/leave.tltl", "--format", "json")
    # The old file imports the old library.
    assert (outcome.status, relation(outcome), json.loads(outcome.out)["a"]) == (1, "stricter", "v1:specs/leave.tltl")
    assert relation(tltlc("diff", "specs/leave.tltl", "HEAD:specs/leave.tltl:leave", "--format", "json")) == "looser"


def test_two_revisions_are_compared(repository: Path, tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    write(specs__exit=SPEC.replace("    keep alive\n", ""), specs__leave="spec other = F true\n")
    commit("v2")
    assert tltlc("compile", "specs/exit.tltl", "-t", "json", "-o", "specs").status == 0
    commit("v3")
    Path("specs/exit.tltl").unlink()
    Path("specs/leave.fspa.json").unlink()
    monkeypatch.chdir(repository / "specs")
    for new in ("v2:exit.tltl", "v3:leave.fspa.json"):
        assert relation(tltlc("diff", "v1:leave.tltl", new, "--format", "json")) == "looser"


def test_missing_files_and_revisions_are_reported(repository: Path, tltlc: Run) -> None:  # noqa: F811
    gone = tltlc("diff", "v1:leave.tltl", "specs/leave.tltl")
    assert (gone.status, gone.out) == (3, "")
    assert gone.err == (
        "error[TLT0751]: there is no file `leave.tltl` in `v1`\n"
        "  help: name a file of that revision, by its path from the current folder\n"
    )
    assert "there is no revision and no folder `v9`" in tltlc("diff", "v9:specs/leave.tltl", "-").err
    # A file in the working tree with exactly this name takes precedence.
    write(**{"v1:leave": "spec other = true\n"})
    assert tltlc("diff", "v1:leave.tltl", "v1:leave.tltl:other").status == 0
    write(specs__leave=SPEC.replace("door", "dor", 1))
    commit("v2")
    broken = tltlc("diff", "v2:specs/leave.tltl", "v1:specs/leave.tltl")
    assert (broken.status, broken.out) == (1, "")
    assert "\n  v2:specs/leave.tltl:4:11\n" in broken.err


def test_a_branch_named_like_a_file_is_a_revision(repository: Path, tltlc: Run) -> None:  # noqa: F811
    git("branch", "same")
    Path("same").write_text("a file")
    assert tltlc("diff", "same:specs/leave.tltl", "specs/leave.tltl").status == 0
    assert tltlc("breaking", "specs", "--against", "same").status == 0
    Path("other").write_text("a file")
    outcome = tltlc("breaking", "specs", "--against", "other")
    assert "error[TLT0751]: `other` is a file, not a folder or a revision\n" in outcome.err


@pytest.mark.parametrize(
    ("name", "title", "help_text"),
    [
        ("^HEAD", "there is no revision and no folder `^HEAD`", "`git log` and `git tag` list revisions"),
        ("blob", "`blob` exists in git, but is not a commit", "name the commit that contains it"),
        ("folder", "`folder` exists in git, but is not a commit", "name the commit that contains it"),
    ],
)
def test_an_object_that_is_no_commit_is_reported(
    repository: Path,
    tltlc: Run,  # noqa: F811
    name: str,
    title: str,
    help_text: str,
) -> None:
    git("tag", "blob", "HEAD:specs/leave.tltl")
    git("tag", "folder", "HEAD^{tree}")
    outcome = tltlc("breaking", "specs", "--against", name)
    assert (outcome.status, outcome.err) == (3, f"error[TLT0751]: {title}\n  help: {help_text}\n")


@pytest.mark.parametrize("lost", [True, False])
def test_a_lost_or_damaged_file_is_reported(repository: Path, tltlc: Run, lost: bool) -> None:  # noqa: F811
    command = ["git", "rev-parse", "HEAD:specs/leave.tltl"]
    name = subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()
    place = Path(".git/objects", name[:2], name[2:])
    place.unlink()
    if not lost:
        place.write_bytes(b"")
    outcome = tltlc("diff", "HEAD:specs/leave.tltl", "specs/leave.tltl")
    title = "git cannot provide `specs/leave.tltl` of the revision `HEAD`"
    assert (outcome.status, f"error[TLT0751]: {title}\n  help: fetch it, or take it" in outcome.err) == (3, True)


def test_a_file_outside_the_repository_is_reported(repository: Path, tltlc: Run) -> None:  # noqa: F811
    outcome = tltlc("diff", "HEAD:../../x.tltl", "specs/leave.tltl")
    outside = repository.absolute().parents[1]
    assert f"because `{outside}` is not in a git repository\n" in outcome.err


def test_a_damaged_repository_is_reported(repository: Path, tltlc: Run) -> None:  # noqa: F811
    Path(".git/HEAD").unlink()
    outcome = tltlc("diff", "v1:specs/leave.tltl", "specs/leave.tltl")
    assert f"error[TLT0751]: git cannot use the repository of `{repository.absolute()}`\n" in outcome.err


def test_the_git_folder_itself_is_reported(repository: Path, tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.chdir(repository / ".git")
    outcome = tltlc("breaking", ".", "--against", "HEAD")
    assert "belongs to git itself, and contains no checked-out files" in outcome.err


def test_a_repository_whose_name_ends_in_a_line_break_works(
    repository: Path,
    tltlc: Run,  # noqa: F811
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    odd = repository.with_name("odd\n")
    repository.rename(odd)
    monkeypatch.chdir(odd)
    assert tltlc("diff", "v1:specs/leave.tltl", "specs/leave.tltl").status == 0


def test_links_are_followed_within_the_revision(repository: Path, tltlc: Run) -> None:  # noqa: F811
    Path("specs/link.tltl").symlink_to("leave.tltl")
    Path("specs/chain.tltl").symlink_to("link.tltl")
    Path("shortcut").symlink_to("specs")
    # Git prints no file for these links. The output for the next link must not be taken for theirs.
    Path("specs/dangling.tltl").symlink_to("nowhere.tltl")
    Path("specs/loop.tltl").symlink_to("loop.tltl")
    Path("specs/outside.tltl").symlink_to("/nowhere\nblob 0123456789")
    write(
        specs__user='import "./chain.tltl"\nspec user = F true\n', specs__stricter=SPEC.replace("    keep alive\n", "")
    )
    commit("v2")
    Path("specs/link.tltl").unlink()
    Path("specs/link.tltl").symlink_to("stricter.tltl")
    for old in ("link", "chain"):
        for folder in ("specs", "shortcut"):
            outcome = tltlc("diff", f"v2:{folder}/{old}.tltl", f"specs/{old}.tltl", "--format", "json")
            assert relation(outcome) == "looser"
    assert relation(tltlc("diff", "v2:specs/user.tltl", "specs/user.tltl", "--format", "json")) == "equivalent"
    for other in ("dangling", "loop", "outside"):
        assert "TLT0751" in tltlc("diff", f"v2:specs/{other}.tltl", "specs/leave.tltl").err


def test_a_link_from_outside_leads_to_the_file_in_the_repository(
    repository: Path,
    tltlc: Run,  # noqa: F811
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    link = tmp_path_factory.mktemp("outside") / "leave.tltl"
    link.symlink_to(Path("specs/leave.tltl").absolute())
    assert tltlc("diff", f"v1:{link}", "specs/leave.tltl").status == 0
