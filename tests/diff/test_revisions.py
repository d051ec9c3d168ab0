"""``tltlc diff REV:FILE``: a file as it was in a revision of git, with the imports that it had there."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.diff.test_breaking import LIBRARY, SPEC, commit, needs_git, repository, write  # noqa: F401

Run = Callable[..., Outcome]

pytestmark = needs_git


def relation(done: Outcome) -> str:
    (spec,) = json.loads(done.out)["specs"]
    return str(spec["relation"])


def test_a_file_since_a_revision(repository: Path, tltlc: Run) -> None:  # noqa: F811
    assert tltlc("diff", "v1:specs/leave.tltl", "specs/leave.tltl").status == 0
    write(specs__leave=SPEC.replace("keep alive", "keep alive\n    avoid door and not alive"))
    write(libs__mine=LIBRARY.replace("= health", "= health - 10 %"))
    done = tltlc("diff", "v1:specs/leave.tltl", "specs/leave.tltl", "--format", "json")
    # The import is the old one, too.
    assert (done.status, relation(done), json.loads(done.out)["a"]) == (1, "stricter", "v1:specs/leave.tltl")
    assert relation(tltlc("diff", "specs/leave.tltl", "HEAD:specs/leave.tltl:leave", "--format", "json")) == "looser"


def test_between_revisions(repository: Path, tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    write(specs__exit=SPEC.replace("    keep alive\n", ""), specs__leave="spec other = F true\n")
    commit("v2")
    assert tltlc("compile", "specs/exit.tltl", "-t", "json", "-o", "specs").status == 0
    commit("v3")
    Path("specs/exit.tltl").unlink()
    Path("specs/leave.fspa.json").unlink()
    monkeypatch.chdir(repository / "specs")
    for new in ("v2:exit.tltl", "v3:leave.fspa.json"):
        assert relation(tltlc("diff", "v1:leave.tltl", new, "--format", "json")) == "looser"


def test_what_is_not_there(repository: Path, tltlc: Run) -> None:  # noqa: F811
    gone = tltlc("diff", "v1:leave.tltl", "specs/leave.tltl")
    assert (gone.status, gone.out) == (3, "")
    assert gone.err == (
        "error[TLT0751]: there is no file `leave.tltl` in `v1`\n"
        "  help: name a file that was there, by its path from the current folder\n"
    )
    assert "there is no revision and no folder `v9`" in tltlc("diff", "v9:specs/leave.tltl", "-").err
    # A file of now that is called so is meant itself.
    write(**{"v1:leave": "spec other = true\n"})
    assert tltlc("diff", "v1:leave.tltl", "v1:leave.tltl:other").status == 0
    write(specs__leave=SPEC.replace("door", "dor", 1))
    commit("v2")
    broken = tltlc("diff", "v2:specs/leave.tltl", "v1:specs/leave.tltl")
    assert (broken.status, broken.out) == (1, "")
    assert "\n  v2:specs/leave.tltl:4:11\n" in broken.err
