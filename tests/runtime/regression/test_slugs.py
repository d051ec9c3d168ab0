"""Names of cases in addresses."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from tltl_runtime.regression.suite.slugs import episode_link, slugs


def test_names_that_can_be_read() -> None:
    assert slugs(["navigation:v1", "Navigation:V1", "a b/c:v0+alert", "a b c:v0+alert", "…", "</script>"]) == (
        "navigation-v1",
        "Navigation-V1-2",
        "a-b-c-v0+alert",
        "a-b-c-v0+alert-2",
        "case",
        "script",
    )


def test_long_names_are_cut() -> None:
    assert [len(name) for name in slugs(["a" * 500, "a" * 501])] == [80, 82]


def test_no_folder_has_the_name_of_a_device_or_ends_in_a_dot() -> None:
    names = ["CON", "nul", "Com1.v0", "console", "aux:v0", "..", "room.", ".room"]
    assert slugs(names) == ("case-CON", "case-nul", "case-Com1.v0", "console", "aux-v0", "case", "room", "room-2")


@given(st.lists(st.text(max_size=4), max_size=6))
def test_no_two_are_equal_and_all_are_plain(names: list[str]) -> None:
    found = slugs(names)
    assert len({name.lower() for name in found}) == len(names)
    assert all(name and not set(name) & set("/#<>\"'& ") for name in found)


def test_a_link_names_episode_and_step() -> None:
    assert episode_link("navigation-v1", 12, 40) == "#navigation-v1/12/40"
