"""Episodes are read from their files exactly as written, and invalid files are rejected with clear messages."""

from __future__ import annotations

import json
import os
import random
import re
import struct
import zipfile
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tltl_runtime.game.level import LevelSpec, default_spec
from tltl_runtime.game.recording_check import check
from tltl_runtime.game.recording_path import SUFFIX
from tltl_runtime.stealth.env import make_env
from tltl_runtime.stealth.episode_recorder import RecordEpisode
from tltl_runtime.stealth.level import StealthLevel
from tltl_runtime.stealth.levels.file import level_names, load_level, variants
from tltl_runtime.stealth.recordings.arrays import ARRAYS
from tltl_runtime.stealth.recordings.episode import Episode
from tltl_runtime.stealth.recordings.file import from_bytes, read_episode, to_bytes, write_episode
from tltl_runtime.stealth.recordings.replay_check import check_replay, resimulate
from tltl_runtime.support.record_json import RecordJsonError, from_json, to_json
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.diagnostics.render import render

Change = Callable[[dict[str, Any], dict[str, Any]], None]
GOLDEN = Path(__file__).parents[3] / "golden" / "episode"
NUMBERS = ("actions", "signals", "atoms", "states", "progress", "rewards")


def play(level: str, variant: str = "v0", seed: int = 7, steps: int = 30) -> Episode:
    env = RecordEpisode(make_env(level, variant), player="dice")
    env.reset(seed=seed)
    rng = np.random.default_rng(seed)
    for _ in range(steps):
        env.step([int(rng.integers(size)) for size in (3, 3, 2, 2, 2)])
    episode = env.episode
    env.close()
    return episode


@pytest.fixture(name="episode", scope="module")
def _episode() -> Episode:
    return play("branching", "v1")


def assert_same(first_episode: Episode, second_episode: Episode) -> None:
    for name in NUMBERS:
        first, second = getattr(first_episode, name), getattr(second_episode, name)
        assert first.dtype == second.dtype and first.tobytes() == second.tobytes(), name
    other_fields = [name for name in Episode.__match_args__ if name not in (*NUMBERS, "level")]  # type: ignore[attr-defined]
    assert all(getattr(first_episode, name) == getattr(second_episode, name) for name in other_fields)
    assert repr(first_episode.snapshots) == repr(second_episode.snapshots)  # -0.0 is not 0.0
    assert replace(first_episode.level, spec=None) == replace(second_episode.level, spec=None)


@settings(max_examples=15, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    level=st.sampled_from(level_names()),
    variant=st.sampled_from(("v0", "v1", "v2")),
    seed=st.integers(0, 2**40),
    steps=st.integers(0, 25),
)
def test_a_restored_episode_is_judged_and_simulated_alike(level: str, variant: str, seed: int, steps: int) -> None:
    episode = play(level, variant, seed, steps)
    data = to_bytes(episode)
    restored = from_bytes(data, "it")
    assert_same(restored, episode)
    assert to_bytes(restored) == data
    assert check(restored) == ()
    assert resimulate(restored) is None


def test_a_file_is_written_whole(tmp_path: Path, episode: Episode) -> None:
    path = tmp_path / f"one{SUFFIX}"
    write_episode(path, episode)
    assert [file.name for file in tmp_path.iterdir()] == [path.name]
    assert_same(read_episode(path), episode)
    with pytest.raises(TltlError, match="TLT0005"):
        write_episode(tmp_path / "nowhere" / f"one{SUFFIX}", episode)
    with pytest.raises(TltlError, match="TLT0001"):
        read_episode(tmp_path / f"two{SUFFIX}")


def test_numpy_alone_reads_a_file_and_it_contains_no_local_paths(episode: Episode) -> None:
    data = to_bytes(episode)
    assert len(data) < 20_000
    with np.load(BytesIO(data), allow_pickle=False) as arrays:
        assert set(arrays) == {"meta", "artefact", *(array.name for array in ARRAYS)}
        meta = json.loads(bytes(arrays["meta"]))
        assert json.loads(bytes(arrays["artefact"]))["spec"]["name"] == "branching"
        assert arrays["position"][0].tolist() == list(episode.snapshots[0].player.position)
    assert (meta["format"], meta["version"], meta["player"]) == ("tltl-episode", 1, "dice")
    assert meta["level"]["spec"] == "branching.tltl:branching"
    assert meta["names"]["signals"] == [signal.name for signal in episode.fspa.signals]
    assert dict(meta["level"]["files"])["branching.toml"]


