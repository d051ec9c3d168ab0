"""``tltlc evaluate``: its reports, its files and its errors."""

from __future__ import annotations

import hashlib
import json
import os
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from PIL import Image

import tltl_runtime
from tests import pipes
from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.runtime.evaluation.untrained import SOON, untrained
from tests.waiting import HANG_S
from tltl_runtime.evaluation.evaluate import evaluate
from tltl_runtime.evaluation.player import PolicyPlayer
from tltl_runtime.game.level_name import Variant
from tltl_runtime.policies.file import write_policy
from tltl_runtime.policies.policy import Policy
from tltl_runtime.policies.shipped import shipped_policy
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.levels.identity import level_hash
from tltl_runtime.stealth.recordings.file import read_episode, write_episode
from tltl_runtime.training.files.run_file import TrainingRun, write_run
from tltl_runtime.training.files.settings import read_settings
from tltlc.core.record import replace

Run = Callable[..., Outcome]
STARTER = Path(tltl_runtime.__file__).with_name("starter")
LEVELS = ("navigation", "cover_and_hide", "branching")
EPISODE = "index seed success verdict end progress reward steps seconds state unmet label".split()
FIGURES = ["pass_rate", "pass_interval", "progress", "reward", "steps", "causes", "ended", "episodes"]


@pytest.fixture(scope="module")
def policy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("trained") / "policy.safetensors"
    write_policy(path, untrained())
    return path


def test_the_text_report(tltlc: Run, policy: Path) -> None:  # noqa: F811
    result = tltlc("evaluate", policy, "--episodes", "3", "--seed", "5")
    assert result.status == 0
    lines = result.out.splitlines()
    assert lines[0] == f"cover_and_hide:v0, spec soon, seed 5: {policy}"
    assert lines[1] == "note: the level has changed since the policy was trained on it"
    assert lines[5] == "pass rate (95 %)  0.00 (0.00 to 0.56)     0.00 (0.00 to 0.56)"
    assert "sampled: 3 of 3 failed" in lines
    assert "  3 out of time in state 0, remaining: Reach near(exit), and keep alive" in lines
    assert "    throughout." in lines
    assert lines[-2:] == [
        "To record one of them, for `tltlc replay`:",
        f"  tltlc evaluate {policy} --seed 5 --first 0 --episodes 1 --out evaluation",
    ]
    progress = result.err.splitlines()
    assert progress[2] == "50% played; passed: 0 of 3 sampled"
    assert progress[-1] == "100% played; passed: 0 of 3 sampled, 0 of 3 arg-max"


def test_the_json_report(tltlc: Run, policy: Path) -> None:  # noqa: F811
    result = tltlc("evaluate", policy.parent, "--episodes", "4", "--seed", "5", "--json", "-")
    assert result.status == 0
    report = json.loads(result.out)
    head = ["level", "variant", "level_hash", "spec", "seed", "first", "complete", "policy", "versions"]
    assert list(report) == [*head, *FIGURES, "argmax"]
    assert list(report["argmax"]) == FIGURES
    assert (report["level"], report["variant"], report["spec"], report["seed"]) == ("cover_and_hide", "v0", "soon", 5)
    assert report["level_hash"] == level_hash(load_level("cover_and_hide")) != report["policy"]["level_hash"]
    assert [episode["index"] for episode in report["episodes"]] == [0, 1, 2, 3]
    assert {episode["seed"] for episode in report["episodes"]} == {
        episode["seed"] for episode in report["argmax"]["episodes"]
    }
    assert report["progress"].keys() == report["reward"].keys() == {"mean", "std"}
    for episode in (*report["episodes"], *report["argmax"]["episodes"]):
        assert episode["reward"] == pytest.approx(episode["progress"] - 1.0)
        assert list(episode) == EPISODE
    assert re.fullmatch("[0-9a-f]{64}", report["policy"]["sha256"])
    assert {"tltlc", "gymnasium", "pybullet", "numpy"} < report["versions"].keys()

    again = json.loads(tltlc("evaluate", policy, "--episodes", "2", "--first", "2", "--seed", "5", "--json", "-").out)
    assert again["episodes"] == report["episodes"][2:]


