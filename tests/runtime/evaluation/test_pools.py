"""Episodes are the same in this process, in worker processes, and on a Ray cluster; lost workers are reported."""

from __future__ import annotations

import pickle
import re
from collections.abc import Iterator
from concurrent.futures import Future
from contextlib import closing
from functools import partial
from multiprocessing import active_children
from typing import Any, get_args

import pytest

from tests.runtime.evaluation.deadly import Deadly, kill_this_process
from tests.runtime.evaluation.untrained import untrained
from tests.runtime.own_cluster import CORES, needs_ray, own_cluster
from tests.waiting import HANG_S, until
from tltl_runtime.evaluation import ray_pool
from tltl_runtime.evaluation.evaluate import Pool, evaluate, local_results, results, set_up
from tltl_runtime.evaluation.play import episode_seed
from tltl_runtime.evaluation.player import EpisodeRequest, PlayedEpisode, PolicyPlayer, RecordMode, Setup
from tltl_runtime.evaluation.scheduler import WorkerLostError, play_all
from tltl_runtime.evaluation.worker_process import WorkerProcess
from tltl_runtime.game.level_name import Variant
from tltl_runtime.policies.policy import Policy
from tltl_runtime.spec.episode_summary import EpisodeSummary
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.recordings.file import from_bytes
from tltl_runtime.stealth.world.physics import WorldError
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError

EPISODES = 8
V0 = Variant("v0")

CHANCE = "import stealth\nspec chance { level cover_and_hide\n limit 2 steps\n avoid sneaking }\n"
"""A spec that an untrained policy meets in some episodes, but not in all."""

POOLS = [2, pytest.param("ray", marks=[needs_ray, pytest.mark.slow])]


@pytest.fixture(scope="module")
def policy() -> Policy:
    return untrained()


@pytest.fixture(scope="module")
def expected(policy: Policy) -> list[EpisodeSummary]:
    return list(evaluate(policy, episodes=EPISODES, seed=3))


@pytest.fixture(scope="module")
def ray_here() -> Iterator[None]:
    """A Ray cluster for the tests of this module that need one."""
    with own_cluster():
        yield


@pytest.fixture(autouse=True)
def _ray_where_it_is_asked_for(request: pytest.FixtureRequest) -> None:
    """Before each test with Ray, wait until all cores are free: Ray frees the core of a killed actor with a delay."""
    if "ray" not in (request.node.callspec.params.values() if hasattr(request.node, "callspec") else ()):
        return
    request.getfixturevalue("ray_here")
    all_cores_are_free()


def all_cores_are_free() -> None:
    import ray

    until(lambda: ray.available_resources().get("CPU", 0) == CORES, "cores that are all free")


@pytest.mark.parametrize("workers", POOLS)
def test_every_pool_plays_the_same_episodes(policy: Policy, expected: list[EpisodeSummary], workers: Pool) -> None:
    assert list(evaluate(policy, episodes=EPISODES, seed=3, workers=workers)) == expected


def test_an_episode_does_not_depend_on_the_number_of_episodes(policy: Policy, expected: list[EpisodeSummary]) -> None:
    single_results = results(set_up(policy, None, None, None, 3), [EpisodeRequest(7)])
    assert [result.summary for result in single_results] == [expected[7]]


def test_recordings_are_made_as_requested(policy: Policy, expected: list[EpisodeSummary]) -> None:
    requests = [EpisodeRequest(0), EpisodeRequest(1)]
    for recorded, expect_recording in (("all", True), ("failures", True), ("none", False)):
        for result in results(set_up(policy, None, None, None, 3, recorded), requests):  # type: ignore[arg-type]
            assert result.summary == expected[result.request.index]
            assert result.trajectory is not None
            assert result.trajectory.points.shape == (21, 2)
            assert bool(result.recording) is expect_recording
            if expect_recording:
                episode = from_bytes(result.recording, "it")
                chosen = "sampled" if result.request.sampled else "arg-max"
                assert episode.seed == result.summary.seed
                assert episode.player == f"policy, {chosen}, episode {result.request.index}"


@pytest.mark.parametrize("recorded", get_args(RecordMode))
def test_only_failures_are_recorded_if_requested(recorded: RecordMode) -> None:
    played_results = list(
        results(set_up(untrained(CHANCE), None, None, None, 3, recorded), [EpisodeRequest(index) for index in range(6)])
    )
    failed = [not result.summary.success for result in played_results]
    assert set(failed) == {True, False}
    expected_recordings = {"none": [False] * 6, "failures": failed, "all": [True] * 6}
    assert [bool(result.recording) for result in played_results] == expected_recordings[recorded]


def out_of_the_level() -> None:
    raise WorldError(load_level("navigation"), 3, "player", "it left")


@pytest.mark.parametrize("workers", POOLS)
def test_a_lost_worker_is_reported_with_its_seed(policy: Policy, workers: Pool) -> None:
    setup = Setup(Deadly(policy, kill_this_process), "cover_and_hide", V0, policy.card.fspa, 3, policy.card.params)  # type: ignore[arg-type]
    with pytest.raises(TltlError) as caught, closing(results(setup, [EpisodeRequest(6)], workers)) as playing:
        next(playing)
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == "TLT0850"
    assert f"episode 6 of seed 3, sampled (seed {episode_seed(3, 6)} of the level): " in diagnostic.title
    assert (
        diagnostic.help == "`tltlc evaluate` plays only that episode with `--seed 3 --first 6 --episodes 1 --workers 1`"
    )