def test_finished_episodes_are_written_to_a_folder(tmp_path: Path) -> None:
    spec = "signal health: ratio  spec soon { limit 2 steps  reach health < 50 % }"
    env = RecordEpisode(make_env("navigation", spec=spec), folder=tmp_path / "runs")
    for _ in range(2):
        env.reset(seed=3)
        for _ in range(3):
            env.step([0, 0, 0, 0, 0])
    env.reset(seed=4)
    env.step([0, 0, 0, 0, 0])  # left before its end
    env.close()
    files = sorted((tmp_path / "runs").iterdir())
    assert [path.name for path in files] == [f"navigation-v0-3-2{SUFFIX}", f"navigation-v0-3{SUFFIX}"]
    assert all(read_episode(path).end == "limit" for path in files)


# --- changed recordings -----------------------------------------------------------------------------


def changed(episode: Episode, **fields: Any) -> Episode:
    return replace(episode, **fields)


def nudged(array: np.ndarray, index: tuple[int, ...], by: float) -> np.ndarray:
    copy = array.copy()
    copy[index] += by
    return copy


@pytest.mark.parametrize(
    ("change", "pattern"),
    [
        (lambda e: {"states": nudged(e.states, (9,), 1)}, "step 9 of the recording .*: the state was recorded as"),
        (lambda e: {"rewards": nudged(e.rewards, (4,), 1e-15)}, "step 5 .*the reward"),
        (lambda e: {"progress": nudged(e.progress, (6,), 1e-15)}, "step 6 .*the progress"),
        (lambda e: {"progress": nudged(e.progress, (0,), 0.1)}, "step 0 .*the start"),
        (lambda e: {"atoms": nudged(e.atoms, (2, 1), -1e-9)}, "step 3 .*`near"),
        (lambda e: {"signals": nudged(e.signals, (8, 0), 0.25)}, "step 8 .*`"),
        (lambda e: {"verdict": "violated"}, "step 30 .*the verdict"),
        (lambda e: {"success": True}, "step 30 .*success"),
        (lambda e: {"end": "limit"}, "step 30 .*the reward"),
        (lambda e: {"params": {"level_size": -1.0}}, "TLT0307"),
    ],
)
def test_a_changed_recording_is_detected(episode: Episode, change: Any, pattern: str) -> None:
    (diagnostic,) = check(changed(episode, **change(episode)))
    assert re.search(pattern, f"{diagnostic.code} {diagnostic.title}"), diagnostic.title
    assert diagnostic.code in ("TLT0823", "TLT0307")


def test_a_different_game_is_detected_at_the_first_step_that_differs(episode: Episode) -> None:
    actions = episode.actions.copy()
    actions[11] = (actions[11] + 1) % 2
    assert resimulate(changed(episode, actions=actions)) == 12
    assert resimulate(changed(episode, seed=episode.seed + 1)) == 0
    assert resimulate(changed(episode, signals=nudged(episode.signals, (5, 0), 1e-12))) == 5
    wall = episode.level.solids[1]
    far = replace(wall, box=replace(wall.box, low=(-100.0, -100.0, -100.0), high=(100.0, 100.0, 100.0)))
    assert resimulate(changed(episode, level=replace(episode.level, solids=(*episode.level.solids, far)))) == 0


# --- invalid files ----------------------------------------------------------------------------------


def packed(arrays: dict[str, Any]) -> bytes:
    stream = BytesIO()
    np.savez_compressed(stream, **arrays)
    return stream.getvalue()


def unpack(data: bytes) -> tuple[dict[str, Any], dict[str, Any]]:
    with np.load(BytesIO(data)) as archive:
        arrays = dict(archive)
    return arrays, json.loads(bytes(arrays["meta"]))


