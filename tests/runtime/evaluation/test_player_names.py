"""The names of policies in recordings."""

from __future__ import annotations

import pytest

from tltl_runtime.evaluation.player import EpisodeRequest, PolicyPlayer, is_labelled_policy

PLAYER = PolicyPlayer(("room", "easy"), "0123456789abcdef")


def test_a_name_has_the_labels_the_hash_the_choice_and_the_episode() -> None:
    assert PLAYER.name(EpisodeRequest(3)) == "policy room easy 01234567, sampled, episode 3"
    assert PLAYER.name(EpisodeRequest(0, sampled=False)) == "policy room easy 01234567, arg-max, episode 0"
    assert PolicyPlayer().name(EpisodeRequest(3)) == "policy, sampled, episode 3"


@pytest.mark.parametrize("sampled", [True, False])
def test_a_policy_recognizes_its_names(sampled: bool) -> None:
    name = PLAYER.name(EpisodeRequest(3, sampled))
    assert PLAYER.is_named(name) and is_labelled_policy(name)
    assert PLAYER.is_named(PolicyPlayer(("a, b",), PLAYER.sha256).name(EpisodeRequest(3, sampled)))
    assert not PLAYER.is_named(PolicyPlayer(PLAYER.labels, "1" * 64).name(EpisodeRequest(3, sampled)))
    assert not is_labelled_policy(PolicyPlayer().name(EpisodeRequest(3, sampled)))
    assert not is_labelled_policy("expert")