@pytest.mark.parametrize("workers", [1, pytest.param("ray", marks=[needs_ray, pytest.mark.slow])])
def test_an_error_of_the_game_is_raised_unchanged(policy: Policy, workers: Pool) -> None:
    setup = Setup(Deadly(policy, out_of_the_level), "cover_and_hide", V0, policy.card.fspa, 3, policy.card.params)  # type: ignore[arg-type]
    with pytest.raises(WorldError, match="level navigation v0, step 3, player: it left") as caught:
        list(results(setup, [EpisodeRequest(0)], workers))
    assert caught.value.body == "player"


class Ends:
    """A player without a policy that kills its process."""

    def play(self, request: EpisodeRequest) -> PlayedEpisode:
        kill_this_process()
        raise AssertionError("it was killed")

    def close(self) -> None:
        pass


def test_a_lost_worker_is_reported_for_any_player() -> None:
    with pytest.raises(TltlError, match="TLT0850: a worker was lost while it played episode 0 of seed 3"):
        list(local_results(Ends, [EpisodeRequest(0)], 2, 3))


@pytest.mark.parametrize("workers", [1, *POOLS])
def test_an_error_at_the_start_of_a_worker_is_raised_unchanged(policy: Policy, workers: Pool) -> None:
    setup = Setup(policy, "nowhere", V0, policy.card.fspa, 3, policy.card.params)
    with pytest.raises(TltlError, match="there is no level `nowhere`"):
        list(results(setup, [EpisodeRequest(0)], workers))


def test_a_result_is_yielded_before_the_next_episode_starts(policy: Policy, monkeypatch: pytest.MonkeyPatch) -> None:
    began: list[EpisodeRequest] = []
    play = PolicyPlayer.play
    monkeypatch.setattr(PolicyPlayer, "play", lambda self, request: began.append(request) or play(self, request))
    with closing(results(set_up(policy, None, None, None, 3), [EpisodeRequest(0), EpisodeRequest(1)])) as played:
        assert next(played).request == EpisodeRequest(0)
        assert began == [EpisodeRequest(0)]


class Prompt:
    """A worker that is done at once; it is lost in episode 1, and never finishes episode 0."""

    def play(self, request: EpisodeRequest) -> Future[PlayedEpisode]:
        future: Future[PlayedEpisode] = Future()
        if request.index == 1:
            future.set_exception(WorkerLostError("gone"))
        elif request.index != 0:
            future.set_result(PlayedEpisode(request, None))  # type: ignore[arg-type]
        return future

    def close(self) -> None:
        pass


def test_finished_episodes_are_yielded_before_a_lost_worker_is_reported() -> None:
    requests = [EpisodeRequest(index) for index in (2, 0, 3, 1)]
    played: list[int] = []
    with pytest.raises(TltlError, match="episode 1 of seed 5"):
        played.extend(result.request.index for result in play_all([Prompt(), Prompt(), Prompt()], requests, 5))
    assert played == [2, 3]


def test_a_process_that_ended_between_episodes_is_reported_as_lost(policy: Policy) -> None:
    worker = WorkerProcess(partial(PolicyPlayer, set_up(policy, None, None, None, 3)))
    try:
        assert worker.play(EpisodeRequest(0)).result().request == EpisodeRequest(0)
        for child in active_children():
            child.kill()
            child.join()
        with pytest.raises(WorkerLostError, match="its process ended"):
            worker.play(EpisodeRequest(1)).result()
    finally:
        worker.close()


@pytest.fixture
def busy(ray_here: None) -> Iterator[Any]:
    """An actor that occupies all cores of the cluster."""
    import ray

    # A local class travels by value. For one of this module, the actor's process would import the module, with torch.
    class Busy:
        pass

    actor = ray.remote(num_cpus=CORES)(Busy).remote()
    ray.get(actor.__ray_ready__.remote())
    yield actor
    ray.kill(actor)


@needs_ray
@pytest.mark.slow
def test_a_cluster_without_free_cores_is_reported_after_waiting(
    policy: Policy, busy: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    setup = set_up(policy, None, None, None, 3)
    monkeypatch.setattr(ray_pool, "PATIENCE_S", 1.0)
    with pytest.raises(TltlError) as caught, ray_pool.ray_workers(setup, 2, lambda left: None):
        pass
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == "TLT0852"
    assert re.fullmatch(r"no worker started within 1 s on the Ray cluster, which has \d+ cores?", diagnostic.title)
    assert diagnostic.help is not None
    assert "--workers 0" in diagnostic.help


@needs_ray
@pytest.mark.slow
def test_a_core_that_becomes_free_is_used(
    policy: Policy, busy: Any, expected: list[EpisodeSummary], monkeypatch: pytest.MonkeyPatch
) -> None:
    import ray

    def waiting(left: float) -> None:
        remaining.append(left)
        ray.kill(busy)

    remaining: list[float] = []
    monkeypatch.setattr("tltl_runtime.vector.cluster._REPORT_INTERVAL_S", 0.5)
    played = results(set_up(policy, None, None, None, 3), [EpisodeRequest(0)], "ray", waiting)
    assert [result.summary for result in played] == [expected[0]]
    assert 0 < remaining[0] <= ray_pool.PATIENCE_S == HANG_S


def test_errors_can_be_pickled() -> None:
    error = TltlError([Diagnostic("TLT0850", "lost", help="look for it")])
    assert pickle.loads(pickle.dumps(error)).diagnostics == error.diagnostics


def test_a_negative_number_of_workers_is_rejected(policy: Policy) -> None:
    with pytest.raises(ValueError, match="at least 0, not -1"):
        list(evaluate(policy, episodes=1, seed=0, workers=-1))


def test_a_spec_without_a_limit_is_rejected() -> None:
    endless = untrained("import stealth\nspec endless { reach seen }")
    with pytest.raises(TltlError, match="TLT0851: `endless` has no limit"):
        list(evaluate(endless, episodes=1, seed=0))
