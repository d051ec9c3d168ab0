"""Files that are looked for: what the system does not tell is not there."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import NoReturn

import pytest

from tltlc.files import exists, is_file


def test_what_is_there(tmp_path: Path) -> None:
    (tmp_path / "a").touch()
    assert [(exists(tmp_path / each), is_file(tmp_path / each)) for each in ("a", "", "b", "a/b")] == [
        (True, True),
        (True, False),
        (False, False),
        (False, False),
    ]


@pytest.mark.parametrize("look", [exists, is_file])
@pytest.mark.parametrize("name", ["a" * 300, "a\0", "\ud800"])
def test_a_name_that_the_system_does_not_allow_is_nowhere(look: Callable[[str], bool], name: str) -> None:
    assert not look(name)


@pytest.mark.parametrize("look", [exists, is_file])
def test_what_one_may_not_look_at_is_nowhere(
    look: Callable[[Path], bool], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refused(*_: object, **__: object) -> NoReturn:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(os, "stat", refused)
    assert not look(tmp_path)
