"""The starter project contains what its README describes."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import Outcome

_COMMAND = re.compile(r"^    tltlc (.+?)(?:  +.*)?$", re.MULTILINE)


def test_each_command_of_the_readme_succeeds(
    tltlc: Callable[..., Outcome], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert tltlc("new", "game").status == 0
    monkeypatch.chdir(tmp_path / "game")
    commands = _COMMAND.findall(Path("README.md").read_text())
    assert len(commands) >= 7
    assert {command: tltlc(*command.split()).status for command in commands} == dict.fromkeys(commands, 0)


def test_a_file_is_not_called_a_folder_that_is_not_empty(tltlc: Callable[..., Outcome], tmp_path: Path) -> None:
    (tmp_path / "game").touch()
    outcome = tltlc("new", str(tmp_path / "game"))
    assert (outcome.status, "already exists and is not an empty folder" in outcome.err) == (2, True)


def test_the_help_does_not_suggest_removing_a_folder_with_files(
    tltlc: Callable[..., Outcome], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    outcome = tltlc("new", "..")
    assert (outcome.status, outcome.err.splitlines()[1]) == (2, "  help: choose another name, or an empty folder")
