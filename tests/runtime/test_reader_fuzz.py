"""Readers of the runtime accept a damaged file or reject it with a TltlError, and raise nothing else."""

from __future__ import annotations

import json
import shutil
from copy import deepcopy
from functools import cache
from io import BytesIO
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import Any, Final
from xml.etree import ElementTree

import numpy as np
import pytest
import torch
from hypothesis import given

from tests.fuzzing import SEEDS, check, json_text, mutated_bytes, mutated_json, mutated_text, times
from tests.interfaces.cli.conftest import ROOT
from tests.runtime.gymnasium_games import vault
from tests.runtime.gymnasium_games.games import GAME, GRID
from tests.runtime.gymnasium_games.games import write as write_game
from tests.runtime.gymnasium_games.vault_episodes import played
from tests.runtime.policies.spaces.space_policies import policy_of_spaces
from tests.runtime.policies.spaces.test_space_policy import GRID as GRID_SPACES
from tests.runtime.policies.spaces.test_space_policy import MIXED
from tests.runtime.training.runs import run_in
from tltl_runtime.game.recording_check import check as check_episode
from tltl_runtime.game.recording_summary import summary as episode_summary
from tltl_runtime.game.recording_summary import summary_text as episode_summary_text
from tltl_runtime.game.registry import GYMNASIUM, STEALTH, game_named
from tltl_runtime.game.trace import monitor_command, trace_csv
from tltl_runtime.gymnasium_games.game_file import GameFile, read_game_file
from tltl_runtime.gymnasium_games.scene_episode_file import scene_episode_bytes
from tltl_runtime.gymnasium_games.scene_hash import scene_hash
from tltl_runtime.policies.file import from_bytes as policy_from_bytes
from tltl_runtime.policies.file import read_policy
from tltl_runtime.policies.file import to_bytes as policy_to_bytes
from tltl_runtime.policies.policy import Policy
from tltl_runtime.policies.shipped import shipped_policy
from tltl_runtime.policies.summary import summary as policy_summary
from tltl_runtime.policies.summary import summary_text as policy_summary_text
from tltl_runtime.regression.explain.explained_episode import ExplainedEpisode
from tltl_runtime.regression.suite.result_cache import read_cache
from tltl_runtime.regression.suite.suite import read_suite
from tltl_runtime.regression.verdict.baseline import read_baseline
from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.episode_recorder import RecordEpisode
from tltl_runtime.stealth.levels.file import read_level
from tltl_runtime.stealth.recordings.file import to_bytes as episode_to_bytes
from tltl_runtime.training.exploration.search import SearchProgress
from tltl_runtime.training.files.checkpoint import BestPolicy, Checkpoint, read_checkpoint, write_checkpoint
from tltl_runtime.training.files.metrics import METRICS, read_metrics, truncate
from tltl_runtime.training.files.record import finished_record, record_so_far, recorded_end
from tltl_runtime.training.files.run_file import CHECKPOINT, RECORD, RUN, identity, read_run, write_run
from tltl_runtime.training.files.settings import read_settings
from tltl_runtime.training.ppo.recent_episodes import RecentEpisodes

KINDS: Final = ("stealth", "scene")
FOLDER: Final = ROOT / "runtime" / "tltl_runtime"
SUITE: Final = """\
seed = 3
error = 0.05
episodes = 100

[thresholds]
pass_rate = 0.8
fail_rate = 0.4
progress = 0.1

[[case]]
level = "navigation"
variant = "v1"

[[case]]
name = "other"
level = "cover_and_hide"
reference = "v0"
episodes = 50
policy = "navigation"

[case.thresholds]
reward = 0.2
"""
MEASURED: Final[dict[str, Any]] = {
    "iteration": 1,
    "steps": 64,
    "seconds": 1.5,
    "steps_per_s": 40.0,
    "collect_s": 1.0,
    "learn_s": 0.5,
    "episodes": 4,
    "window": 4,
    "pass_rate": 0.5,
    "progress": 0.6,
    "reward": 0.1,
    "episode_steps": 30.0,
    "confirmation": None,
    "states": [],
    "losses": {"value": 0.5, "cloning": 1.0},
}


