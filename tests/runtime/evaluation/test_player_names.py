"""The names of policies in recordings."""

from __future__ import annotations

import pytest

from tltl_runtime.evaluation.player import EpisodeRequest, PlayerName, is_labelled_policy

PLAYER = PlayerName(("room", "easy"), "0123456789abcdef")


def test_a_name_has_the_labels_the_hash_the_choice_and_the_episode() -> None:
    assert PLAYER.text(EpisodeRequest(3)) == "policy room easy 01234567, sampled, episode 3"
    assert PLAYER.text(EpisodeRequest(0, sampled=False)) == "policy room easy 01234567, arg-max, episode 0"
    assert PlayerName().text(EpisodeRequest(3)) == "policy, sampled, episode 3"


@pytest.mark.parametrize("sampled", [True, False])
def test_a_policy_recognizes_its_names(sampled: bool) -> None:
    name = PLAYER.text(EpisodeRequest(3, sampled))
    assert PLAYER.is_of(name) and is_labelled_policy(name)
    assert PLAYER.is_of(PlayerName(("a, b",), PLAYER.sha256).text(EpisodeRequest(3, sampled)))
    assert not PLAYER.is_of(PlayerName(PLAYER.labels, "1" * 64).text(EpisodeRequest(3, sampled)))
    assert not is_labelled_policy(PlayerName().text(EpisodeRequest(3, sampled)))
    assert not is_labelled_policy("expert")
