"""``tltlc train``: trainings that are much too short, from their beginning to their end."""

from __future__ import annotations

import json
import os
import pty
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from multiprocessing import active_children
from pathlib import Path

import pytest
from tensorboard.backend.event_processing.event_accumulator import EventAccumulator

from tests.docs.blocks import DOCS
from tests.interfaces.cli.conftest import EXAMPLE, Outcome, tltlc  # noqa: F401
from tests.runtime.training.test_settings import GOLDEN
from tests.waiting import HANG_S
from tltl_runtime.policies.file import read_policy
from tltl_runtime.training.exploration.search import Searched
from tltl_runtime.training.run.metrics import METRICS, read_metrics
from tltl_runtime.training.run.settings import default_text, read_settings
from tltl_runtime.training.runner import Iteration, Runner
from tltlc.core.record import replace
from tltlc.interfaces.cli.main import main

TltlcFunction = Callable[..., Outcome]

SMALL = """
[rollout]
envs = 4
steps = 16
workers = 1

[exploration]
ways = 0

[ppo]
epochs = 1
minibatches = 1

[network]
hidden = [8]

[stop]
windows = 1
episodes = 2
confirmation = 2
steps = 128
"""

SOON = "import stealth\nspec soon { level cover_and_hide\n limit 8 steps\n keep alive }\n"
"""A spec that who does anything at all meets, after eight steps."""


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder but for small settings and a spec, made the current one."""
    _write_inputs(tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def _write_inputs(folder: Path) -> None:
    (folder / "small.toml").write_text(SMALL)
    (folder / "soon.tltl").write_text(SOON)


@pytest.fixture(scope="module")
def over(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with two trainings that are over: ``run``, which its limit of steps has ended, and ``it``, whose spec is
    met."""
    folder = tmp_path_factory.mktemp("over")
    _write_inputs(folder)
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        for spec, name, status in ((str(EXAMPLE), "run", 1), ("soon.tltl", "it", 0)):
            with pytest.raises(SystemExit) as ended:
                main(["train", spec, "--config", "small.toml", "--out", name])
            assert ended.value.code == status
    return folder


@pytest.fixture
def run(over: Path, here: Path) -> Path:
    """A copy of the training that its limit has ended, as ``run`` in the current folder."""
    return shutil.copytree(over / "run", here / "run")


@pytest.fixture
def it(over: Path, here: Path) -> Path:
    """A copy of the training whose spec is met, as ``it`` in the current folder."""
    return shutil.copytree(over / "it", here / "it")


