"""Training by a spec that remembers the trace so far: the agent observes its registers."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.runtime.training.tiny_game import GAME, SPEC_WITH_MEMORY, line_run, only_game
from tltl_runtime.evaluation.evaluate import evaluate
from tltl_runtime.policies.compatibility import check_policy
from tltl_runtime.policies.file import read_policy, write_policy
from tltl_runtime.spec.automaton_observation import automaton_entries
from tltl_runtime.spec.task import load_task
from tltl_runtime.training.files.report import TrainingReport
from tltl_runtime.training.files.run_file import POLICY, TrainingRun
from tltl_runtime.training.run.train import train
from tltlc.diagnostics.diagnostic import TltlError


@pytest.fixture(autouse=True, scope="module")
def _game() -> Iterator[None]:
    with only_game():
        yield


@pytest.fixture(name="learned", scope="module")
def _learned(tmp_path_factory: pytest.TempPathFactory) -> tuple[TrainingRun, list[TrainingReport]]:
    run = line_run(
        tmp_path_factory.mktemp("line") / "run",
        spec=SPEC_WITH_MEMORY,
        network__hidden=(64,),
        rollout__envs=16,
        rollout__steps=64,
        ppo__learning_rate=3e-3,
        ppo__epochs=6,
        stop__steps=40 * 16 * 64,
        stop__confirmation=40,
    )
    return run, list(train(run))


def test_an_agent_learns_by_a_spec_with_registers(learned: tuple[TrainingRun, list[TrainingReport]]) -> None:
    run, reports = learned
    assert reports[0].window.pass_rate < 0.7
    assert reports[-1].stop == "met"
    policy = read_policy(run.folder / POLICY)
    episodes = list(evaluate(policy, "line", "v0", episodes=50, seed=5, sampled=False))
    assert sum(episode.success for episode in episodes) >= 45


def test_a_policy_stores_the_registers_that_it_observes(
    learned: tuple[TrainingRun, list[TrainingReport]], tmp_path: Path
) -> None:
    policy = read_policy(learned[0].folder / POLICY)
    card = policy.card
    assert [register.kind for register in card.fspa.registers] == ["last", "time_holding", "times"]
    assert dict(card.shapes)["automaton"] == (len(automaton_entries(card.fspa)),) == (len(card.fspa.states) + 3,)
    write_policy(tmp_path / POLICY, policy)
    assert read_policy(tmp_path / POLICY).card == card


@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        ("<= 2", "<= 3", "the atom `times(there) > 3` is new"),
        ("gap / 0.3", "gap / 0.2", "the atom `there` means something else"),
        ("keep times(there) <= 2", "", "the register `times(there)` is gone"),
    ],
)
def test_a_policy_plays_no_spec_with_other_registers(
    learned: tuple[TrainingRun, list[TrainingReport]], old: str, new: str, text: str
) -> None:
    card = read_policy(learned[0].folder / POLICY).card
    level = GAME.load_level("line")
    check_policy(card, level, load_task(SPEC_WITH_MEMORY).fspa)
    assert old in SPEC_WITH_MEMORY
    with pytest.raises(TltlError) as caught:
        check_policy(card, level, load_task(SPEC_WITH_MEMORY.replace(old, new)).fspa)
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == "TLT0843"
    assert text in diagnostic.title