@pytest.fixture(name="folder", scope="module")
def _folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("read")


# --- TOML -----------------------------------------------------------------------------------------


@pytest.fixture(name="levels", scope="module")
def _levels(folder: Path) -> Path:
    """A copy of the shipped levels, with their assets and overlays."""
    shutil.copytree(FOLDER / "levels", folder / "levels")
    return folder / "levels"


@given(seed=SEEDS)
@times(40)
def test_a_damaged_level_file_is_read_or_rejected(seed: int, levels: Path) -> None:
    random = Random(seed)
    own = sorted(levels.glob("*.toml"))
    path = random.choice(own if random.random() < 0.6 else sorted(levels.rglob("*.toml")))
    level = path if path in own else random.choice(own)
    text = path.read_text(encoding="utf-8")
    try:
        path.write_text(mutated_text(random, text), encoding="utf-8", errors="replace")
        check(lambda: read_level(str(level), random.choice(("v0", "v1", "v2"))))
    finally:
        path.write_text(text, encoding="utf-8")


@given(seed=SEEDS)
@times(100)
def test_a_damaged_suite_is_read_or_rejected(seed: int, folder: Path) -> None:
    path = folder / "suite.toml"
    path.write_text(mutated_text(Random(seed), SUITE), encoding="utf-8", errors="replace")
    check(lambda: read_suite(path))


@given(seed=SEEDS)
@times(200)
def test_a_damaged_game_file_is_read_or_rejected(seed: int, folder: Path) -> None:
    random, path = Random(seed), write_game(folder)
    path.write_text(mutated_text(random, GAME), encoding="utf-8", errors="replace")
    for allow_outside in (False, True):
        check(lambda allow_outside=allow_outside: scene_hashes(read_game_file(path, allow_outside=allow_outside)))  # type: ignore[misc]


def scene_hashes(game: GameFile) -> list[str]:
    return [scene_hash(game, scene.name, variant) for scene in game.scenes for variant in scene.variants]


@given(seed=SEEDS)
@times(60)
def test_the_damaged_python_files_of_a_game_are_hashed(seed: int, folder: Path) -> None:
    path = write_game(folder)
    (folder / "corridor.py").write_bytes(mutated_bytes(Random(seed), GRID.encode()))
    check(lambda: scene_hashes(read_game_file(path)))


@given(seed=SEEDS)
@times(100)
def test_a_damaged_file_of_settings_is_read_or_rejected(seed: int, folder: Path) -> None:
    path = folder / "settings.toml"
    text = (FOLDER / "training" / "files" / "settings.toml").read_text(encoding="utf-8")
    path.write_text(mutated_text(Random(seed), text), encoding="utf-8", errors="replace")
    check(lambda: read_settings(path))


# --- recordings and policies ----------------------------------------------------------------------


@cache
def _arrays(kind: str = "stealth") -> dict[str, np.ndarray[Any, Any]]:
    """The arrays of a recording of the stealth game, or of the ``scene`` of a game file."""
    data = _stealth_recording() if kind == "stealth" else _scene_recording()
    with np.load(BytesIO(data)) as archive:
        return {name: archive[name] for name in archive.files}


def _scene_recording() -> bytes:
    with TemporaryDirectory() as folder:
        return scene_episode_bytes(played(vault.write(Path(folder)), scene="tiled"))


def _stealth_recording() -> bytes:
    env = RecordEpisode(make_env("cover_and_hide"), "dice")
    env.reset(seed=7)
    for _ in range(12):
        env.step([1, 1, 0, 0, 0])
    data = episode_to_bytes(env.episode)
    env.close()
    return data


