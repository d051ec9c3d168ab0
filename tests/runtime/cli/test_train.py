"""``tltlc train``: very short trainings from start to end."""

from __future__ import annotations

import json
import os
import pty
import re
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from tests.docs.blocks import DOCS
from tests.interfaces.cli.conftest import EXAMPLE, Outcome, tltlc  # noqa: F401
from tests.runtime.cli.signals import interrupted  # noqa: F401
from tests.runtime.cli.small_training import (  # noqa: F401
    SMALL,
    SOON,
    TltlcFunction,
    _here,
    _run,
    _second,
    _trainings,
    train_arguments,
)
from tests.runtime.training.test_settings import GOLDEN
from tltl_runtime.policies.file import read_policy
from tltl_runtime.training.exploration.search import SearchProgress
from tltl_runtime.training.files.metrics import METRICS, read_metrics
from tltl_runtime.training.files.settings import default_text, read_settings
from tltlc.core.record import replace
from tltlc.interfaces.cli.main import main

END = "\0"
"""What a test writes after the output of a command; a terminal may stay open in a process that the command started."""


def test_a_training_ends_at_its_limit_and_resumes(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    result = tltlc("train", EXAMPLE, "--config", "small.toml", "--seed", "3")
    folder = Path("training/cover_and_hide-v0-cover_and_hide-3")
    assert result.status == 1, result.err
    first, files, evaluation, resumed = result.out.splitlines()
    assert re.fullmatch(r"ended by the limit of steps after 128 steps, \d+ s: no episode has ended", first)
    assert files == f"{folder}: policy.safetensors, record.json, curve.png"
    assert evaluation == f"to evaluate it: tltlc evaluate {folder}"
    assert resumed == f"to go on with a higher limit: tltlc train --resume {folder} --steps N"
    assert result.err.splitlines()[-1].startswith("iteration 2: 128 steps in ")

    assert [line["steps"] for line in read_metrics(folder / METRICS)] == [64, 128]
    assert (folder / "curve.png").read_bytes().startswith(b"\x89PNG")
    record = json.loads((folder / "record.json").read_text())
    assert (record["end"], record["steps"], record["iterations"], record["seed"]) == ("steps", 128, 2, 3)
    assert [point["steps"] for point in record["curve"]] == [64, 128]
    card = read_policy(folder / "policy.safetensors").card
    assert card.training == record
    assert (card.level, card.variant, card.level_hash) == ("cover_and_hide", "v0", record["level_hash"])

    resumed = tltlc("train", "--resume", str(folder), "--steps", "192")
    assert resumed.status == 1, resumed.err
    assert [line["steps"] for line in read_metrics(folder / METRICS)] == [64, 128, 192]
    assert json.loads((folder / "record.json").read_text())["iterations"] == 3


@pytest.mark.usefixtures("run")
def test_a_limit_that_has_already_passed_is_rejected(tltlc: TltlcFunction) -> None:  # noqa: F811
    # The same files as if it had been interrupted.
    Path("run/record.json").unlink()
    before = Path("run/run.json").read_bytes()
    for limit in ("--steps", "127"), ("--minutes", "0.0001"):
        result = tltlc("train", "--resume", "run", *limit)
        assert (result.status, result.out) == (1, "")
        message = re.sub(r"\d+ s,", "S s,", result.err)
        assert message == (GOLDEN / f"TLT0862_{limit[0][2:]}.txt").read_text(encoding="utf-8")
    assert Path("run/run.json").read_bytes() == before
    resumed = tltlc("train", "--resume", "run", "--steps", "129", "--minutes", "60")
    assert "ended by the limit of steps after 192 steps" in resumed.out, resumed.err
    timed_out = tltlc("train", "--resume", "run", "--steps", "999", "--minutes", "0.001")
    assert "its limit is 0.001 minutes; to go on" in timed_out.out


@pytest.mark.usefixtures("run")
def test_without_a_checkpoint_a_training_starts_again(tltlc: TltlcFunction) -> None:  # noqa: F811
    Path("run/checkpoint.pt").unlink()
    result = tltlc("train", "--resume", "run", "--steps", "192")
    assert result.err.splitlines()[:3] == [
        "training cover_and_hide on cover_and_hide:v0, seed 0, in run",
        "it ends when the spec is met, at the latest after 192 steps",
        "there is no checkpoint.pt in run: the training starts again, its measurements are lost, "
        "and so is its record, and policy.safetensors stays until there is a new one",
    ]
    assert [line["steps"] for line in read_metrics(Path("run") / METRICS)] == [64, 128, 192]


@pytest.mark.usefixtures("here")
def test_differing_sensors_are_named(tltlc: TltlcFunction, interrupted: TltlcFunction) -> None:  # noqa: F811
    options_at_start = ("--no-map", "--entities", "s1,exit", "--variables", "health")
    interrupted(EXAMPLE, "--config", "small.toml", "--out", "second", *options_at_start)
    options = ("--map", "cell=1,types=wall,low", "--entities", "s1", "--variables", "distance(exit)")
    rejected = tltlc("train", "--resume", "second", *options)
    assert re.findall(
        r"^error\[TLT0870\]: the training in `second` has the sensors of (.*)$", rejected.err, re.MULTILINE
    ) == [
        "`--entities s1,exit`, not those of `--entities s1`",
        "`--variables health`, not those of `--variables 'distance(exit)'`",
        "`--no-map`, not those of `--map cell=1.0,extent=15,types=wall,low`",
    ]
    # Options that are left out agree with the training.
    assert tltlc("train", "--resume", "second", "--no-map", "--steps", "64").status == 1


@pytest.mark.usefixtures("run")
def test_a_finished_training_is_not_changed(tltlc: TltlcFunction) -> None:  # noqa: F811
    times = {path: path.stat().st_mtime_ns for path in Path("run").iterdir() if path.name != ".lock"}
    result = tltlc("train", "--resume", "run", "--steps", "100")
    assert result == Outcome(
        1,
        "the training in `run` is finished, and stays as it is: it took 128 steps, and its limit is 100; to go on with "
        "a higher limit: tltlc train --resume run --steps N\n",
        "",
    )
    assert {path: path.stat().st_mtime_ns for path in times} == times


def test_a_level_whose_file_was_moved_can_be_named(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    assert tltlc("new", "mine", "--level", "vault").status == 0
    arguments = ("mine/vault.tltl", "--config", "small.toml", "--steps", "64", "--out", "run")
    assert tltlc("train", *arguments).status == 1
    (here / "mine").rename(here / "yours")
    missing = tltlc("train", "--resume", "run", "--steps", "128")
    assert missing.status == 3
    assert f"the file of the level, `{here / 'mine' / 'vault.toml'}`, no longer exists" in missing.err
    assert "`tltlc train --resume run --level FILE.toml`" in missing.err
    assert "`tltlc evaluate run --level FILE.toml`" in tltlc("evaluate", "run").err
    level = ("--level", "yours/vault.toml")
    assert tltlc("evaluate", "run", *level, "--episodes", "1").status == 0
    result = tltlc("train", "--resume", "run", "--steps", "128", *level)
    assert result.status == 1, result.err
    assert "ended by the limit of steps after 128 steps" in result.out
    rejected = tltlc("train", "--resume", "run", "--steps", "256", "--level", "cover_and_hide")
    assert "TLT0870" in rejected.err and "not on `cover_and_hide:v0`" in rejected.err


@pytest.mark.usefixtures("second")
def test_another_spec_with_the_same_name_is_rejected(tltlc: TltlcFunction) -> None:  # noqa: F811
    Path("soon.tltl").write_text(SOON.replace("8 steps", "9 steps"))
    result = tltlc("train", "soon.tltl", "--resume", "second")
    assert result.err.startswith(
        "error[TLT0870]: the training in `second` is for another spec `soon` than the one in `soon.tltl`: "
        "its limit is 9 steps, and was 8 steps\n"
    )


def test_a_training_ends_when_the_spec_is_met(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    result = tltlc("train", "soon.tltl", "--config", "small.toml", "--out", "runs/soon", "--no-map")
    assert result.status == 0, result.err
    assert result.err.splitlines()[:4] == [
        "training soon on cover_and_hide:v0, seed 0, in runs/soon",
        "it ends when the spec is met, at the latest after 128 steps",
        "starting 4 environments in 1 process",
        "Ctrl-C stops it and keeps what was learned; to go on: tltlc train --resume runs/soon",
    ]
    assert result.err.count("\n") == 5
    first, _, last = result.out.splitlines()
    assert re.fullmatch(r"the spec is met after 64 steps, \d+ s: met in 2 of the last 2 episodes, .*", first)
    assert last == "to evaluate it: tltlc evaluate runs/soon"
    card = read_policy("runs/soon/policy.safetensors").card
    best = card.training["best"]
    assert (best["pass_rate"], best["confirmed"]) == (1.0, True)
    assert (card.fspa.name, card.sensors.map, card.network.hidden) == ("soon", None, (8,))


def test_a_search_is_announced(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    Path("search.toml").write_text(SMALL.replace("ways = 0", "ways = 2\nsteps = 640"))
    result = tltlc("train", "soon.tltl", "--config", "search.toml", "--out", "second")
    assert result.status in (0, 1), result.err
    _, _, _, searched, lost, *lines = result.err.splitlines()
    assert searched == (
        "searching first for ways to meet the spec, with random actions. "
        "The search ends when 2 ways are found, at the latest after 640 steps."
    )
    assert lost == "Ctrl-C stops it and keeps the ways found; when you continue, it looks for the others."
    assert "Ctrl-C stops it and keeps what was learned; to go on: tltlc train --resume second" in lines


def test_a_training_that_has_only_begun_is_explained(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    options = ("soon.tltl", "--config", "small.toml", "--out", "begun", "--no-map")
    assert tltlc("train", *options).status == 0
    for path in Path("begun").iterdir():
        if path.is_file() and path.name != "run.json":
            path.unlink()
    again = tltlc("train", *options)
    assert (again.status, again.err.splitlines()[-2:]) == (
        1,
        [
            "error[TLT0867]: `begun` already contains a training, which was interrupted before it learned anything",
            "  help: start this training again with `tltlc train --resume begun`; for another one, remove the folder, "
            "or name another folder with --out",
        ],
    )
    resumed = tltlc("train", "--resume", "begun")
    assert resumed.status == 0, resumed.err
    note = "it was interrupted before it learned anything: with no checkpoint.pt, it starts from its beginning"
    assert note in resumed.err.splitlines()


@pytest.mark.usefixtures("second")
def test_a_folder_holds_one_training(tltlc: TltlcFunction) -> None:  # noqa: F811
    again = tltlc("train", "soon.tltl", "--config", "small.toml", "--out", "second")
    assert again == Outcome(
        1,
        "",
        "training soon on cover_and_hide:v0, seed 0, in second\n"
        "it ends when the spec is met, at the latest after 128 steps\n"
        "error[TLT0867]: `second` already contains a training\n"
        "  help: continue it with `tltlc train --resume second`, or name another folder with --out\n",
    )
    Path("big.toml").write_text(SMALL.replace("[8]", "[9]").replace("steps = 128", "steps = 999"))
    options = ["--level", "navigation:v1", "--seed", "9", "--no-entities", "--config", "big.toml"]
    rejected = tltlc("train", EXAMPLE, *options, "--resume", "second")
    assert rejected.status == 1
    titles = re.findall(r"^error\[TLT0870\]: the training in `second` (.*)$", rejected.err, re.MULTILINE)
    assert titles == [
        "is on the level `cover_and_hide:v0`, not on `navigation:v1`",
        f"is for the spec `soon`, not for `cover_and_hide` of `{EXAMPLE}`",
        "has the seed 0, not 9",
        "has the sensors of `--entities s1,s2,exit,guard`, not those of `--no-entities`",
        "has another value of `network.hidden` than `big.toml`",
    ]
    assert (
        rejected.err.count(
            "help: leave it out to continue the training in `second`, or start another training with --out"
        )
        == 5
    )
    same = ["--level", "cover_and_hide:v0", "--seed", "0", "--config", "small.toml", "--steps", "999"]
    assert tltlc("train", "soon.tltl", *same, "--resume", "second").status == 0


def test_a_folder_with_other_files_is_rejected(
    tltlc: TltlcFunction,  # noqa: F811
    interrupted: TltlcFunction,  # noqa: F811
    here: Path,
) -> None:
    (here / "mine").mkdir()
    (here / "mine" / ".hidden").touch()
    arguments = ("soon.tltl", "--config", "small.toml", "--out", "mine")
    (here / "mine" / "notes.txt").write_text("of mine")
    assert tltlc("train", *arguments) == Outcome(
        1,
        "",
        "error[TLT0873]: `mine` is not a training, and contains other files: `notes.txt`\n"
        "  help: name a folder of its own, e.g. `--out mine/training`\n",
    )
    assert {path.name for path in (here / "mine").iterdir()} == {".hidden", "notes.txt"}
    (here / "mine" / "notes.txt").unlink()
    interrupted(*arguments)
    assert (here / "mine" / "run.json").is_file()


@pytest.mark.parametrize(
    ("arguments", "status", "message"),
    [
        ([], 2, "say what to train for: a spec, a level, or both"),
        (["hide.tltl"], 2, "`hide` does not name a level: name one with --level"),
        (["hide.tltl", "--level", "nowhere"], 2, "there is no level `nowhere`"),
        (["hide.tltl", "--level", "navigation"], 1, "`navigation` has no "),
        (["endless.tltl"], 1, "`endless` has no limit, so an episode may go on for ever"),
        (["soon.tltl", "--steps", "0"], 2, "`0` is not a whole number from 1 to 1,000,000,000,000,000"),
        (["--print-config", "--steps", str(10**16)], 2, "is not a whole number from 1 to 1,000,000,000,000,000"),
        (["soon.tltl", "--minutes", "nan"], 2, "`nan` is not a number from 0 to 1,000,000"),
        (["--print-config", "--minutes", "1e7"], 2, "`10000000.0` is not a number from 0 to 1,000,000"),
        (["soon.tltl", "--minutes", "-1"], 2, "`-1.0` is not a number from 0 to 1,000,000"),
        (["soon.tltl", "--workers", "many"], 2, "`many` is neither `ray` nor a whole number from 0 to 10,000"),
        (["--print-config", "--workers", "10001"], 2, "`10001` is neither `ray` nor a whole number from 0 to 10,000"),
        (["soon.tltl", "--workers", "9" * 5000], 2, "is neither `ray` nor a whole number from 0 to 10,000"),
        (["soon.tltl", "--device", "gpu"], 2, '`gpu` is not a device: "cpu", "cuda" or "cuda:0"'),
        (["soon.tltl", "--device", "cuda:31"], 1, "there is no device `cuda:31` here"),
        (["soon.tltl", "--entities", "s9"], 2, "the level `cover_and_hide` has no entity `s9`"),
        (
            ["soon.tltl", "--config", "large.toml"],
            1,
            "`network` gives a policy of 70 MiB, but the file of a policy has at most 64",
        ),
        (["soon.tltl", "--config", "gone.toml"], 3, "cannot read `gone.toml`"),
        (
            ["small.toml"],
            2,
            "`small.toml` is not a spec: if it contains settings, write `--config small.toml`; if it is a",
        ),
        (["--resume", "gone"], 1, "there is no training in `gone`"),
        (["vault.tltl"], 2, "there is no level `vault`: `vault.toml` does not exist, and no level of that name comes"),
        (["--resume", "gone", "--out", "there"], 2, "--resume continues in the folder of the training"),
        (["soon.tltl", "--out", "small.toml/run"], 3, "cannot write into `small.toml/run`"),
        (["soon.tltl", "--out", "small.toml/run"], 3, "for a new training, you can name another folder with --out"),
    ],
)
def test_invalid_options_are_rejected(
    tltlc: TltlcFunction,  # noqa: F811
    here: Path,
    arguments: list[str],
    status: int,
    message: str,
) -> None:
    (here / "large.toml").write_text("[network]\nhidden = [8192, 4096]\n")
    (here / "hide.tltl").write_text("signal mood: bool\nspec hide { limit 9 steps\n keep mood }\n")
    (here / "vault.tltl").write_text(SOON.replace("cover_and_hide", "vault"))
    (here / "endless.tltl").write_text("import stealth\nspec endless { level navigation\n reach seen }\n")
    result = tltlc("train", *arguments)
    assert (result.status, result.out) == (status, ""), result.err
    assert message in result.err
    assert not (here / "training").exists()


@pytest.mark.usefixtures("here")
def test_a_settings_file_changes_only_the_settings_it_contains(
    tltlc: TltlcFunction,  # noqa: F811
    interrupted: TltlcFunction,  # noqa: F811
) -> None:
    options = ("--config", "small.toml", "--out", "second", "--steps", "64", "--workers", "2", "--minutes", "60")
    interrupted(EXAMPLE, *options)
    settings = json.loads(Path("second/run.json").read_text())["settings"]
    Path("more.toml").write_text("checkpoint_s = 5\n[stop]\nsteps = 128\n")
    resumed = tltlc("train", "--resume", "second", "--config", "more.toml")
    assert resumed.status == 1, resumed.err
    settings["checkpoint_s"], settings["stop"]["steps"] = 5.0, 128
    assert json.loads(Path("second/run.json").read_text())["settings"] == settings


@pytest.mark.usefixtures("here")
def test_an_unreachable_goal_is_reported_first(interrupted: TltlcFunction) -> None:  # noqa: F811
    Path("far.tltl").write_text("import spatial\nentity exit\nspec far { limit 5 steps\n reach near(exit) }")
    result = interrupted("far.tltl", "--level", "navigation:v2", "--config", "small.toml")
    first, _, warned = result.err.splitlines()[:3]
    assert first == "training far on navigation:v2, seed 0, in training/navigation-v2-far-0"
    assert warned.startswith("warning[TLT0814]: nobody can reach `exit` in `navigation:v2`")


@pytest.mark.usefixtures("here")
def test_a_level_file_beside_the_spec_is_preferred(tltlc: TltlcFunction, interrupted: TltlcFunction) -> None:  # noqa: F811
    assert tltlc("new", "mine", "--level", "vault").status == 0
    result = interrupted("mine/vault.tltl", "--config", "small.toml")
    assert result.err.startswith("training unseen on mine/vault.toml:v0, seed 0, in training/vault-v0-unseen-0\n")
    run = json.loads(Path("training/vault-v0-unseen-0/run.json").read_text())
    assert run["level"] == str(Path("mine/vault.toml").resolve())


@pytest.mark.usefixtures("here")
def test_a_level_may_be_named_in_place_of_a_spec(interrupted: TltlcFunction) -> None:  # noqa: F811
    result = interrupted("navigation:v1", "--config", "small.toml")
    assert result.err.startswith("training navigation on navigation:v1, ")
    assert Path("training/navigation-v1-navigation-0").is_dir()


def test_the_default_settings_are_printed(tltlc: TltlcFunction) -> None:  # noqa: F811
    assert tltlc("train", "--print-config") == Outcome(0, default_text(), "")


def test_the_effective_settings_are_printed(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    result = tltlc("train", "--print-config", "--config", "small.toml", "--minutes", "0.5", "--device", "cuda")
    assert result.status == 0, result.err
    Path("all.toml").write_text(result.out)
    expected = read_settings(here / "small.toml")
    expected = replace(expected, device="cuda", stop=replace(expected.stop, minutes=0.5))
    assert read_settings(here / "all.toml") == expected
    assert "envs = 4                # environments of each process of torchrun" in result.out.splitlines()
    assert len(result.out.splitlines()) == len(default_text().splitlines())


def test_a_terminal_shows_the_live_display(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in {"TERM": "xterm", "COLUMNS": "110", "LINES": "40"}.items():
        monkeypatch.setenv(name, value)
    ours, theirs = pty.openpty()
    with os.fdopen(theirs, "w", encoding="utf-8") as terminal, ThreadPoolExecutor(1) as reading:
        output = reading.submit(lambda: b"".join(_output(ours)))
        with monkeypatch.context() as patch, pytest.raises(SystemExit) as ended:
            patch.setattr(sys, "stderr", terminal)
            try:
                main(train_arguments("--steps", "128"))
            finally:
                print(END, file=terminal, flush=True)
    os.close(ours)
    shown = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", output.result().decode())
    assert ended.value.code == 1
    assert "playing the first steps" in shown
    last = shown[shown.rindex("cover_and_hide on cover_and_hide:v0, seed 0") :]
    for text in ("spec met", "met in a row", "of 2, then the policy is confirmed", "state 0", "Reach near(s1)"):
        assert text in last
    assert "128 of at most 128 steps" in last


@pytest.mark.usefixtures("second")
def test_the_page_lists_the_keys_of_the_record() -> None:
    page = (DOCS / "training.md").read_text(encoding="utf-8")
    section = page.partition("## The record")[2].partition("\n## ")[0]
    rows = re.findall(r"^\| (`.*?) \|", section, re.MULTILINE)
    documented = [name for row in rows for name in re.findall(r"`(\w+)`", row)]
    assert documented == list(json.loads(Path("second/record.json").read_text()))
    (search,) = re.findall(r"^\| `search` \| (.*) \|$", section, re.MULTILINE)
    # The explanations of some keys follow after the list, and start with their names.
    assert tuple(dict.fromkeys(re.findall(r"`(\w+)`", search))) == SearchProgress.__match_args__


def _output(terminal: int) -> Iterator[bytes]:
    data = b""
    while END.encode() not in data:
        data = os.read(terminal, 65536)
        yield data
