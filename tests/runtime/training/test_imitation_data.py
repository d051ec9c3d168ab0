"""The imitation data from recordings: the decisions with the observations before them."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np
import pytest
import torch

from tests.runtime.training.imitating import ALONG, SOON, recorded_episode, write_recordings
from tests.runtime.training.test_settings import compare
from tltl_runtime.stealth.env import make_env
from tltl_runtime.training.imitation.imitation_data import ImitationData, read_demonstrations
from tltlc.diagnostics.diagnostic import TltlError

make = partial(make_env, "cover_and_hide", "v0", SOON)


def read(folder: Path) -> ImitationData:
    return read_demonstrations(folder, make)


def test_each_decision_has_the_observation_before_it(tmp_path: Path) -> None:
    data = read(write_recordings(tmp_path, recorded_episode(1), recorded_episode(2, action=(0, 2, 0, 1, 0))))
    assert (data.summary.episodes, data.summary.decisions, data.summary.players) == (
        2,
        16,
        ("me",),
    )
    assert data.actions.tolist() == [list(map(float, ALONG))] * 8 + [[0.0, 2.0, 0.0, 1.0, 0.0]] * 8
    env = make()
    observation, _ = env.reset(seed=2)
    step_observations = [observation, *(env.step([0, 2, 0, 1, 0])[0] for _ in range(7))]
    env.close()
    assert set(data.observations.keys()) == set(observation)
    for key in observation:
        sensed = np.stack([step_observation[key] for step_observation in step_observations]).astype(np.float32)
        assert np.array_equal(data.observations[key][8:].numpy(), sensed), key


def test_recordings_that_do_not_fit_are_left_out_with_a_reason(tmp_path: Path) -> None:
    data = read(
        write_recordings(tmp_path, recorded_episode(1), recorded_episode(2, steps=7), recorded_episode(3, variant="v1"))
    )
    assert data.summary.episodes == 1
    assert data.summary.left_out == (
        "cover_and_hide-v0-2.episode.npz: it does not meet `soon`",
        "cover_and_hide-v1-3.episode.npz: it is of another level, `cover_and_hide:v1` as it was then",
    )


def test_unreadable_recordings_are_left_out_with_a_reason(tmp_path: Path) -> None:
    folder = write_recordings(tmp_path, recorded_episode(1))
    (folder / "damaged.episode.npz").write_bytes(b"PK, and no more")
    data = read(folder)
    assert data.summary.episodes == 1
    (left_out,) = data.summary.left_out
    assert left_out.startswith("damaged.episode.npz: TLT0820, ")


@pytest.mark.parametrize("name", ["TLT0921", "TLT0921_empty", "TLT0921_unfit"])
def test_a_folder_without_demonstrations_is_reported(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    folder = Path("mine")
    if name != "TLT0921":
        folder.mkdir()
    if name == "TLT0921_unfit":
        write_recordings(folder, recorded_episode(2, steps=7), recorded_episode(3, variant="v1"))
    with pytest.raises(TltlError) as caught:
        read(folder)
    compare(name, caught.value)


def test_decisions_are_sampled_with_the_generator_of_torch(tmp_path: Path) -> None:
    data = read(write_recordings(tmp_path, recorded_episode(1)))
    torch.manual_seed(1)
    first = data.sample(5)[0]["entities"], [actions for _, actions in data.shuffled_batches(3)]
    torch.manual_seed(1)
    second = data.sample(5)[0]["entities"], [actions for _, actions in data.shuffled_batches(3)]
    assert torch.equal(first[0], second[0])
    assert [len(batch) for batch in first[1]] == [3, 3, 2]
    entities = torch.cat([observations["entities"] for observations, _ in data.shuffled_batches(3)])
    assert sorted(entities.tolist()) == sorted(data.observations["entities"].tolist())
