"""Completion: the items offered at the mark of each text."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.interfaces.lsp.texts import open_text
from tltlc.interfaces.lsp.completion import completions
from tltlc.interfaces.lsp.edits import apply_edits

BEFORE = """\
import stealth
entity s1, chest
clock 10 Hz
signal fuel: ratio
param most: length in [1 m, 9 m] = 2 m
let calm(worst: ratio) = fuel > worst
spec leave { tag smoke  reach near(s1) }
"""


def offered_labels(text: str, folder: Path | None = None, before: str = BEFORE, **others: str) -> list[str]:
    document, at, _ = open_text(before + text, folder, **others)
    return [item.label for item in completions(document, at, "utf-16")]


@pytest.mark.parametrize(
    ("text", "among", "absent"),
    [
        ("¦", ["import", "signal", "spec", "test"], ["reach", "near", "eventually", "step"]),
        ("sp¦", ["spec"], ["keep"]),
        ("spec a {\n    ¦\n}", ["reach", "keep", "avoid", "limit", "judge", "semantics"], ["spec", "step", "near"]),
        ("spec a {\n    reach near(s1)\n    ¦", ["then", "and", "until", "keep"], ["near", "spec", "within"]),
        ("spec a {\n    reach ¦\n    keep alive\n}", ["near", "alive", "calm", "fuel", "not"], ["s1", "reach"]),
        ("spec a { reach near(¦", ["s1", "chest"], ["alive", "fuel", "near"]),
        ("spec a { reach near(s1, ¦", ["close = ", "far = ", "most"], ["target = "]),
        ("spec a { reach near(s1, close = 3 ¦", ["m", "km", "s", "%"], ["steps", "near"]),
        ("spec a { limit 3 ¦", ["steps", "s", "min"], ["m", "%"]),
        ("clock 20 ¦", ["Hz", "s", "ms"], ["m", "%", "steps"]),
        ("spec a { require eventually within 3 ¦", ["steps", "s"], ["m"]),
        ("spec a { keep ¦", ["once", "historically", "begins", "times", "time_since", "previous"], ["since"]),
        ("spec a { keep alive ¦", ["since", "and"], ["once"]),
        ("spec a { keep once within 3 ¦", ["steps", "s"], ["m"]),
        ("signal times: ratio\nspec a { keep ¦", ["times", "time_since"], []),
        ("spec a { judge ¦", ["at"], ["goal"]),
        ("spec a { judge at ¦", ["goal", "limit"], ["near"]),
        ("spec a { semantics ¦", ["finite", "infinite"], ["near"]),
        ("spec a { tag ¦", ["smoke"], ["near"]),
        ("spec a = all x in (¦", ["s1", "chest"], ["near"]),
        ("spec a = all x in (s1): near(¦", ["x", "s1"], ["near"]),
        ("entity guards = s1\nspec a = all x in (¦", ["guards", "s1"], ["near"]),
        ("entity guards = ¦", ["s1", "chest"], ["near"]),
        ("import ¦", ["core", "spatial", "stealth"], ["near"]),
        ("import spatial (¦", ["near", "facing"], ["alive", "s1"]),
        ("signal speed: ¦", ["speed", "length", "bool"], ["near", "formula"]),
        ("let p(q: ¦", ["formula", "entity", "time"], ["near"]),
        ("let p(first, second) = ¦", ["first", "second", "near", "not"], ["s1"]),
        ("predicate p(x: entity) = ¦", ["x", "fuel", "clamp", "when"], []),
        ('test "t" for ¦', ["leave"], ["near", "calm"]),
        ('test "t" for leave {\n    ¦', ["step", "expect"], ["keep"]),
        ('test "t" for leave {\n    step ¦', ["near(s1)", "not"], []),
        (
            'spec few { keep times(near(s1)) <= 3 }\ntest "t" for few {\n    step ¦',
            ["near(s1)"],
            ["times(near(s1)) > 3"],
        ),
        (
            'signal n: int in [0, 5]\nspec few { keep n > 3 }\ntest "t" for few {\n    step ¦',
            ["n > 3", "n = "],
            ["near(s1)"],
        ),
        (
            'test "t" for leave {\n    step near(s1)\n    expect ¦',
            ["satisfied", "holding", "pending", "violated", "progress", "state"],
            ["near"],
        ),
        ("exclusive ¦", ["near", "alive"], []),
        ("signal mode: (idle, alert)\nspec a = F mode is ¦", ["idle", "alert"], ["near", "fuel"]),
        ("signal mode(g: entity): (idle, alert)\nspec a { keep mode(s1) is not al¦", ["idle", "alert"], ["near"]),
        ("signal mode: (idle, alert)\nspec a = F mode ¦", ["is", "and"], ["near"]),
        ("signal n: ¦", ["int"], ["near"]),
        ("spec ¦", [], ["near", "leave"]),
        ("// near ¦", [], ["near", "spec"]),
        ("let p = ) ( near(¦", ["s1"], []),
    ],
    ids=lambda value: value.replace("\n", " ") if isinstance(value, str) else "",
)  # fmt: skip
def test_the_offered_items_fit_the_place(text: str, among: list[str], absent: list[str]) -> None:
    items = offered_labels(text)
    assert [item for item in among if item not in items] == []
    assert [item for item in absent if item in items] == []


def test_nothing_is_offered_twice() -> None:
    items = offered_labels("spec a { reach ¦")
    assert len(items) == len(set(items))


def test_a_choice_replaces_the_part_of_the_word() -> None:
    document, at, _ = open_text("import core as c\nsignal n: ratio\nspec a = c.ab¦")
    item = next(candidate for candidate in completions(document, at, "utf-16") if candidate.label == "c.above")
    assert item.text_edit is not None
    assert item.text_edit.range.start.character == len("spec a = ")
    assert item.text_edit.new_text == "c.above"


def test_unsaved_files_and_libraries_are_offered(tmp_path: Path) -> None:
    (tmp_path / "saved.tltl").write_text("entity s1\n", encoding="utf-8")
    assert {"saved", "fresh"} <= set(offered_labels("import ¦", tmp_path, "", fresh="entity s2"))
    assert {"saved.tltl", "fresh.tltl"} <= set(offered_labels('import "¦', tmp_path, "", fresh="entity s2"))
    assert offered_labels('test "¦', tmp_path, "", fresh="entity s2") == []


def test_every_offered_keyword_can_start_a_clause() -> None:
    """The parser accepts every keyword that is offered at the start of a clause."""
    document, at, _ = open_text(BEFORE + "spec a {\n    keep alive\n    ¦\n}")
    for item in completions(document, at, "utf-16"):
        text = document.source.text[:at] + item.label + " (" + document.source.text[at:]
        assert apply_edits(text, []) == text
        with_keyword, _, _ = open_text(text)
        assert not any(f"found `{item.label}`" in diagnostic.title for diagnostic in with_keyword.diagnostics)