def rebuild(episode: Episode, change: Change) -> bytes:
    """Return the file of an episode after ``change(arrays, meta)``. Arrays that become None are left out."""
    arrays, meta = unpack(to_bytes(episode))
    arrays.pop("meta")
    change(arrays, meta)
    text = np.frombuffer(json.dumps(meta).encode(), dtype=np.uint8)
    return packed({"meta": text, **{name: array for name, array in arrays.items() if array is not None}})


def set_array(array: str, value: Any) -> Change:
    return lambda arrays, _: arrays.update({array: value(arrays[array]) if callable(value) else value})


def set_meta(key: str, value: Any) -> Change:
    return lambda _, meta: meta.update({key: value})


def with_first(value: float) -> Callable[[np.ndarray], np.ndarray]:
    def change(array: np.ndarray) -> np.ndarray:
        copy = array.copy()
        copy.reshape(-1)[0] = value
        return copy

    return change


def in_level(key: str, value: Any) -> Change:
    return lambda _, meta: meta["level"].update({key: value})


BROKEN: dict[str, Change] = {
    "missing": set_array("atoms", None),
    "dtype": set_array("rewards", lambda array: array.astype(np.float32)),
    "shape": set_array("enemy_yaw", lambda array: array[:, :1]),
    "rows": set_array("progress", lambda array: array[1:]),
    "actions": set_array("actions", np.uint8(3)),
    "action": set_array("actions", with_first(3)),
    "nan": set_array("signals", with_first(np.nan)),
    "range": set_array("atoms", with_first(1.5)),
    "state": set_array("states", with_first(99)),
    "mode": set_array("enemy_mode", with_first(9)),
    "bool": set_array("crouching", lambda array: array.view(np.uint8) + 2),
    "object": set_array("time", lambda array: array.astype("<c16")),
    "no_text": set_array("artefact", np.zeros(3)),
    "no_utf8": set_array("artefact", np.array([255, 254], dtype=np.uint8)),
    "end": set_meta("end", "tired"),
    "seed": set_meta("seed", -1),
    "seed_text": set_meta("seed", "7"),
    "success": set_meta("success", 1),
    "params": set_meta("params", {"level_size": "30 m"}),
    "key": set_meta("author", "me"),
    "names": lambda _, meta: meta["names"].update({"atoms": []}),
    "level": in_level("bounds", {"low": [0, 0, 0]}),
    "level_kind": lambda _, meta: meta["level"]["solids"][0].update({"kind": "lava"}),
    "level_list": in_level("solids", 3),
    "level_pair": in_level("files", [["a", "b", "c"]]),
    "level_flat": in_level("bounds", {"low": [0, 0, 0], "high": [9, 0, 3]}),
    "level_far": lambda _, meta: meta["level"]["exits"][0].update({"position": [1e6, 0, 0]}),
    "level_route": lambda _, meta: meta["level"]["enemies"][0].update({"route": []}),
    "level_branch": lambda _, meta: meta["level"]["enemies"][0]["kind"].update({"branches": ["fly"]}),
    "level_path": lambda _, meta: meta["level"]["movers"][0].update({"path": []}),
    "level_switch": lambda _, meta: meta["level"]["barriers"][0].update({"opened_by": ["s9"]}),
    "level_barrier": lambda _, meta: meta["level"]["unlocks"][0].update({"barriers": ["up"]}),
    "level_unlock": lambda _, meta: meta["level"]["unlocks"][0].update({"barriers": []}),
    "level_signal": in_level("signals", [["open_up", "open(up)"]]),
    "level_number": in_level("exits", [{"name": "exit", "position": [1e999, 0, 0]}]),
}


def error_text(data: bytes, name: str = "run.episode.npz") -> str:
    with pytest.raises(TltlError) as error:
        from_bytes(data, name)
    assert all(diagnostic.help for diagnostic in error.value.diagnostics)
    return render(error.value.diagnostics)


@pytest.mark.parametrize("name", BROKEN)
def test_inconsistent_files_are_rejected(episode: Episode, name: str) -> None:
    assert "error[TLT0822]: `run.episode.npz` is a broken episode: " in error_text(rebuild(episode, BROKEN[name]))