def test_the_report_does_not_overwrite_an_input(tltlc: Run, policy: Path, tmp_path: Path) -> None:  # noqa: F811
    copied_policy = tmp_path / "mine.safetensors"
    shutil.copy(policy, copied_policy)
    result = tltlc("evaluate", copied_policy, "--episodes", "1", "--json", copied_policy)
    assert result.status == 2
    assert f"`{copied_policy}` would be overwritten, but it is an input" in result.err
    assert "played" not in result.err
    assert copied_policy.read_bytes() == policy.read_bytes()


def test_a_policy_deleted_during_the_evaluation_is_still_identified(
    tltlc: Run,  # noqa: F811
    policy: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    copied_policy, play = tmp_path / "mine.safetensors", PolicyPlayer.play
    shutil.copy(policy, copied_policy)
    monkeypatch.setattr(
        PolicyPlayer, "play", lambda self, request: copied_policy.unlink(missing_ok=True) or play(self, request)
    )
    result = tltlc("evaluate", copied_policy, "--episodes", "1", "--json", "-")
    assert result.status == 0, result.err
    assert json.loads(result.out)["policy"]["sha256"] == hashlib.sha256(policy.read_bytes()).hexdigest()


def test_recordings_and_pictures_are_written(
    tltlc: Run,  # noqa: F811
    policy: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    folder, report = tmp_path / "new" / "runs", tmp_path / "new" / "report.json"
    command = ("evaluate", policy, "--episodes", "2", "--seed", "5", "--out", folder, "--json", report)
    result = tltlc(*command)
    assert result.status == 0
    stems = [f"cover_and_hide-v0-5-{index}-{chosen}" for index in (0, 1) for chosen in ("arg-max", "sampled")]
    names = [f"{stem}{ending}" for stem in stems for ending in (".episode.npz", ".png")]
    names += ["evaluation.json", "ways-arg-max.png", "ways-sampled.png"]
    assert sorted(path.name for path in folder.iterdir()) == sorted(names)
    assert report.read_text() == (folder / "evaluation.json").read_text()
    assert result.err.splitlines()[-1] == (
        f"wrote {folder}: 4 recordings with plans, ways-sampled.png, ways-arg-max.png, evaluation.json; "
        "look at ways-sampled.png first"
    )
    evaluation = json.loads(report.read_text())
    for entry in evaluation["episodes"]:
        episode = read_episode(folder / f"cover_and_hide-v0-5-{entry['index']}-sampled.episode.npz")
        assert (episode.seed, episode.end) == (entry["seed"], entry["end"])
        assert float(episode.rewards.sum()) == pytest.approx(entry["reward"])
        sha256 = evaluation["policy"]["sha256"]
        assert episode.player == f"policy cover_and_hide soon {sha256[:8]}, sampled, episode {entry['index']}"
    with Image.open(folder / "ways-sampled.png") as picture:
        red = sum(count for count, colour in picture.convert("RGB").getcolors(1 << 20) if colour == (100, 116, 139))
    assert red > 50, "there are marks where time was up"
    assert "To record one of them" not in result.out

    # Recordings of other episodes of the same policy stay; recordings of another policy are removed, since they could
    # be mistaken for recordings of this one.
    kept = ["cover_and_hide-v0-5.png", "cover_and_hide-v1-5-0-sampled.png", "notes.txt", "ways-of-mine.png"]
    for name in kept:
        (folder / name).touch()
    fewer = ("--record", "none", "--episodes", "1")
    again = tltlc(*command, *fewer)
    assert "removed" not in again.err
    assert sorted(path.name for path in folder.iterdir()) == sorted([*kept, *names])
    pipe = "cover_and_hide-v0-5-9-sampled.episode.npz"
    pipes.put_beside(folder / pipe)
    pipes.forbid(monkeypatch)
    kept += [pipe, f"a_{pipe}"]
    policy_of_mine, other = untrained(), tmp_path / "other.safetensors"
    write_policy(other, Policy(replace(policy_of_mine.card, training={"seed": 9}), policy_of_mine.weights()))
    again = tltlc("evaluate", other, *command[2:], *fewer)
    assert sorted(path.name for path in folder.iterdir()) == sorted([*kept, *names[-3:]])
    assert again.err.splitlines()[-2:] == [
        f"removed files of an earlier evaluation from {folder}: cover_and_hide-v0-5-0-arg-max.episode.npz, "
        "cover_and_hide-v0-5-0-arg-max.png, cover_and_hide-v0-5-0-sampled.episode.npz, "
        "cover_and_hide-v0-5-0-sampled.png, cover_and_hide-v0-5-1-arg-max.episode.npz, "
        "cover_and_hide-v0-5-1-arg-max.png and 2 more",
        f"wrote {folder}: no recordings, ways-sampled.png, ways-arg-max.png, evaluation.json; "
        "look at ways-sampled.png first",
    ]


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("evaluation.json", "of mine"),
        ("evaluation.json", '{"level": 3}'),
        ("evaluation.json", "[" * 1000),
        ("ways-sampled.png", "mine"),
        ("ways-arg-max.png", "mine"),
    ],
)
def test_files_that_no_evaluation_wrote_are_not_overwritten(
    tltlc: Run,  # noqa: F811
    policy: Path,
    tmp_path: Path,
    name: str,
    text: str,
) -> None:
    path = tmp_path / "runs" / name
    path.parent.mkdir()
    path.write_text(text)
    result = tltlc("evaluate", policy, "--episodes", "1", "--out", path.parent)
    assert (result.status, result.out) == (2, "")
    assert f"error[TLT0722]: `{path}` already exists, and no evaluation wrote it" in result.err
    assert (path.read_text(), len([*path.parent.iterdir()])) == (text, 1)


