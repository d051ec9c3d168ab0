"""Texts of the labels of an automaton."""

from __future__ import annotations

from tests.calls import calls
from tltlc import compile_text
from tltlc.automaton.text import label_text


def test_the_text_of_a_label_is_made_once() -> None:
    (fspa,) = compile_text("signal a: bool\nsignal b: bool\nspec s = F(a & X F b) & G(a -> F b)")
    first = label_text(fspa, 0)
    assert calls(lambda: label_text(fspa, 0)) < 20
    assert label_text(fspa, 0) == first