def _read_recording(data: bytes, kind: str) -> None:
    """Read a recording and produce all that `tltlc replay` prints without simulating it again."""
    game = game_named(STEALTH if kind == "stealth" else GYMNASIUM)

    def read() -> None:
        episode = game.episode_from_bytes(data, "it.episode.npz")
        summary = episode_summary(episode)
        episode_summary_text(summary, game.figures(episode))
        trace_csv(episode)
        monitor_command(episode, "it.csv")
        check_episode(episode)
        if game.maps is not None and episode.level.bounds is not None and episode.positions is not None:
            level = game.played_level(episode.level, [episode])
            ElementTree.fromstring(game.maps.picture(level))
            json.dumps([game.maps.map_data(level), game.maps.episode_data(level, 0, episode)], allow_nan=False)

    check(read)


def _packed(arrays: dict[str, np.ndarray[Any, Any]]) -> bytes:
    data = BytesIO()
    np.savez(data, **arrays)  # type: ignore[arg-type] # savez accepts any array
    return data.getvalue()


@given(seed=SEEDS)
@times(100)
def test_a_recording_with_damaged_bytes_is_read_or_rejected(seed: int) -> None:
    kind = KINDS[seed % len(KINDS)]
    _read_recording(mutated_bytes(Random(seed), _packed(_arrays(kind))), kind)


@given(seed=SEEDS)
@times(60)
def test_a_recording_with_a_damaged_text_is_read_or_rejected(seed: int) -> None:
    random, kind = Random(seed), KINDS[seed % len(KINDS)]
    arrays = dict(_arrays(kind))
    name = random.choice(("meta", "meta", "artefact"))
    document = json.loads(arrays[name].tobytes())
    text = mutated_json(random, document).encode("utf-8", "surrogatepass")
    _read_recording(_packed({**arrays, name: np.frombuffer(text, np.uint8)}), kind)


@given(seed=SEEDS)
@times(60)
def test_a_recording_with_another_array_is_read_or_rejected(seed: int) -> None:
    random, kind = Random(seed), KINDS[seed % len(KINDS)]
    arrays = dict(_arrays(kind))
    name = random.choice(list(arrays))
    changed = _other_array(random, arrays[name].copy())
    _read_recording(_packed({**arrays, name: changed}), kind)