@pytest.mark.skipif(not Path("/dev/fd").exists(), reason="descriptors have no names here")
def test_the_json_report_is_written_into_a_pipe(tltlc: Run, policy: Path) -> None:  # noqa: F811
    read_end, write_end = os.pipe()
    with os.fdopen(read_end, encoding="utf-8") as pipe:
        result = tltlc("evaluate", policy, "--episodes", "1", "--json", f"/dev/fd/{write_end}")
        os.close(write_end)
        assert result.status == 0, result.err
        assert len(json.load(pipe)["episodes"]) == 1


def test_a_recording_names_its_player_once(tltlc: Run, tmp_path: Path) -> None:  # noqa: F811
    folder, policy = tmp_path / "runs", tmp_path / "policy.safetensors"
    # Its spec is named like its level.
    write_policy(policy, untrained(SOON.replace("spec soon", "spec cover_and_hide")))
    result = tltlc("evaluate", policy, "--episodes", "1", "--out", folder, "--record", "all")
    assert result.status == 0, result.err
    path = folder / "cover_and_hide-v0-0-0-sampled.episode.npz"
    episode, sha256 = read_episode(path), json.loads((folder / "evaluation.json").read_text())["policy"]["sha256"]
    assert episode.player == f"policy cover_and_hide {sha256[:8]}, sampled, episode 0"
    # Recordings of this policy stay, whatever the name of their level.
    write_episode(path, replace(episode, player=f"policy cover, and_hide {sha256[:8]}, sampled, episode 0"))
    tltlc("evaluate", policy, "--episodes", "1", "--out", folder, "--record", "none")
    assert path.exists()


def test_recordings_need_a_folder(tltlc: Run, policy: Path) -> None:  # noqa: F811
    result = tltlc("evaluate", policy, "--record", "all")
    assert (result.status, result.out) == (2, "")
    assert "--record needs a folder for the recordings: add --out DIR" in result.err


