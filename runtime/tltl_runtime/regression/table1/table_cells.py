"""The cells of our Table I: a model plays 100 episodes of a level in a variant.

The results are cached in a folder.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Generator, Iterator, Sequence
from functools import partial
from hashlib import sha256
from pathlib import Path
from typing import Final

from tltl_runtime.evaluation.evaluate import Pool, evaluate, local_results
from tltl_runtime.evaluation.play import episode_seed
from tltl_runtime.evaluation.player import EpisodeRequest, PlayedEpisode
from tltl_runtime.evaluation.statistics import spread_of
from tltl_runtime.game.level import default_spec
from tltl_runtime.game.registry import game_of
from tltl_runtime.policies.identity import spec_hash
from tltl_runtime.regression.suite.result_cache import cache_text, inputs_hash, read_cache
from tltl_runtime.regression.table1.paper_table import CellFigures, Model
from tltl_runtime.spec.episode_summary import EpisodeSummary
from tltl_runtime.spec.task import load_task
from tltl_runtime.training.files.versions import versions
from tltlc.api import fileio

EPISODES: Final = 100
SEED: Final = 25_000
"""The seed of the evaluations.

It is unlikely that a training played episodes with the same seeds.
"""


def figures(episodes: Sequence[EpisodeSummary], runs: int) -> CellFigures:
    """Return the statistics of a table's cell over the first ``runs`` of its episodes."""
    first = episodes[:runs]
    return CellFigures(
        runs=len(first),
        pass_rate=sum(episode.success for episode in first) / len(first),
        progress=spread_of([episode.progress for episode in first]),
        reward=spread_of([episode.reward for episode in first]),
    )


def cell_episodes(
    folder: Path, model: Model, level: str, variant: str, policy: Path | None, pool: Pool
) -> tuple[EpisodeSummary, ...]:
    """Return the 100 episodes of a table's cell: cached in ``folder``, or played now and stored there.

    ``policy`` is the path of the policy that plays; if it is None, the level's scripted expert plays.
    ``model`` is only part of the name of the cache file. The current spec of the level judges the
    episodes.

    Raises:
        TltlError: errors from playing, among them TLT0843, the policy was trained for another spec;
            TLT0005, the file cannot be written.
    """
    path = folder / f"{level}-{variant}-{model}.json"
    inputs = _inputs(level, variant, policy)
    if (cached := read_cache(tuple[EpisodeSummary, ...], path, inputs)) is not None:
        return cached
    episodes = tuple(
        _policy_episodes(policy, level, variant, pool) if policy else _expert_episodes(level, variant, pool)
    )
    fileio.write_file(path, cache_text(inputs, episodes), over_inputs=True)
    return episodes


def _inputs(level: str, variant: str, policy: Path | None) -> str:
    """Return the hash of everything on which the episodes of a table's cell depend, for the cache."""
    game = game_of(level)
    loaded_level = game.load_level(level, variant)
    spec = load_task(default_spec(loaded_level), offered=game.params(loaded_level)).fspa
    player_hash = sha256(policy.read_bytes()).hexdigest() if policy else "expert"
    return inputs_hash([game.level_hash(loaded_level), spec_hash(spec), player_hash, EPISODES, SEED, versions()])


def _policy_episodes(policy: Path, level: str, variant: str, pool: Pool) -> Iterator[EpisodeSummary]:
    spec = default_spec(game_of(level).load_level(level, variant))
    yield from evaluate(policy, level, variant, episodes=EPISODES, seed=SEED, workers=pool, spec=spec)


def _expert_episodes(level: str, variant: str, pool: Pool) -> Generator[EpisodeSummary]:
    """Play the scripted expert's episodes on this machine, with the same seeds as the policies."""
    requests = [EpisodeRequest(index) for index in range(EPISODES)]
    workers = 0 if pool == "ray" else pool

    def replay_command(request: EpisodeRequest) -> str:
        return f"tltlc demonstrate {level}:{variant} --seed {episode_seed(SEED, request.index)}"

    make, modules = partial(_ExpertPlayer, level, variant), game_of(level).modules
    for result in local_results(make, requests, workers, SEED, replay_command, modules=modules):
        yield result.summary


class _ExpertPlayer:
    """Plays episodes with the scripted expert, as a worker of an evaluation.

    For policies, there is :class:`~tltl_runtime.evaluation.player.PolicyPlayer`.
    """

    def __init__(self, level: str, variant: str) -> None:
        self._game = game_of(level)
        self._env = self._game.recorder(self._game.make_env(level, variant))
        self._seeds: deque[int] = deque()
        """The seeds of the next episodes. :meth:`play` appends one, and the expert takes it.

        One expert plays all episodes, so that it can reuse what it has computed about the level.
        """
        self._episodes = self._game.expert_episodes(self._env, iter(self._seeds.popleft, None))

    def play(self, request: EpisodeRequest) -> PlayedEpisode:
        """Play the requested episode and return it, without a recording."""
        self._seeds.append(episode_seed(SEED, request.index))
        return PlayedEpisode(request, self._game.summary(next(self._episodes), request.index))

    def close(self) -> None:
        """Close the environment in which the expert plays."""
        self._env.close()
