"""``tltlc inspect``: summaries of policies, and their export to ONNX."""

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
from tltl_runtime.training.files.metrics import METRICS, metrics_line
from tltl_runtime.training.files.run_file import POLICY, write_run
from tltl_runtime.training.run.train import train
from tltlc.automaton.text import formula_text
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

VAIN = "import spatial\nentity exit\nspec vain { limit 8 steps\n reach near(exit) }\n"
"""A spec that nobody meets, so that a training does not end."""


@pytest.fixture(name="policy", scope="module")
def _policy() -> Policy:
    return policy_of(replace(card_of("cover_and_hide"), training=TRAINING))


@pytest.fixture(name="file")
def _file(policy: Policy, tmp_path: Path) -> Path:
    write_policy(tmp_path / "policy.safetensors", policy)
    return tmp_path / "policy.safetensors"


def test_the_text_summary(tltlc, file: Path, policy: Policy) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    result: Outcome = tltlc("inspect", str(file))
    assert (result.status, result.err) == (0, "")
    lines = result.out.splitlines()
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


def test_the_json_summary_next_to_an_invalid_file(tltlc, file: Path, policy: Policy) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    other = file.with_name("torn.safetensors")
    other.write_bytes(file.read_bytes()[:1000])
    result: Outcome = tltlc("inspect", str(other), str(file), "--format", "json")
    assert result.status == 1
    assert [diagnostic["code"] for diagnostic in json.loads(result.err)["diagnostics"]] == ["TLT0840"]
    (record,) = json.loads(result.out)
    assert (record["file"], record["level"], record["training"]) == (
        str(file),
        "cover_and_hide",
        TRAINING,
    )
    assert record["branches"] == [3, 3, 2, 2, 2]
    assert (record["formula"], record["english"]) == (
        str(policy.card.fspa.formula),
        formula_text(policy.card.fspa),
    )
    assert record["observation"]["automaton"] == [len(record["states"])]


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
def test_unknown_training_records_are_not_shown(tltlc, policy: Policy, tmp_path: Path, training: object) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    path = tmp_path / "bot.safetensors"
    write_policy(path, Policy(replace(policy.card, training=training), policy.weights()))
    result: Outcome = tltlc("inspect", str(path))
    assert (result.status, result.err) == (0, "")
    assert not any(f"  {row} " in result.out for row in ("training", "kept", "ended", "search"))


@pytest.mark.parametrize(
    ("training", "messages"),
    [
        ({"end": "minutes", "search": {"lengths": []}}, ["by the limit of minutes", "no way to meet the spec"]),
        ({"end": "steps", "search": {"lengths": [7]}}, ["the limit of steps", "1 way to meet the spec, the shortest"]),
        (
            {"imitated": {"episodes": 20, "decisions": 3012, "players": ["expert"], "left_out": []}},
            ["imitated 20 demonstrations of 3,012 decisions, by expert"],
        ),
    ],
)
def test_the_end_of_a_training_is_shown(policy: Policy, training: dict[str, object], messages: list[str]) -> None:
    text = summary_text(summary(Policy(replace(policy.card, training=training), policy.weights())))
    assert all(part in text for part in messages)


