"""A game whose suite was run once, for tests of ``tltlc regress``."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import Outcome
from tests.runtime.regression.recorded_game import recorded_game
from tltlc.interfaces.cli.main import main

Run = Callable[..., Outcome]
NAMES = ["room:v0", "room:v1", "hopeless"]
ONE = ("--workers", "1")
REPORTS = {"--json": "report.json", "--junit": "report.xml", "--html": "report.html"}


@pytest.fixture(name="recorded", scope="module")
def _recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A game with its baseline and the results of a first run of its suite; the reports are in another folder."""
    folder = tmp_path_factory.mktemp("recorded") / "game"
    shutil.copytree(recorded_game(tmp_path_factory), folder)
    (folder / "regression").mkdir()
    (folder / "run").rename(folder / "regression" / "game")
    (folder.parent / "reports").mkdir()
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        reports = [word for option, name in REPORTS.items() for word in (option, f"../reports/{name}")]
        with pytest.raises(SystemExit) as ended:
            main(["regress", "game.toml", *reports, *ONE])
        assert ended.value.code == 1
    return folder


def verdicts(out: str) -> list[str]:
    """The names and verdicts of the cases, without the sentence above them and the counts below them."""
    return [" ".join(line.split()[:2]) for line in out.splitlines() if line[0] != " "][1:-1]
