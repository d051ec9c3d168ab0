"""The names of cases in addresses and folders."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from tltl_runtime.regression.suite.slugs import episode_link, slugs


def test_slugs_are_readable() -> None:
    assert slugs(["navigation:v1", "Navigation:V1", "a b/c:v0+alert", "a b c:v0+alert", "…", "</script>"]) == (
        "navigation-v1",
        "Navigation-V1-2",
        "a-b-c-v0+alert",
        "a-b-c-v0+alert-2",
        "case",
        "script",
    )


def test_long_names_are_truncated() -> None:
    assert [len(name) for name in slugs(["a" * 500, "a" * 501])] == [80, 82]


def test_slugs_are_no_device_names_and_do_not_end_in_dots() -> None:
    names = ["CON", "nul", "Com1.v0", "console", "aux:v0", "..", "room.", ".room"]
    assert slugs(names) == ("case-CON", "case-nul", "case-Com1.v0", "console", "aux-v0", "case", "room", "room-2")


@given(st.lists(st.text(max_size=4), max_size=6))
def test_slugs_are_unique_and_have_no_special_characters(names: list[str]) -> None:
    slugs_of_names = slugs(names)
    assert len({name.lower() for name in slugs_of_names}) == len(names)
    assert all(name and not set(name) & set("/#<>\"'& ") for name in slugs_of_names)


def test_a_link_contains_the_episode_and_the_step() -> None:
    assert episode_link("navigation-v1", 12, 40) == "#navigation-v1/12/40"