def test_the_folder_of_a_training_names_the_file_of_its_level(
    tltlc: Run,  # noqa: F811
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    shutil.copytree(STARTER, tmp_path / "mine")
    level = str(tmp_path / "mine" / "vault.toml")
    folder, trained = tmp_path / "trained", untrained(None, level)
    card = trained.card
    write_run(TrainingRun(folder, card.fspa, card.params, level, Variant("v0"), card.sensors, read_settings(None), 0))
    # The training was written by an older version, which lacked a setting.
    run = json.loads((folder / "run.json").read_text())
    del run["settings"]["ppo"]["entropy_schedule"]
    (folder / "run.json").write_text(json.dumps(run))
    write_policy(folder / "policy.safetensors", trained)
    monkeypatch.chdir(folder)
    result = tltlc("evaluate", folder, "--episodes", "1", "--json", "-")
    assert (json.loads(result.out)["level"], result.status) == ("vault", 0)
    without_folder = tltlc("evaluate", "policy.safetensors", "--episodes", "1")
    assert (without_folder.status, without_folder.out) == (2, "")
    assert without_folder.err == (
        "error[TLT0800]: there is no level `vault`: the policy was trained on a level of your own\n"
        "  help: name its file: `tltlc evaluate policy.safetensors --level vault.toml`\n"
    )


@pytest.mark.slow
@pytest.mark.parametrize(("name", "status", "workers"), [("SIGINT", 130, "2"), ("SIGTERM", 143, "1")])
def test_a_signal_ends_it_with_a_report_of_the_played_episodes(
    policy: Path, name: str, status: int, workers: str
) -> None:
    command = [sys.executable, "-m", "tltlc", "evaluate", str(policy), "--episodes", "300", "--workers", workers]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as evaluating:
        assert evaluating.stderr is not None
        assert evaluating.stderr.readline() == "10% played; passed: 0 of 60 sampled\n"
        evaluating.send_signal(getattr(signal, name))
        out, err = evaluating.communicate(timeout=HANG_S)
    assert evaluating.returncode == status
    (stopped,) = re.findall(r"^stopped: (\d+) of 300 sampled and 0 of 300 arg-max episodes were played$", err, re.M)
    (played,) = re.findall(r"^episodes +(\d+)", out, re.MULTILINE)
    assert 60 <= int(played) == int(stopped) < 300


@pytest.mark.parametrize(
    ("arguments", "status", "message"),
    [
        ((), 2, "error[TLT0700]: name a POLICY or a --level, or both"),
        (("nowhere.safetensors",), 3, "error[TLT0001]"),
        (("--level", "nowhere"), 2, "error[TLT0800]: there is no level `nowhere`"),
        (("POLICY", "--level", "cover_and_hide:v9"), 2, "error[TLT0800]"),
        (("POLICY", "--level", "navigation"), 1, "error[TLT0843]"),
        (("POLICY", "--spec", "cover_and_hide.tltl"), 1, "error[TLT0843]"),
        (("POLICY", "--workers", "many"), 2, "error[TLT0700]: invalid value for '--workers': `many` is neither"),
        (("POLICY", "--workers", "10001"), 2, "error[TLT0700]: invalid value for '--workers': `10001` is neither"),
        (("POLICY", "--episodes", "0"), 2, "error[TLT0700]"),
        (
            ("POLICY", "--spec", "s.toml:v1"),
            2,
            "error[TLT0700]: `s.toml` is not a spec: if it is a level, write `--level s.toml:v1`",
        ),
        (
            ("POLICY", "--spec", "s.game.toml:hall"),
            2,
            "error[TLT0700]: `s.game.toml` is not a spec: if it is a scene of your game, write `--game",
        ),
        (("POLICY", "--json", "file/report.json"), 3, "error[TLT0005]"),
        (("POLICY", "--json", "gone/report.json"), 3, "error[TLT0005]: cannot write `gone/report.json`: there is no"),
        (("POLICY", "--out", "-"), 2, "error[TLT0700]: invalid value for '--output'"),
        (("bot.onnx",), 1, "error[TLT0840]: `bot.onnx` is an ONNX model for other engines, not a policy"),
        (("POLICY", "--out", "file/runs"), 3, "error[TLT0005]"),
    ],
)
def test_invalid_options_are_rejected(
    tltlc: Run,  # noqa: F811
    policy: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    arguments: tuple[str, ...],
    status: int,
    message: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").touch()
    (tmp_path / "bot.onnx").touch()
    (tmp_path / "cover_and_hide.tltl").write_text(SOON.replace("20 steps", "25 steps"))
    result = tltlc("evaluate", *(str(policy) if argument == "POLICY" else argument for argument in arguments))
    assert (result.status, result.out) == (status, "")
    assert result.err.lower().startswith(message.lower())


def test_a_level_uses_its_shipped_policy(tltlc: Run) -> None:  # noqa: F811
    result = tltlc("evaluate", "--level", "cover_and_hide", "--episodes", "3", "--json", "-")
    report = json.loads(result.out)
    assert report["level_hash"] == report["policy"]["level_hash"]
    named = json.loads(tltlc("evaluate", "cover_and_hide:v1", "--episodes", "1", "--json", "-").out)
    assert (named["level"], named["variant"], named["policy"]) == ("cover_and_hide", "v1", report["policy"])
    assert (report["level"], report["spec"]) == ("cover_and_hide", "cover_and_hide")
    assert report["argmax"]["pass_rate"] >= 0.9


@pytest.mark.slow
@pytest.mark.parametrize("level", LEVELS)
def test_the_shipped_policies_meet_their_specs(level: str) -> None:
    path = shipped_policy(level)
    assert path is not None
    for sampled in (True, False):
        played = list(evaluate(path, episodes=100, seed=11, sampled=sampled))
        assert sum(episode.success for episode in played) >= 95