def test_to_its_limit_and_on(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    found = tltlc("train", EXAMPLE, "--config", "small.toml", "--seed", "3")
    folder = Path("training/cover_and_hide-v0-cover_and_hide-3")
    assert found.status == 1, found.err
    first, files, evaluate, on = found.out.splitlines()
    assert re.fullmatch(r"ended by the limit of steps after 128 steps, \d+ s: no episode has ended", first)
    assert files == f"{folder}: policy.safetensors, record.json, curve.png"
    assert evaluate == f"to evaluate it: tltlc evaluate {folder}"
    assert on == f"to go on, with a higher limit: tltlc train --resume {folder} --steps N"
    assert found.err.splitlines()[-1].startswith("iteration 2: 128 steps in ")

    assert [line["steps"] for line in read_metrics(folder / METRICS)] == [64, 128]
    assert (folder / "curve.png").read_bytes().startswith(b"\x89PNG")
    record = json.loads((folder / "record.json").read_text())
    assert (record["end"], record["steps"], record["iterations"], record["seed"]) == ("steps", 128, 2, 3)
    assert [point["steps"] for point in record["curve"]] == [64, 128]
    card = read_policy(folder / "policy.safetensors").card
    assert card.training == record
    assert (card.level, card.variant, card.level_hash) == ("cover_and_hide", "v0", record["level_hash"])

    on = tltlc("train", "--resume", str(folder), "--steps", "192")
    assert on.status == 1, on.err
    assert [line["steps"] for line in read_metrics(folder / METRICS)] == [64, 128, 192]
    assert json.loads((folder / "record.json").read_text())["iterations"] == 3


@pytest.mark.usefixtures("run")
def test_a_training_that_is_over_when_it_is_resumed(tltlc: TltlcFunction) -> None:  # noqa: F811
    folder = Path("run")
    before, begun = (folder / "checkpoint.pt").read_bytes(), (folder / "run.json").read_bytes()
    tltlc("train", "--resume", "run", "--steps", "256")
    assert [line["steps"] for line in read_metrics(folder / METRICS)] == [64, 128, 192, 256]
    # As where it was killed after its second iteration, with which it had reached its limit.
    (folder / "checkpoint.pt").write_bytes(before)
    (folder / "run.json").write_bytes(begun)
    (folder / "record.json").unlink()
    found = tltlc("train", "--resume", "run")
    assert found.status == 1
    assert "steps/s" not in found.err
    assert [line["steps"] for line in read_metrics(folder / METRICS)] == [64, 128]
    assert [point["steps"] for point in json.loads((folder / "record.json").read_text())["curve"]] == [64, 128]
    events = EventAccumulator("run")
    events.Reload()
    assert [event.step for event in events.Scalars("time/episodes")] == [64, 128]


@pytest.mark.usefixtures("run")
def test_a_limit_that_is_passed_already(tltlc: TltlcFunction) -> None:  # noqa: F811
    # As where it was broken off.
    Path("run/record.json").unlink()
    kept = Path("run/run.json").read_bytes()
    for limit in ("--steps", "127"), ("--minutes", "0.0001"):
        found = tltlc("train", "--resume", "run", *limit)
        assert (found.status, found.out) == (1, "")
        said = re.sub(r"\d+ s,", "S s,", found.err)
        assert said == (GOLDEN / f"TLT0862_{limit[0][2:]}.txt").read_text(encoding="utf-8")
    assert Path("run/run.json").read_bytes() == kept
    on = tltlc("train", "--resume", "run", "--steps", "129", "--minutes", "60")
    assert "ended by the limit of steps after 192 steps" in on.out, on.err
    over = tltlc("train", "--resume", "run", "--steps", "999", "--minutes", "0.001")
    assert "its limit is 0.001 minutes; to go on" in over.out


@pytest.mark.usefixtures("run")
def test_a_checkpoint_that_is_missing(tltlc: TltlcFunction) -> None:  # noqa: F811
    Path("run/checkpoint.pt").unlink()
    found = tltlc("train", "--resume", "run", "--steps", "192")
    assert found.err.splitlines()[:2] == [
        "training cover_and_hide on cover_and_hide v0, seed 0, in run",
        "there is no checkpoint.pt in run: the training begins anew, what was measured is lost, "
        "and so is its record, and policy.safetensors stays until there is a new one",
    ]
    assert [line["steps"] for line in read_metrics(Path("run") / METRICS)] == [64, 128, 192]


def test_senses_that_differ_are_named(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    begun = ("--no-map", "--entities", "s1,exit", "--variables", "health")
    assert tltlc("train", EXAMPLE, "--config", "small.toml", "--steps", "64", "--out", "it", *begun).status == 1
    others = ("--map", "cell=1,types=wall,low", "--entities", "s1", "--variables", "distance(exit)")
    other = tltlc("train", "--resume", "it", *others)
    assert re.findall(r"^error\[TLT0870\]: the training in `it` senses as (.*)$", other.err, re.MULTILINE) == [
        "`--entities s1,exit` says, not as `--entities s1`",
        "`--variables health` says, not as `--variables 'distance(exit)'`",
        "`--no-map` says, not as `--map cell=1.0,extent=15,types=wall,low`",
    ]
    # What is left out agrees.
    assert tltlc("train", "--resume", "it", "--no-map", "--steps", "128").status == 1


@pytest.mark.usefixtures("run")
def test_a_training_that_has_ended_stays_as_it_is(tltlc: TltlcFunction) -> None:  # noqa: F811
    times = {path: path.stat().st_mtime_ns for path in Path("run").iterdir() if path.name != ".lock"}
    found = tltlc("train", "--resume", "run", "--steps", "100")
    assert found == Outcome(
        1,
        "the training in `run` is over, and stays as it is: it took 128 steps, and its limit is 100; to go on, with a "
        "higher one: tltlc train --resume run --steps N\n",
        "",
    )
    assert {path: path.stat().st_mtime_ns for path in times} == times


def test_a_level_whose_file_was_moved(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    assert tltlc("new", "mine", "--level", "vault").status == 0
    asked = ("mine/vault.tltl", "--config", "small.toml", "--steps", "64", "--out", "run")
    assert tltlc("train", *asked).status == 1
    (here / "mine").rename(here / "yours")
    gone = tltlc("train", "--resume", "run", "--steps", "128")
    assert gone.status == 3
    assert f"the level's file `{here / 'mine' / 'vault.toml'}` is not there any more" in gone.err
    assert "`tltlc train --resume run --level FILE.toml`" in gone.err
    assert "`tltlc evaluate run --level FILE.toml`" in tltlc("evaluate", "run").err
    level = ("--level", "yours/vault.toml")
    assert tltlc("evaluate", "run", *level, "--episodes", "1").status == 0
    found = tltlc("train", "--resume", "run", "--steps", "128", *level)
    assert found.status == 1, found.err
    assert "ended by the limit of steps after 128 steps" in found.out
    other = tltlc("train", "--resume", "run", "--steps", "256", "--level", "cover_and_hide")
    assert "TLT0870" in other.err and "not on `cover_and_hide:v0`" in other.err


@pytest.mark.usefixtures("it")
def test_a_spec_of_the_same_name_is_told_apart(tltlc: TltlcFunction) -> None:  # noqa: F811
    Path("soon.tltl").write_text(SOON.replace("8 steps", "9 steps"))
    found = tltlc("train", "soon.tltl", "--resume", "it")
    assert found.err.startswith(
        "error[TLT0870]: the training in `it` is for another spec `soon` than that of `soon.tltl`: "
        "its limit is 9 steps, and was 8 steps\n"
    )


def test_until_the_spec_is_met(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    found = tltlc("train", "soon.tltl", "--config", "small.toml", "--out", "runs/soon", "--no-map")
    assert found.status == 0, found.err
    assert found.err.splitlines()[:2] == [
        "training soon on cover_and_hide v0, seed 0, in runs/soon",
        "Ctrl-C stops it and keeps what was learned; to go on: tltlc train --resume runs/soon",
    ]
    assert found.err.count("\n") == 3
    first, _, last = found.out.splitlines()
    assert re.fullmatch(r"the spec is met after 64 steps, \d+ s: met in 2 of the last 2 episodes, .*", first)
    assert last == "to evaluate it: tltlc evaluate runs/soon"
    card = read_policy("runs/soon/policy.safetensors").card
    best = card.training["best"]
    assert (best["pass_rate"], best["confirmed"]) == (1.0, True)
    assert (card.fspa.name, card.sensors.map, card.network.hidden) == ("soon", None, (8,))


def test_a_search_is_announced(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    Path("search.toml").write_text(SMALL.replace("ways = 0", "ways = 2\nsteps = 640"))
    found = tltlc("train", "soon.tltl", "--config", "search.toml", "--out", "it")
    assert found.status in (0, 1), found.err
    _, searched, lost, *lines = found.err.splitlines()
    assert searched == (
        "ways to meet the spec are searched first: by chance. "
        "The search ends when 2 ways are found, at the latest after 640 steps."
    )
    assert lost == "Ctrl-C stops it; a search that is not over then begins anew."
    assert "Ctrl-C stops it and keeps what was learned; to go on: tltlc train --resume it" in lines


@pytest.mark.usefixtures("it")
def test_a_folder_holds_one_training(tltlc: TltlcFunction) -> None:  # noqa: F811
    again = tltlc("train", "soon.tltl", "--config", "small.toml", "--out", "it")
    assert again == Outcome(
        1,
        "",
        "training soon on cover_and_hide v0, seed 0, in it\n"
        "error[TLT0867]: `it` holds a training already\n"
        "  help: go on with it by `tltlc train --resume it`, or name another place with --out\n",
    )
    Path("big.toml").write_text(SMALL.replace("[8]", "[9]").replace("steps = 128", "steps = 999"))
    asked = ["--level", "navigation:v1", "--seed", "9", "--no-entities", "--config", "big.toml"]
    other = tltlc("train", EXAMPLE, *asked, "--resume", "it")
    assert other.status == 1
    titles = re.findall(r"^error\[TLT0870\]: the training in `it` (.*)$", other.err, re.MULTILINE)
    assert titles == [
        "is on the level `cover_and_hide:v0`, not on `navigation:v1`",
        f"is for the spec `soon`, not for `cover_and_hide` of `{EXAMPLE}`",
        "has the seed 0, not 9",
        "senses as `--entities s1,s2,exit,guard` says, not as `--no-entities`",
        "has another `network.hidden` than `big.toml`",
    ]
    assert other.err.count("help: leave it out to go on with `it`, or begin another training with --out") == 5
    same = ["--level", "cover_and_hide:v0", "--seed", "0", "--config", "small.toml", "--steps", "999"]
    assert tltlc("train", "soon.tltl", *same, "--resume", "it").status == 0


def test_a_training_goes_into_no_folder_of_other_files(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    (here / "mine").mkdir()
    (here / "mine" / ".hidden").touch()
    asked = ("train", "soon.tltl", "--config", "small.toml", "--out", "mine")
    (here / "mine" / "notes.txt").write_text("of mine")
    assert tltlc(*asked) == Outcome(
        1,
        "",
        "error[TLT0873]: `mine` is no training, and has other files: `notes.txt`\n"
        "  help: name a folder of its own, e.g. `--out mine/training`\n",
    )
    assert {path.name for path in (here / "mine").iterdir()} == {".hidden", "notes.txt"}
    (here / "mine" / "notes.txt").unlink()
    assert tltlc(*asked).status == 0


@pytest.mark.parametrize(
    ("arguments", "status", "said"),
    [
        ([], 2, "say what to train for: a spec, a level, or both"),
        (["hide.tltl"], 2, "`hide` does not say which level it is about: name one with --level"),
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
        (["soon.tltl", "--config", "large.toml"], 1, "`network` gives a policy of 70 MiB, and a file of one has 64"),
        (["soon.tltl", "--config", "gone.toml"], 3, "cannot read `gone.toml`"),
        (
            ["small.toml"],
            2,
            "`small.toml` is no spec; where it holds settings, write `--config small.toml`, where it is a",
        ),
        (["--resume", "gone"], 1, "`gone` cannot be resumed from: there is no training in it"),
        (["vault.tltl"], 2, "there is no level `vault`: `vault.toml` is not there, and none of that name comes with"),
        (["--resume", "gone", "--out", "there"], 2, "--resume goes on in its own folder"),
        (["soon.tltl", "--out", "small.toml/run"], 3, "cannot write into `small.toml/run`"),
        (["soon.tltl", "--out", "small.toml/run"], 3, "a new training may go elsewhere, with --out"),
    ],
)
def test_what_cannot_be_trained(
    tltlc: TltlcFunction,  # noqa: F811
    here: Path,
    arguments: list[str],
    status: int,
    said: str,
) -> None:
    (here / "large.toml").write_text("[network]\nhidden = [8192, 4096]\n")
    (here / "hide.tltl").write_text("signal mood: bool\nspec hide { limit 9 steps\n keep mood }\n")
    (here / "vault.tltl").write_text(SOON.replace("cover_and_hide", "vault"))
    (here / "endless.tltl").write_text("import stealth\nspec endless { level navigation\n reach seen }\n")
    found = tltlc("train", *arguments)
    assert (found.status, found.out) == (status, ""), found.err
    assert said in found.err
    assert not (here / "training").exists()


def test_a_file_of_settings_changes_what_it_says_and_nothing_else(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    begun = ("--config", "small.toml", "--out", "it", "--steps", "64", "--workers", "2", "--minutes", "60")
    assert tltlc("train", EXAMPLE, *begun).status == 1
    settings = json.loads(Path("it/run.json").read_text())["settings"]
    Path("more.toml").write_text("checkpoint_s = 5\n[stop]\nsteps = 128\n")
    on = tltlc("train", "--resume", "it", "--config", "more.toml")
    assert on.status == 1, on.err
    settings["checkpoint_s"], settings["stop"]["steps"] = 5.0, 128
    assert json.loads(Path("it/run.json").read_text())["settings"] == settings


def test_what_nobody_can_do_is_said_before_it_is_tried(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    Path("far.tltl").write_text("import spatial\nentity exit\nspec far { limit 5 steps\n reach near(exit) }")
    found = tltlc("train", "far.tltl", "--level", "navigation:v2", "--config", "small.toml", "--steps", "64")
    first, warned = found.err.splitlines()[:2]
    assert first == "training far on navigation v2, seed 0, in training/navigation-v2-far-0"
    assert warned.startswith("warning[TLT0814]: nobody reaches `exit` in `navigation:v2`")


def test_the_level_beside_the_spec_comes_first(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    assert tltlc("new", "mine", "--level", "vault").status == 0
    found = tltlc("train", "mine/vault.tltl", "--config", "small.toml", "--steps", "64")
    assert found.status == 1, found.err
    assert Path("training/vault-v0-unseen-0/policy.safetensors").is_file()


def test_a_level_is_named_where_a_spec_could_be(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    found = tltlc("train", "navigation:v1", "--config", "small.toml", "--steps", "64")
    assert found.status == 1, found.err
    assert Path("training/navigation-v1-navigation-0").is_dir()


def test_the_defaults_can_be_had(tltlc: TltlcFunction) -> None:  # noqa: F811
    assert tltlc("train", "--print-config") == Outcome(0, default_text(), "")


def test_the_settings_that_would_hold_can_be_had(tltlc: TltlcFunction, here: Path) -> None:  # noqa: F811
    found = tltlc("train", "--print-config", "--config", "small.toml", "--minutes", "0.5", "--device", "cuda")
    assert found.status == 0, found.err
    Path("all.toml").write_text(found.out)
    wanted = read_settings(here / "small.toml")
    wanted = replace(wanted, device="cuda", stop=replace(wanted.stop, minutes=0.5))
    assert read_settings(here / "all.toml") == wanted
    assert "envs = 4                # environments, of each process of torchrun" in found.out.splitlines()
    assert len(found.out.splitlines()) == len(default_text().splitlines())


@pytest.mark.parametrize(("name", "status"), [("SIGINT", 130), ("SIGTERM", 143)])
def test_asked_to_end_it_can_go_on(tltlc: TltlcFunction, here: Path, name: str, status: int) -> None:  # noqa: F811
    with _training(here, "--steps", "100000000") as process:
        assert process.stderr is not None
        first = [process.stderr.readline() for _ in range(3)][-1]
        assert first.startswith("iteration 1: 64 steps in "), first + process.stderr.read()
        process.send_signal(getattr(signal, name))
        _, err = process.communicate(timeout=HANG_S)
    assert process.returncode == status
    assert err.splitlines()[-1] == "stopped; to go on: tltlc train --resume run"
    done = len(read_metrics(here / "run" / METRICS))
    on = tltlc("train", "--resume", "run", "--steps", str(64 * (done + 1)))
    assert on.status == 1, on.err
    assert [line["iteration"] for line in read_metrics(here / "run" / METRICS)] == list(range(1, done + 2))


def test_a_worker_that_is_killed(
    tltlc: TltlcFunction,  # noqa: F811
    here: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    iterations = Runner.iterations

    def with_a_kill(runner: Runner) -> Iterator[Iteration]:
        for iteration in iterations(runner):
            yield iteration
            (worker,) = active_children()
            worker.kill()

    monkeypatch.setattr(Runner, "iterations", with_a_kill)
    found = tltlc("train", EXAMPLE, "--config", "small.toml", "--out", "run", "--steps", "100000000")
    assert found.status == 1
    assert found.err.splitlines()[2].startswith("iteration 1: ")
    assert "error[TLT0871]: the training broke off: worker 0 was killed by SIGKILL\n" in found.err
    assert "to go on from the last checkpoint: tltlc train --resume run" in found.err
    assert (here / "run" / "checkpoint.pt").is_file()


def test_a_terminal_shows_a_picture(here: Path) -> None:
    ours, theirs = pty.openpty()
    environment = {**os.environ, "TERM": "xterm", "COLUMNS": "110", "LINES": "40"}
    with subprocess.Popen(_command("--steps", "128"), cwd=here, stderr=theirs, env=environment) as process:
        os.close(theirs)
        shown = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", b"".join(_output(ours)).decode())
    assert process.returncode == 1
    assert "playing the first steps" in shown
    last = shown[shown.rindex("cover_and_hide on cover_and_hide v0, seed 0") :]
    for said in ("spec met", "met in a row", "of 2, then the policy is confirmed", "state 0", "Reach near(s1)"):
        assert said in last
    assert "128 of at most 128 steps" in last


@pytest.mark.usefixtures("it")
def test_the_page_names_the_keys_of_the_record() -> None:
    page = (DOCS / "training.md").read_text(encoding="utf-8")
    section = page.partition("## The record")[2].partition("\n## ")[0]
    rows = re.findall(r"^\| (`.*?) \|", section, re.MULTILINE)
    said = [name for row in rows for name in re.findall(r"`(\w+)`", row)]
    assert said == list(json.loads(Path("it/record.json").read_text()))
    (search,) = re.findall(r"^\| `search` \| (.*) \|$", section, re.MULTILINE)
    # What is said of some of them follows behind all, by their names.
    assert tuple(dict.fromkeys(re.findall(r"`(\w+)`", search))) == Searched.__match_args__


def _command(*options: str) -> list[str]:
    arguments = ["train", str(EXAMPLE), "--config", "small.toml", "--out", "run", *options]
    return [sys.executable, "-m", "tltlc", *arguments]


def _training(folder: Path, *options: str) -> subprocess.Popen[str]:
    return subprocess.Popen(_command(*options), cwd=folder, stderr=subprocess.PIPE, text=True)


def _output(terminal: int) -> Iterator[bytes]:
    while True:
        try:
            data = os.read(terminal, 65536)
        except OSError:
            return
        if not data:
            return
        yield data
