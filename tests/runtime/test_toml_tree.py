"""Labels of values in TOML files: each points at the key of its value."""

from __future__ import annotations

import pytest

from tltl_runtime.support.toml_tree import Tree, read_tree, value_label
from tltlc.core.source import SourceFile


def texts_of(tree: Tree) -> dict[str, str]:
    """Return the text at the label of each value, by key, also of those in tables."""
    texts = {}
    for key, entry in tree.items():
        span = entry.label.span
        texts[key] = entry.label.source.text[span.start : span.end]
        texts |= texts_of(entry.value) if isinstance(entry.value, dict) else {}
    return texts


@pytest.mark.parametrize(
    ("key", "name"),
    [
        ("a-1", "a-1"),
        ('"a b"', "a b"),
        (r'"a\tb"', "a\tb"),
        (r'"a\"b]=c"', 'a"b]=c'),
        (r'"\u00e9\U0001F600"', "\u00e9\U0001f600"),
        (r"'a\tb'", r"a\tb"),
        ("\"'a'\"", "'a'"),
        ('""', ""),
    ],
)
def test_the_label_of_a_value_is_its_key_however_it_is_quoted(key: str, name: str) -> None:
    source = SourceFile("it.toml", f"{key} = 1\nz = 2\n[t.{key}]\nx = 3\n")
    tree = read_tree(source)
    table = tree.pop("t").value
    assert texts_of(tree) == {name: key, "z": "z"}
    assert texts_of(table) == {name: f"t.{key}", "x": "x"}


@pytest.mark.parametrize(
    ("line", "text"),
    [
        ('a = "b c"', '"b c"'),
        ("a.b='c' # d", "'c'"),
        (r'a = "b\"c"', r'"b\"c"'),
        ("a = 3", "a"),
        ('a = """b"""', "a"),
        ("a = ['b']", "a"),
        ('a = { b = "c" }', '"c"'),
    ],
)
def test_a_text_in_one_line_has_a_label_of_its_own(line: str, text: str) -> None:
    entry = read_tree(SourceFile("it.toml", f"z = 1\n{line}\n"))["a"]
    while isinstance(entry.value, dict):
        entry = entry.value["b"]
    label = value_label(entry.label)
    assert label.source.text[label.span.start : label.span.end] == text


def test_a_key_in_an_inline_table_has_its_own_label() -> None:
    lines = [
        'a = { b = { c = 1, "d e" = "}, x = 2" }, f.g = [1, { h = 3 }], i = { } }',
        "j = [{ k = 1 }, { k = 2, l = [",
        "  # no key",
        "  { m = 'x' }, 3,",
        "] }]",
        "n = 1979-05-27T07:32:00Z",
        "[o]",
        "p = { q = '''}''', r = 1 }",
    ]
    tree = read_tree(SourceFile("it.toml", "\n".join(lines)))
    labels = [entry["k"].label for entry in (item.value for item in tree["j"].value)]
    assert [(label.source.text[label.span.start : label.span.end], label.span.start) for label in labels] == [
        ("k", len(lines[0]) + 1 + lines[1].index("k")),
        ("k", len(lines[0]) + 1 + lines[1].rindex("k")),
    ]
    names = {"a": "a", "b": "b", "c": "c", "d e": '"d e"', "f": "f.g", "g": "f.g", "i": "i", "j": "j", "n": "n"}
    assert texts_of(tree) == {**names, "o": "o", "p": "p", "q": "q", "r": "r"}
