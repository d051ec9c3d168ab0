"""Names with arguments."""

from __future__ import annotations

import pytest

from tltlc.core.names import full_name, split_name


@pytest.mark.parametrize(
    ("name", "base", "arguments"),
    [
        ("alive", "alive", ()),
        ("near(s1)", "near", ("s1",)),
        ("near(s1, close=3)", "near", ("s1", "close=3")),
        ("game.near(s1, close=(a + b)*2)", "game.near", ("s1", "close=(a + b)*2")),
        ("at(f(a, b), c)", "at", ("f(a, b)", "c")),
        ("distance(s1) > 3", "distance(s1) > 3", ()),
        ("near(s1) > far(s2)", "near(s1) > far(s2)", ()),
        ("(a + b)", "(a + b)", ()),
        ("near()", "near()", ()),
        ("near(a", "near(a", ()),
        ("", "", ()),
    ],
)
def test_a_name_is_split_into_its_base_and_arguments(name: str, base: str, arguments: tuple[str, ...]) -> None:
    assert split_name(name) == (base, arguments)
    assert full_name(base, arguments) == name
