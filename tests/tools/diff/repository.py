"""A repository with a spec and a library, for tests that compare revisions."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import Outcome

Run = Callable[..., Outcome]

needs_git = pytest.mark.skipif(shutil.which("git") is None, reason="needs git")

LIBRARY = "signal health: ratio\npredicate alive in [-1, 1] = health\n"
SPEC = "import mine\nsignal door: bool\nspec leave {\n    reach door\n    keep alive\n}\n"
PROJECT = 'libraries = ["libs"]\n'


def git(*arguments: str) -> None:
    names = {f"GIT_{role}_{field}": "t@t" for role in ("AUTHOR", "COMMITTER") for field in ("NAME", "EMAIL")}
    environment = {**os.environ, **names, "GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_NOSYSTEM": "1"}
    subprocess.run(["git", *arguments], check=True, capture_output=True, env=environment)


def write(**files: str) -> None:
    for path, text in files.items():
        file = Path(path.replace("__", "/") + (".toml" if path == "tltl" else ".tltl"))
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")


def commit(tag: str) -> None:
    git("add", "-A")
    git("commit", "-qm", tag)
    git("tag", tag)


@pytest.fixture(name="repository")
def _repository(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Make the current folder a repository. Its revision `v1` has a spec and a library that it
    imports."""
    monkeypatch.chdir(tmp_path)
    git("init", "-q", ".")
    write(specs__leave=SPEC, libs__mine=LIBRARY, tltl=PROJECT)
    commit("v1")
    return tmp_path


def codes(outcome: Outcome) -> list[str]:
    return [f"{diagnostic['severity']} {diagnostic['code']}" for diagnostic in json.loads(outcome.out)["diagnostics"]]
