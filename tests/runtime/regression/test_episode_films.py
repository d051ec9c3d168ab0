"""Films of recorded episodes for the page."""

from __future__ import annotations

from collections.abc import Mapping
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tests.runtime.gymnasium_games import games
from tltl_runtime.game.films import Picture
from tltl_runtime.gymnasium_games.gymnasium_game import GAME
from tltl_runtime.gymnasium_games.scene_episode import SceneEpisode
from tltl_runtime.regression.explain.explain import Finding
from tltl_runtime.regression.report.episode_films import (
    MOST_BYTES,
    MOST_FILMS,
    MOST_FRAMES,
    CaseFilms,
    episode_films,
    small_film,
)
from tltlc.api import replace

WAY = (0, 2, 2, 2, 1, 1, 1)
"""Actions that meet the spec in the short corridor."""


def frames_of(film: bytes) -> list[tuple[Picture, int]]:
    """Return the frames of a film, each with the milliseconds for which it is shown."""
    assert len(film) <= MOST_BYTES
    with Image.open(BytesIO(film)) as picture:
        assert picture.format == "WEBP"
        frames = []
        for number in range(getattr(picture, "n_frames", 1)):
            picture.seek(number)
            frames.append((np.asarray(picture.convert("RGB")), picture.info["duration"]))
        return frames


def recorded(game: Path, seed: int, actions: tuple[int, ...] = WAY, scene: str = "short") -> SceneEpisode:
    """Play a scene; return the episode as a file of it has it, which does not say where the game is."""
    spec = f"{game.parent}/corridor.tltl:fetch"
    with GAME.recorder(GAME.make_env(f"{game}:{scene}", spec=spec)) as env:
        env.reset(seed=seed)
        for action in actions:
            if any(env.step(action)[2:4]):
                break
        return GAME.episode_from_bytes(GAME.episode_bytes(env.episode), "test")


def films_of(
    game: Path, episodes: Mapping[int, SceneEpisode], findings: tuple[Finding, ...] = (), scene: str = "short"
) -> CaseFilms:
    return episode_films(GAME, (f"{game}:{scene}", "v0"), findings, episodes)


def test_a_film_shows_each_moment_of_an_episode(tmp_path: Path) -> None:
    game = games.write(tmp_path)
    episode = recorded(game, 3)
    films = films_of(game, {7: episode})
    assert films.notes == () and [*films.pictures] == [7]
    frames = frames_of(films.pictures[7])
    assert len(frames) == len(episode.actions) + 1
    assert {picture.shape for picture, _ in frames} == {(240, 320, 3)}
    assert [shown for _, shown in frames] == [100] * (len(frames) - 1) + [1500]
    # The player is white, and fills a fourth of the picture's width.
    cells = [int(picture[90:120].mean(axis=(0, 2)).argmax()) // 80 for picture, _ in frames]
    assert cells == [int(place) for place in _cells(episode)]


def _cells(episode: SceneEpisode) -> list[int]:
    cells = [int(np.random.Generator(np.random.PCG64(episode.seed)).integers(1, 3))]
    for action in episode.actions[:, 0].astype(int):
        cells.append(min(max(cells[-1] + (0, 1, -1)[action], 0), 3))
    return cells


def test_a_long_episode_has_a_few_of_its_moments(tmp_path: Path) -> None:
    endless = "clock 10 Hz\nsignal door_open: bool\nspec fetch { reach door_open }\n"
    game = games.write(tmp_path, corridor__tltl=endless)
    frames = frames_of(films_of(game, {0: recorded(game, 1, (1, 2) * 400, "long")}, scene="long").pictures[0])
    # Moments that look the same may be one frame.
    assert MOST_FRAMES // 2 <= len(frames) <= MOST_FRAMES
    assert sum(shown for _, shown in frames) >= 49_000


def test_examples_of_findings_come_first(tmp_path: Path) -> None:
    game = games.write(tmp_path)
    episode = recorded(game, 3)
    findings = (Finding("it fails", (30, 21, 20)), Finding("others", (99,)), Finding("it wins", (17, 16)))
    films = films_of(game, dict.fromkeys(range(22), episode), findings)
    assert [*films.pictures] == [0, 1, 2, 3, 17, 21] and len(films.pictures) == MOST_FILMS


def test_another_episode_has_no_film(tmp_path: Path) -> None:
    game = games.write(tmp_path)
    episode, signals = recorded(game, 3), recorded(game, 4).signals.copy()
    signals[2] = 1.0 - signals[2]
    films = films_of(game, {1: episode, 4: replace(recorded(game, 4), signals=signals)})
    assert [*films.pictures] == [1]
    assert films.notes == (
        "There is no film of episode 4: played again from seed 4, the episode is different at step 2.",
    )


def test_a_game_that_cannot_be_played_again_has_a_note(tmp_path: Path) -> None:
    game = games.write(tmp_path)
    episode = recorded(game, 3)
    broken = games.write(tmp_path / "broken", corridor__py=games.GRID.replace("picture[:, 8", "picture[:, :, :, 8"))
    films = films_of(broken, {1: episode, 2: episode})
    assert not films.pictures
    (note,) = films.notes
    assert note.startswith("There is no film of episodes 1, 2: the game's `render` raises IndexError: ")


@pytest.mark.parametrize(
    ("old", "new", "advice"),
    [
        ("return picture\n", "return None\n", "let `render()` return an array, height x width x 3, or "),
        (
            "length=5, render_mode=None):\n    return",
            "length=5):\n    render_mode = None\n    return",
            "give `corridor:make` an argument `render_mode`, ",
        ),
    ],
)
def test_a_game_without_pictures_has_no_films(tmp_path: Path, old: str, new: str, advice: str) -> None:
    assert old in games.GRID
    game = games.write(tmp_path, corridor__py=games.GRID.replace(old, new))
    films = films_of(game, {1: recorded(game, 3)})
    (note,) = films.notes
    assert not films.pictures and not films.may_change
    title = "the game of `short` renders no pictures (`render_mode` `rgb_array`)"
    assert note.startswith(f"There are no films: {title}. To see some, {advice}")


def test_films_are_equal_for_equal_episodes(tmp_path: Path) -> None:
    game = games.write(tmp_path)
    first, second = (films_of(game, {1: recorded(game, 3)}).pictures[1] for _ in range(2))
    assert first == second


@pytest.mark.slow
def test_a_large_film_loses_quality_and_then_frames() -> None:
    random = np.random.default_rng(5)
    noise = [random.integers(0, 256, (240, 320, 3), dtype=np.uint8) for _ in range(MOST_FRAMES)]
    frames = frames_of(small_film(noise, [0.1] * MOST_FRAMES))
    assert 1 < len(frames) < MOST_FRAMES
    shown = [duration for _, duration in frames]
    assert shown[-1] == 100 and {*shown[:-1]} == {round(100 * MOST_FRAMES / len(frames))}
    last, wanted = frames[-1][0].astype(float), noise[-1].astype(float)
    assert np.corrcoef(last.mean(2).ravel(), wanted.mean(2).ravel())[0, 1] > 0.2