def _other_array(random: Random, array: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Return an array of another type or shape, or with one value changed."""
    change = random.randrange(6)
    if change == 0:
        return array.astype(random.choice(("f8", "f4", "i8", "u1", "U5", "c16", "?")))
    if change == 1:
        return array[: random.randrange(len(array) + 1)]
    if change == 2:
        return random.choice((array.reshape(-1), np.zeros(0, array.dtype), np.array(5), array[None]))
    if array.size:
        floats = (np.nan, np.inf, -np.inf, 1e308, -1e308, -0.0)
        array.flat[random.randrange(array.size)] = random.choice(floats if array.dtype.kind == "f" else (0, 1, 127))
    return array


@cache
def _policy(of_spaces: bool) -> tuple[dict[str, Any], str, dict[str, Any], bytes]:
    """The header of a policy file, the key of its card, the card, and the rest of the file.

    With ``of_spaces``, it is the policy of another game than the stealth game.
    """
    path = shipped_policy("cover_and_hide")
    assert path is not None
    data = policy_to_bytes(policy_of_spaces(GRID_SPACES, MIXED)) if of_spaces else path.read_bytes()
    end = 8 + int.from_bytes(data[:8], "little")
    header = json.loads(data[8:end])
    (key,) = header["__metadata__"]
    return header, key, json.loads(header["__metadata__"][key]), data[end:]


def _read_policy(header: bytes, rest: bytes) -> None:
    """Read a policy and produce all that `tltlc inspect` prints."""
    data = len(header).to_bytes(8, "little") + header + rest
    check(lambda: policy_summary_text(policy_summary(policy_from_bytes(data, "it.safetensors"))))


@given(seed=SEEDS)
@times(60)
def test_a_policy_with_damaged_bytes_is_read_or_rejected(seed: int) -> None:
    random, (header, _, _, rest) = Random(seed), _policy(seed % 2 == 1)
    text = json.dumps(header).encode()
    if random.random() < 0.7:
        _read_policy(mutated_bytes(random, text), rest)
    else:
        _read_policy(text, mutated_bytes(random, rest))


@given(seed=SEEDS)
@times(60)
def test_a_policy_with_a_damaged_header_is_read_or_rejected(seed: int) -> None:
    random, (header, key, card, rest) = Random(seed), _policy(seed % 2 == 1)
    if random.random() < 0.7:
        text = json.dumps({**header, "__metadata__": {key: mutated_json(random, card)}})
    else:
        text = mutated_json(random, header)
    _read_policy(text.encode("utf-8", "surrogatepass"), rest)


# --- trainings ------------------------------------------------------------------------------------


def _summarize_training(training: dict[str, Any]) -> None:
    """Produce what `tltlc inspect` prints for a training in a folder."""
    path = shipped_policy("cover_and_hide")
    assert path is not None
    summary = policy_summary(_shipped(path))
    policy_summary_text({**summary, "training": training})


@cache
def _shipped(path: Path) -> Policy:
    return read_policy(path)


@pytest.fixture(name="training", scope="module")
def _training(folder: Path) -> Path:
    """The folder of a training that has started."""
    write_run(run_in(folder / "training"))
    return folder / "training"


@given(seed=SEEDS)
@times(100)
def test_a_damaged_run_file_is_read_or_rejected(seed: int, folder: Path, training: Path) -> None:
    document = json.loads((training / RUN).read_text(encoding="utf-8"))
    run_folder = folder / "run"
    run_folder.mkdir(exist_ok=True)
    (run_folder / RUN).write_bytes(mutated_json(Random(seed), document).encode("utf-8", "surrogatepass"))
    check(lambda: identity(read_run(run_folder)))


@given(seed=SEEDS)
@times(100)
def test_damaged_metrics_are_read_or_rejected(seed: int, training: Path) -> None:
    random, path = Random(seed), training / METRICS
    lines = [json_text(MEASURED), mutated_json(random, MEASURED).replace("\n", " "), mutated_json(random, MEASURED)]
    path.write_bytes("\n".join(lines).encode("utf-8", "surrogatepass"))

    def read() -> None:
        rows = read_metrics(path)
        record = record_so_far(training)
        # The values of a row have the types that the record and its learning curve need.
        assert all(isinstance(row["seconds"], (int, float)) and isinstance(row["losses"], dict) for row in rows)
        _summarize_training(record)
        truncate(path, 5)

    try:
        check(read)
    finally:
        path.unlink()


@pytest.mark.slow
@given(seed=SEEDS)
@times(100)
def test_a_damaged_record_of_a_training_is_read_or_rejected(seed: int, training: Path) -> None:
    run, path = run_in(training), training / RECORD
    document = {"end": "steps", "steps": 100, "seconds": 3.5, "settings": {"stop": {}}}
    path.write_bytes(mutated_json(Random(seed), document).encode("utf-8", "surrogatepass"))
    check(lambda: (finished_record(run), recorded_end(training)))


@pytest.fixture(name="content", scope="module")
def _content(folder: Path) -> tuple[bytes, dict[str, Any]]:
    """A checkpoint as bytes, and its content."""
    path = folder / CHECKPOINT
    weights = {"weight": torch.zeros(3)}
    checkpoint = Checkpoint(
        run={"level": "0"},
        iteration=3,
        losses={"value": 0.5},
        steps=192,
        seconds=1.5,
        replayed=7,
        searched=SearchProgress(10, 7, 0.5, 4, (8, 9), complete=True),
        algorithm={"actor_state_dict": weights},
        processes=({"cpu": torch.get_rng_state()},),
        window=((True, 1.0, 30, 2, False),),
        unbroken=0,
        best=BestPolicy((0.5, 1.0, -2.0), weights, 64),
        met=False,
        standstill=(0.5, 128),
    )
    write_checkpoint(path, checkpoint)
    return path.read_bytes(), torch.load(path, weights_only=True)


def _read_checkpoint(path: Path) -> None:
    """Read a checkpoint, and the record of its training."""

    def read() -> None:
        run = run_in(path.parent)
        checkpoint = read_checkpoint(path)
        assert checkpoint is not None
        assert isinstance(checkpoint.weights, dict)
        checkpoint.reason(run.settings.stop)
        windows = RecentEpisodes(2, 4, 100)
        windows.load(checkpoint.window, checkpoint.unbroken)
        assert windows.window.count <= 8
        _summarize_training(record_so_far(path.parent))

    check(read)
    check(lambda: read_checkpoint(path, {"level": "1"}))


@given(seed=SEEDS)
@times(60)
def test_a_checkpoint_with_damaged_bytes_is_read_or_rejected(
    seed: int, training: Path, content: tuple[bytes, dict[str, Any]]
) -> None:
    path = training / CHECKPOINT
    path.write_bytes(mutated_bytes(Random(seed), content[0]))
    _read_checkpoint(path)
    path.unlink()


STRANGE: Final = (
    *(1e308, -0.0, 10**400, 2**63, -1, float("nan"), float("inf"), True, None, "", "text", [], {}, (), (1, 2)),
    *({"a": {}}, torch.zeros(2), torch.tensor(float("nan"))),
)


def _other_value(random: Random, value: Any) -> Any:
    """Return the value with one nested value replaced by an unusual one, or removed."""
    if isinstance(value, dict) and value and random.random() < 0.85:
        changed, key = dict(value), random.choice(list(value))
        if random.random() < 0.15:
            del changed[key]
        else:
            changed[key] = _other_value(random, value[key])
        return changed
    if isinstance(value, (list, tuple)) and value and random.random() < 0.8:
        index = random.randrange(len(value))
        return type(value)(
            _other_value(random, item) if position == index else item for position, item in enumerate(value)
        )
    return deepcopy(random.choice(STRANGE))


@pytest.mark.slow
@given(seed=SEEDS)
@times(60)
def test_a_checkpoint_with_unusual_values_is_read_or_rejected(
    seed: int, training: Path, content: tuple[bytes, dict[str, Any]]
) -> None:
    path = training / CHECKPOINT
    torch.save(_other_value(Random(seed), content[1]), path)
    _read_checkpoint(path)
    path.unlink()


# --- regression -----------------------------------------------------------------------------------


@cache
def _baseline() -> dict[str, Any]:
    """The shipped baseline, reduced to two references with two episodes each."""
    baseline: dict[str, Any] = json.loads(
        (FOLDER / "regression" / "suite" / "shipped" / "suite.baseline.json").read_text("utf-8")
    )
    baseline["references"] = [
        {**reference, "accounts": reference["accounts"][:2]} for reference in baseline["references"][:2]
    ]
    return baseline


@given(seed=SEEDS)
@times(60)
def test_a_damaged_baseline_is_read_or_rejected(seed: int, folder: Path) -> None:
    path = folder / "it.baseline.json"
    path.write_bytes(mutated_json(Random(seed), _baseline()).encode("utf-8", "surrogatepass"))
    check(lambda: read_baseline(path))


@given(seed=SEEDS)
@times(60)
def test_a_damaged_cached_result_is_read_or_rejected(seed: int, folder: Path) -> None:
    path, explained = folder / "kept.json", _baseline()["references"][0]["accounts"][0]
    document = {"identity": "it", "content": explained}
    path.write_bytes(mutated_json(Random(seed), document).encode("utf-8", "surrogatepass"))
    assert check(lambda: read_cache(ExplainedEpisode, path, "it"))