def bomb(unpacked: int) -> bytes:
    stream = BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive, archive.open("meta.npy", "w") as file:
        for _ in range(unpacked >> 20):
            file.write(bytes(1 << 20))
    return stream.getvalue()


def lying_bomb() -> bytes:
    """Return an archive that unpacks to more than it declares."""
    data = bytearray(bomb(64 << 20))
    directory = data.rindex(b"PK\x01\x02")
    data[directory + 24 : directory + 28] = struct.pack("<I", 1000)
    return bytes(data)


def packed_with_lzma(episode: Episode) -> bytes:
    stream = BytesIO()
    arrays, _ = unpack(to_bytes(episode))
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_LZMA) as archive:
        for name, array in arrays.items():
            file = BytesIO()
            np.save(file, array)
            archive.writestr(f"{name}.npy", file.getvalue())
    return stream.getvalue()


@pytest.mark.parametrize(
    "make",
    [
        lambda _: b"",
        lambda _: b"signals,atoms\n",
        lambda _: packed({"a": np.zeros(3)}),
        lambda episode: rebuild(episode, set_meta("format", "other")),
        lambda episode: to_bytes(episode)[:-40],
        lambda _: lying_bomb(),
        packed_with_lzma,
    ],
)
def test_files_that_are_not_episodes_are_rejected(episode: Episode, make: Callable[[Episode], bytes]) -> None:
    assert "error[TLT0820]: `run.episode.npz` cannot be read as an episode: " in error_text(make(episode))


