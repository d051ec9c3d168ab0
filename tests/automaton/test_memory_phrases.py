"""What atoms remember, in words: the words come from the kinds of registers, and never change what is meant."""

from __future__ import annotations

import pytest

from tltlc import compile_text
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.text import formula_text, label_text
from tltlc.backends import emit
from tltlc.core.source import SourceFile
from tltlc.pipeline import read_artefact

NAMES = (
    "clock 10 Hz\nentity e\nsignal seen: bool\nsignal alarm: bool\nsignal near(x: entity): bool\nsignal hp in [0, 9]\n"
)


def _fspa(clause: str) -> Fspa:
    (fspa,) = compile_text(f"{NAMES}spec s {{ {clause} }}")
    return fspa


@pytest.mark.parametrize(
    ("clause", "english"),
    [
        ("keep times(seen) <= 3", "Keep seen at most 3 times throughout."),
        ("avoid times(near(e)) >= 2", "Avoid near(e) at least twice throughout."),
        ("reach time_holding(near(e)) >= 3 s", "Reach near(e) for at least 3 s."),
        (
            "keep time_since(alarm) < 5 s implies not seen",
            "Whenever less than 5 s after alarm, avoid seen at that step.",
        ),
        ("keep once within 5 s alarm implies seen", "Whenever alarm in the last 5 s, have seen at that step."),
        (
            "keep seen implies historically for 20 steps alarm",
            "Whenever seen, have alarm for the last 2 s at that step.",
        ),
        ("keep begins seen implies alarm", "Whenever seen begins, have alarm at that step."),
        ("reach ends near(e) and alarm", "Reach near(e) ends and alarm."),
        # These keep their names: they are about larger formulas, or read more than one register.
        ("reach once seen", "Reach once seen."),
        ("keep times(seen and alarm) <= 3", "Avoid times(seen & alarm) > 3 throughout."),
        ("keep times(not seen) <= 3", "Avoid times(!seen) > 3 throughout."),
        ("keep hp >= previous(hp)", "Avoid previous(hp) > hp throughout."),
        ("keep times(seen, 9) + times(alarm, 9) <= 3", "Avoid times(seen, 9) + times(alarm, 9) > 3 throughout."),
    ],
)
def test_formulas_with_memory_read_well(clause: str, english: str) -> None:
    fspa = _fspa(clause)
    assert formula_text(fspa) == english
    (text,) = emit("json", fspa).values()
    assert formula_text(read_artefact(SourceFile("s.fspa.json", str(text)))) == english


def test_labels_use_the_same_words_and_other_notations_the_names() -> None:
    fspa = _fspa("reach seen then time_holding(near(e)) >= 3 s")
    assert label_text(fspa, 1) == "Reach near(e) for at least 3 s."
    assert label_text(fspa, 1, "ascii") == "F !(time_holding(near(e)) < 3)"
