"""``tltlc regress --retrain``: what it says, writes and refuses."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

from tests.cli.conftest import tltlc  # noqa: F401
from tests.runtime.commands.test_regress import ONE, Run
from tests.runtime.evaluation.untrained import untrained
from tests.runtime.regression.game import NEVER, with_baseline, write_game
from tests.runtime.regression.recorded_game import _game  # noqa: F401
from tltl_runtime.policies.file import write_policy

RETRAIN = ("regress", "game.toml", "--retrain", "--minutes", "0.02", *ONE)
FOLDER = "regression/game/retrained/hopeless"


@pytest.fixture(name="recorded", scope="module")
def _recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A game with its baseline, one of whose cases nobody meets."""
    folder = tmp_path_factory.mktemp("recorded") / "game"
    write_game(folder)
    write_policy(folder / "soon.safetensors", untrained(NEVER, str(folder / "room.toml")))
    with_baseline(folder / "game.toml")
    return folder


def test_it_says_whether_there_is_a_way(tltlc: Run, game: Path) -> None:  # noqa: F811
    found = tltlc(*RETRAIN, "--json", "report.json", "--junit", "report.xml")
    assert found.status == 1
    (told,) = (line for line in found.out.splitlines() if "trained anew" in line)
    assert told.startswith("hopeless, trained anew: no way found: neither a search of ")
    reports = "--json report.json --junit report.xml --workers 1"
    again = f"tltlc regress game.toml --out regression/game {reports} --retrain --minutes "
    (longer,) = (line for line in found.out.splitlines() if line.startswith(f"    to train longer: {again}"))
    assert float(longer.removeprefix(f"    to train longer: {again}")) >= 0.04
    assert f"hopeless: a training begins with its policy, for 0.02 minutes at the most, in {FOLDER}" in found.err
    assert "hopeless, trained anew: 25 of at most 50 episodes, 0 met the spec" in found.err
    said = json.loads(Path("report.json").read_text(encoding="utf-8"))
    assert said["complete"] is True and said["verdicts"] == {"pass": 2, "review": 0, "fail": 1}
    *others, hopeless = said["cases"]
    assert [case["retrained"] for case in others] == [None, None]
    assert hopeless["retrained"]["outcome"] == "no_way"
    assert f"hopeless, trained anew: {hopeless['retrained']['text']}" == told
    assert hopeless["retrained"]["policy"] == "retrained/hopeless/policy.safetensors"
    (tests,) = ET.parse("report.xml").getroot()
    assert [each.text for each in tests.iter("system-out")][-1] == hopeless["retrained"]["text"]
    values = {each.get("name"): each.get("value") for each in tests.iter("property")}
    assert (values["hopeless.retrained"], values["hopeless.retrained_pass_rate"]) == ("no_way", "0.0000")
    page = Path("regression/game/report.html").read_text(encoding="utf-8")
    assert page.count("data:image/png;base64,") == 1 and "no way found: neither" in page

    second = tltlc(*RETRAIN, "--json", "again.json")
    assert "a training" not in second.err and "episodes" not in second.err, "all of it is kept"
    assert Path("again.json").read_bytes() == Path("report.json").read_bytes()

    plain = tltlc("regress", "game.toml", "--json", "-", *ONE)
    assert [case["retrained"] for case in json.loads(plain.out)["cases"]] == [None] * 3

    write_policy("soon.safetensors", untrained(NEVER, "room.toml", seed=7))
    assert tltlc("baseline", "game.toml", *ONE).status == 0
    third = tltlc(*RETRAIN)
    assert (
        "begins with its policy, anew, since what is kept is of another level, policy, spec, seed or settings"
        in third.err
    )


def test_where_all_pass_nothing_is_trained(tltlc: Run, game: Path) -> None:  # noqa: F811
    text = Path("game.toml").read_text(encoding="utf-8")
    Path("game.toml").write_text(text.rpartition("[[case]]")[0], encoding="utf-8")
    found = tltlc(*RETRAIN)
    assert (found.status, Path("regression/game/retrained").exists()) == (0, False)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--minutes", "5"), "--minutes are those of --retrain"),
        (("--retrain", "--minutes", "0"), "0 is not in the range"),
    ],
)
def test_what_is_refused(tltlc: Run, game: Path, words: tuple[str, ...], said: str) -> None:  # noqa: F811
    found = tltlc("regress", "game.toml", *words, *ONE)
    assert (found.status, found.out) == (2, "")
    assert said in re.sub(r"\s+", " ", found.err)


def test_asked_to_end_it_keeps_what_there_is(tltlc: Run, game: Path) -> None:  # noqa: F811
    words = [sys.executable, "-m", "tltlc", "regress", "game.toml", "--retrain", "--minutes", "60", *ONE]
    with subprocess.Popen([*words, "--json", "report.json"], stderr=subprocess.PIPE, text=True) as training:
        assert training.stderr is not None
        for line in training.stderr:
            if line.startswith("searching: "):
                break
        training.send_signal(signal.SIGINT)
        _, err = training.communicate(timeout=300)
    assert training.returncode == 130
    assert (
        "stopped: all cases are judged, and 1 is still to be trained for; to go on: "
        "tltlc regress game.toml --out regression/game --json report.json --workers 1 --retrain --minutes 60"
    ) in err.splitlines()
    said = json.loads(Path("report.json").read_text(encoding="utf-8"))
    assert (said["complete"], len(said["cases"]), said["cases"][2]["retrained"]) == (False, 3, None)
    on = tltlc(*RETRAIN)
    assert f"hopeless: a training goes on, for 0.02 minutes at the most, in {FOLDER}" in on.err
    assert "hopeless, trained anew: no way found" in on.out