def test_a_bomb_is_not_unpacked(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tltl_runtime.game.recording_archive.MAX_BYTES", 1 << 20)
    assert "it contains more than 1 MiB" in error_text(bomb(4 << 20))
    assert "it is larger than 1 MiB" in error_text(bytes(2 << 20))


@pytest.mark.parametrize("array", ["meta", "artefact"])
@pytest.mark.parametrize(
    "make", [lambda: b"[" + 10_000_001 * b"[]," + b"[]]", lambda: b" " * (130 << 20)], ids=["values", "bytes"]
)
def test_a_large_text_in_a_small_file_is_not_parsed(
    episode: Episode, array: str, make: Callable[[], bytes], monkeypatch: pytest.MonkeyPatch
) -> None:
    arrays, _ = unpack(to_bytes(episode))
    data = packed(arrays | {array: np.frombuffer(make(), dtype=np.uint8)})
    assert len(data) < 1 << 20
    parsed = []
    monkeypatch.setattr(json, "loads", lambda text, **_: parsed.append(len(text)) or {})
    monkeypatch.setattr("tltl_runtime.stealth.recordings.file._read_meta", meta_reader(episode, array))
    assert f"the array `{array}` contains more than" in error_text(data)
    assert not parsed


def meta_reader(episode: Episode, array: str) -> Any:
    """Return the reader of ``meta``, or a stand-in if the other array is tested."""
    from tltl_runtime.stealth.recordings import file

    return file._read_meta if array == "meta" else lambda members, name: file._meta(episode)


def test_objects_are_never_unpickled(episode: Episode) -> None:
    class Trap:
        def __reduce__(self) -> tuple[Any, ...]:
            return (os.abort, ())

    arrays, _ = unpack(to_bytes(episode))
    arrays["rewards"] = np.array([Trap()], dtype=object)
    assert "TLT0822" in error_text(packed(arrays))


@pytest.mark.parametrize("version", [0, 2, "1", None, True])
def test_another_version_is_rejected(episode: Episode, version: Any) -> None:
    assert "error[TLT0821]" in error_text(rebuild(episode, set_meta("version", version)))


def test_a_broken_artefact_gives_the_error_of_artefacts(episode: Episode) -> None:
    cut = set_array("artefact", lambda array: array[:-30])
    assert "error[TLT0601]: `run.episode.npz/artefact` is not JSON" in error_text(rebuild(episode, cut))


def test_damaged_files_are_rejected_or_read_unchanged(episode: Episode) -> None:
    data, rng = to_bytes(episode), random.Random(3)
    outcomes = set()
    for _ in range(250):
        damaged = bytearray(data)
        for _ in range(rng.choice((1, 1, 1, 4, 20))):
            # Half of the changes are in the archive's directory, in the last kilobytes.
            index = rng.randrange(len(data)) if rng.random() < 0.5 else rng.randrange(len(data) - 1600, len(data))
            damaged[index] ^= 1 << rng.randrange(8)
        if rng.random() < 0.3:
            damaged = damaged[: rng.randrange(len(data))]
        try:
            assert_same(from_bytes(bytes(damaged), "it"), episode)
            outcomes.add("harmless")
        except TltlError as error:
            outcomes |= {diagnostic.code for diagnostic in error.diagnostics}
    assert outcomes == {"harmless", "TLT0820", "TLT0822"}


def test_random_values_in_meta_are_read_or_rejected(episode: Episode) -> None:
    """JSON with randomly replaced values raises no exception but RecordJsonError."""
    rng = random.Random(5)
    strange = [None, True, -1, 1e300, 10**400, "", "x", [], {}, [[]], [1.0, 2.0, 3.0], {"low": []}]

    def mutated(value: Any) -> Any:
        if rng.random() < 0.02:
            return rng.choice(strange)
        if isinstance(value, dict):
            return {name: mutated(item) for name, item in value.items() if rng.random() > 0.003}
        return [mutated(item) for item in value] if isinstance(value, list) else value

    meta = unpack(to_bytes(episode))[1]
    refused_times = 0
    for _ in range(200):
        try:
            from_json(StealthLevel, mutated(meta["level"]), "level")
        except RecordJsonError as error:
            assert str(error).startswith("`level")
            refused_times += 1
    assert refused_times > 100


@pytest.mark.parametrize(("name", "variant"), [(name, variant) for name in level_names() for variant in variants(name)])
def test_a_level_is_equal_after_a_round_trip_through_json(name: str, variant: str) -> None:
    level = load_level(name, variant)
    document = json.loads(json.dumps(to_json(level)))
    assert document["spec"] == default_spec(level)
    assert from_json(StealthLevel, document, "level") == level


def test_the_spec_of_a_level_is_a_text_in_json_and_has_no_folder_in_a_recording(episode: Episode) -> None:
    assert from_bytes(to_bytes(episode), "episode.npz").level.spec == LevelSpec(Path("branching.tltl"), "branching")
    document = to_json(replace(episode.level, spec=None))
    assert document["spec"] == ""
    assert from_json(StealthLevel, document, "level").spec is None
    with pytest.raises(RecordJsonError, match=r"`level\.spec` is 1, but a text was expected"):
        from_json(StealthLevel, {**document, "spec": 1}, "level")


# --- messages ---------------------------------------------------------------------------------------

MESSAGES: dict[str, Callable[[Episode], str]] = {
    "TLT0820": lambda episode: error_text(to_bytes(episode)[:-40]),
    "TLT0821": lambda episode: error_text(rebuild(episode, set_meta("version", 2))),
    "TLT0822": lambda episode: error_text(rebuild(episode, BROKEN["nan"])),
    "TLT0822_level": lambda episode: error_text(rebuild(episode, BROKEN["level_kind"])),
    "TLT0824": lambda episode: render(check_replay(changed(episode, seed=8, versions={}))),
    "TLT0824_versions": lambda episode: render(check_replay(changed(episode, seed=8, versions={"numpy": "1.0"}))),
    "TLT0823": lambda episode: render(check(changed(episode, states=nudged(episode.states, (9,), 1)))),
}


@pytest.mark.parametrize("name", MESSAGES)
def test_an_invalid_recording_gives_the_expected_message(
    episode: Episode, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        "tltl_runtime.stealth.recordings.replay_check.versions", lambda: {**episode.versions, "numpy": "2.0"}
    )
    text, expected = MESSAGES[name](episode), GOLDEN / f"{name}.txt"
    if os.environ.get("UPDATE_GOLDEN") == "1":
        expected.write_text(text, encoding="utf-8")
    assert text == expected.read_text(encoding="utf-8")