def test_an_unfinished_training_is_shown(tltlc, policy: Policy, tmp_path: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    write_run(run_in(tmp_path))
    write_policy(tmp_path / POLICY, Policy(replace(policy.card, training={}), policy.weights()))
    line = metrics_line(a_report(count=0, successes=0, finished=(an_episode(True),)), policy.card.fspa)
    (tmp_path / METRICS).write_text(json.dumps(line) + "\n")
    result: Outcome = tltlc("inspect", str(tmp_path))
    assert "  ended    not yet: after 4,096 steps, 1 episode ended" in result.out.splitlines()
    assert "  training seed 3, 4,096 steps, 2 s" in result.out.splitlines()


def test_the_progress_of_an_unfinished_training_is_shown(tltlc, tmp_path: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    run = run_in(tmp_path / "run", VAIN, stop__steps=10**6, stop__episodes=1)
    reports = train(run)
    last = next(report for report in reports if report.best_pass_rate is not None)
    reports.close()
    result: Outcome = tltlc("inspect", str(run.folder), "--format", "json")
    training = json.loads(result.out)[0]["training"]
    assert (training["seed"], training["end"], training["steps"], training["search"]) == (3, None, last.steps, None)
    assert training["window"]["pass_rate"] == round(last.window.pass_rate, 6)
    assert training["best"]["pass_rate"] == round(last.best_pass_rate, 6)


@pytest.mark.parametrize(
    ("broken", "code", "title"),
    [("checkpoint.pt", "TLT0864", "cannot use the checkpoint"), ("run.json", "TLT0863", "cannot use")],
)
def test_a_broken_training_does_not_hide_other_policies(
    tltlc,  # type: ignore[no-untyped-def] # noqa: F811
    policy: Policy,
    file: Path,
    tmp_path: Path,
    broken: str,
    code: str,
    title: str,
) -> None:
    folder = tmp_path / "run"
    write_run(run_in(folder))
    write_policy(folder / POLICY, Policy(replace(policy.card, training={}), policy.weights()))
    (folder / broken).write_text("{}")
    result: Outcome = tltlc("inspect", str(folder), str(file))
    assert result.status == 1
    assert f"error[{code}]: {title} `{folder / broken}`" in result.err
    assert [line for line in result.out.splitlines() if line.endswith(("run", ".safetensors"))] == [str(file)]
    result = tltlc("inspect", str(folder), str(file), "--format", "json")
    assert [diagnostic["code"] for diagnostic in json.loads(result.err)["diagnostics"]] == [code]
    assert [record["file"] for record in json.loads(result.out)] == [str(file)]


def test_a_shipped_policy_is_named_by_its_level(tltlc) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    one, other = (tltlc("inspect", name) for name in ("cover_and_hide", "cover_and_hide:v1"))
    assert (one.status, one.err) == (other.status, other.err) == (0, "")
    assert one.out.splitlines()[1:] == other.out.splitlines()[1:]


def test_control_characters_in_a_policy_are_replaced(tltlc, policy: Policy, tmp_path: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    path = tmp_path / "bot.safetensors"
    write_policy(path, Policy(replace(policy.card, level="\x1b[2Jgone\n", versions={"\x07": "\x1b"}), policy.weights()))
    result: Outcome = tltlc("inspect", str(path))
    assert "  level    \ufffd[2Jgone\ufffd v0" in result.out
    assert "\x1b" not in result.out and "\x07" not in result.out


def test_an_export_reports_the_written_file_and_chooses_the_same_actions(tltlc, file: Path, policy: Policy) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    onnxruntime = pytest.importorskip("onnxruntime")
    out = file.with_name("bot.onnx")
    assert tltlc("inspect", str(file), "-o", str(out)) == Outcome(0, "", f"wrote {out}\n")
    observation = observation_of(policy.card, np.random.default_rng(0), (1,))
    feed = {key: values.astype(np.float32) for key, values in observation.items()}
    _, action = onnxruntime.InferenceSession(out).run(None, feed)
    assert action[0].tolist() == policy.choose({key: values[0] for key, values in observation.items()}).tolist()


@pytest.mark.slow
def test_a_process_that_exports_prints_no_warnings(file: Path) -> None:
    pytest.importorskip("onnxruntime")
    out = file.with_name("bot.onnx")
    command = [sys.executable, "-m", "tltlc", "inspect", str(file), "-o", str(out)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert (done.stdout, done.stderr) == ("", f"wrote {out}\n")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("a.safetensors", "-o", "a.pt"), "-o writes a .onnx file, not `a.pt`"),
        (("a.safetensors", "b.safetensors", "-o", "a.onnx"), "-o takes one POLICY"),
        ((), "POLICY"),
    ],
)
def test_invalid_options_are_rejected(tltlc, arguments: tuple[str, ...], message: str) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    result: Outcome = tltlc("inspect", *arguments)
    assert result.status == 2
    assert message in result.err


def test_a_missing_policy_is_reported(tltlc, tmp_path: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    result: Outcome = tltlc("inspect", str(tmp_path / "none.safetensors"))
    assert result.status == 3
    assert "TLT0001" in result.err
