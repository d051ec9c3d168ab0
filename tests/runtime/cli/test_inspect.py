"""``tltlc inspect``: what policies are, and policies for other engines."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.runtime.policies.examples import card_of, observation_of, policy_of
from tests.runtime.training.reports import a_report, an_episode
from tests.runtime.training.runs import run_in
from tltl_runtime.policies.file import write_policy
from tltl_runtime.policies.identity import spec_hash
from tltl_runtime.policies.policy import Policy
from tltl_runtime.policies.summary import summary, summary_text
from tltl_runtime.training.run.metrics import METRICS, measurements
from tltl_runtime.training.run.run import POLICY, write_run
from tltl_runtime.training.run.train import train
from tltlc.core.record import replace

TRAINING = {
    "seed": 3,
    "end": "met",
    "steps": 412_000,
    "seconds": 512.25,
    "window": {"episodes": 100, "pass_rate": 0.98},
    "best": {"pass_rate": 1.0, "steps": 408_000, "confirmed": True},
    "search": {"steps": 6400, "lengths": [90, 80]},
}


@pytest.fixture(name="policy", scope="module")
def _policy() -> Policy:
    return policy_of(replace(card_of("cover_and_hide"), training=TRAINING))


@pytest.fixture(name="file")
def _file(policy: Policy, tmp_path: Path) -> Path:
    write_policy(tmp_path / "policy.safetensors", policy)
    return tmp_path / "policy.safetensors"


def test_a_summary(tltlc, file: Path, policy: Policy) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    found: Outcome = tltlc("inspect", str(file))
    assert (found.status, found.err) == (0, "")
    lines = found.out.splitlines()
    assert lines[0] == str(file)
    assert lines[1] == f"  level    cover_and_hide v0 (hash {policy.card.level_hash[:12]})"
    assert lines[2].startswith(f"  spec     cover_and_hide (hash {spec_hash(policy.card.fspa)[:12]}): ")
    assert lines[3].startswith("           ")
    assert lines[4].startswith("  senses   s1, s2, exit, ")
    assert max(map(len, lines[1:])) <= 80
    assert any(line.startswith("  map      15 x 15 cells of ") for line in lines)
    assert "  training seed 3, 412,000 steps, 512 s, pass rate 0.98 in its last episodes" in lines
    assert "  kept     the best policy, pass rate 1.00 in its window, after 408,000 steps," in lines
    assert "           confirmed in fresh episodes" in lines
    assert "  ended    the spec was met" in lines
    assert "  search   2 ways to meet the spec, the shortest of 80 steps" in lines
    assert tltlc("inspect", str(file.parent)).out.splitlines()[1:] == lines[1:]


def test_a_summary_as_json_with_a_file_that_is_no_policy(tltlc, file: Path, policy: Policy) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    other = file.with_name("torn.safetensors")
    other.write_bytes(file.read_bytes()[:1000])
    found: Outcome = tltlc("inspect", str(other), str(file), "--format", "json")
    assert found.status == 1
    assert [each["code"] for each in json.loads(found.err)["diagnostics"]] == ["TLT0840"]
    (said,) = json.loads(found.out)
    assert (said["file"], said["level"], said["training"]) == (str(file), "cover_and_hide", TRAINING)
    assert said["branches"] == [3, 3, 2, 2, 2]
    assert (said["formula"], said["english"]) == (policy.card.fspa.formula.ascii, policy.card.fspa.formula.english)
    assert said["observation"]["automaton"] == [len(said["states"])]


@pytest.mark.parametrize(
    "training",
    [
        {},
        {"seed": "x", "seconds": [], "window": 3},
        {"window": {"pass_rate": None}},
        {"window": {"episodes": 0, "pass_rate": 0.0}},
        {"end": ["met"], "search": {"lengths": ["x"]}, "best": {"pass_rate": "x"}},
        {"search": None},
    ],
)
def test_a_training_that_says_nothing_that_is_known(tltlc, policy: Policy, tmp_path: Path, training: object) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    path = tmp_path / "bot.safetensors"
    write_policy(path, Policy(replace(policy.card, training=training), policy.weights()))
    found: Outcome = tltlc("inspect", str(path))
    assert (found.status, found.err) == (0, "")
    assert not any(f"  {row} " in found.out for row in ("training", "kept", "ended", "search"))


@pytest.mark.parametrize(
    ("training", "said"),
    [
        ({"end": "minutes", "search": {"lengths": []}}, ["by the limit of minutes", "no way to meet the spec"]),
        ({"end": "steps", "search": {"lengths": [7]}}, ["the limit of steps", "1 way to meet the spec, the shortest"]),
        (
            {"imitated": {"episodes": 20, "decisions": 3012, "players": ["expert"], "left_out": []}},
            ["imitated 20 demonstrations of 3,012 decisions, by expert"],
        ),
    ],
)
def test_how_a_training_ended(policy: Policy, training: dict[str, object], said: list[str]) -> None:
    text = summary_text(summary(Policy(replace(policy.card, training=training), policy.weights())))
    assert all(each in text for each in said)


def test_a_training_that_goes_on(tltlc, policy: Policy, tmp_path: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    write_run(run_in(tmp_path))
    write_policy(tmp_path / POLICY, Policy(replace(policy.card, training={}), policy.weights()))
    line = measurements(a_report(count=0, successes=0, finished=(an_episode(True),)), policy.card.fspa)
    (tmp_path / METRICS).write_text(json.dumps(line) + "\n")
    found: Outcome = tltlc("inspect", str(tmp_path))
    assert "  ended    not yet: after 4,096 steps, 1 episode ended" in found.out.splitlines()
    assert "  training seed 3, 4,096 steps, 2 s" in found.out.splitlines()


def test_how_far_a_training_is(tltlc, tmp_path: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    run = run_in(tmp_path / "run", rollout__steps=512, stop__steps=10**6, stop__episodes=1)
    reports = train(run)
    last = next(report for report in reports if report.best_pass_rate is not None)
    reports.close()
    found: Outcome = tltlc("inspect", str(run.folder), "--format", "json")
    said = json.loads(found.out)[0]["training"]
    assert (said["seed"], said["end"], said["steps"], said["search"]) == (3, None, last.steps, None)
    assert said["window"]["pass_rate"] == round(last.window.pass_rate, 6)
    assert said["best"]["pass_rate"] == round(last.best_pass_rate, 6)


@pytest.mark.parametrize(("broken", "code"), [("checkpoint.pt", "TLT0864"), ("run.json", "TLT0863")])
def test_a_training_that_is_broken_keeps_no_other_from_being_shown(
    tltlc,  # type: ignore[no-untyped-def] # noqa: F811
    policy: Policy,
    file: Path,
    tmp_path: Path,
    broken: str,
    code: str,
) -> None:
    folder = tmp_path / "run"
    write_run(run_in(folder))
    write_policy(folder / POLICY, Policy(replace(policy.card, training={}), policy.weights()))
    (folder / broken).write_text("{}")
    found: Outcome = tltlc("inspect", str(folder), str(file))
    assert found.status == 1
    assert f"error[{code}]: `{folder / broken}` cannot be resumed from" in found.err
    assert [line for line in found.out.splitlines() if line.endswith(("run", ".safetensors"))] == [str(file)]
    found = tltlc("inspect", str(folder), str(file), "--format", "json")
    assert [each["code"] for each in json.loads(found.err)["diagnostics"]] == [code]
    assert [each["file"] for each in json.loads(found.out)] == [str(file)]


def test_a_policy_that_comes_with_a_level(tltlc) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    one, other = (tltlc("inspect", name) for name in ("cover_and_hide", "cover_and_hide:v1"))
    assert (one.status, one.err) == (other.status, other.err) == (0, "")
    assert one.out.splitlines()[1:] == other.out.splitlines()[1:]


def test_a_stranger_s_file_does_not_command_the_terminal(tltlc, policy: Policy, tmp_path: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    path = tmp_path / "bot.safetensors"
    write_policy(path, Policy(replace(policy.card, level="\x1b[2Jgone\n", versions={"\x07": "\x1b"}), policy.weights()))
    found: Outcome = tltlc("inspect", str(path))
    assert "  level    \ufffd[2Jgone\ufffd v0" in found.out
    assert "\x1b" not in found.out and "\x07" not in found.out


def test_an_export_says_what_it_wrote_and_nothing_else(file: Path, policy: Policy) -> None:
    onnxruntime = pytest.importorskip("onnxruntime")
    out = file.with_name("bot.onnx")
    command = [sys.executable, "-m", "tltlc", "inspect", str(file), "-o", str(out)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert (done.stdout, done.stderr) == ("", f"wrote {out}\n")
    seen = observation_of(policy.card, np.random.default_rng(0), (1,))
    feed = {key: each.astype(np.float32) for key, each in seen.items()}
    _, action = onnxruntime.InferenceSession(out).run(None, feed)
    assert action[0].tolist() == policy.choose({key: each[0] for key, each in seen.items()}).tolist()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("a.safetensors", "-o", "a.pt"), "-o writes a .onnx, not `a.pt`"),
        (("a.safetensors", "b.safetensors", "-o", "a.onnx"), "-o takes one POLICY"),
        ((), "POLICY"),
    ],
)
def test_usage(tltlc, arguments: tuple[str, ...], said: str) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    found: Outcome = tltlc("inspect", *arguments)
    assert found.status == 2
    assert said in found.err


def test_a_policy_that_is_not_there(tltlc, tmp_path: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    found: Outcome = tltlc("inspect", str(tmp_path / "none.safetensors"))
    assert found.status == 3
    assert "TLT0001" in found.err
