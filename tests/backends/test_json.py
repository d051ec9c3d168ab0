from __future__ import annotations

import json
import sys
import unicodedata
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.backends.strategies import automata, expressions, finite, hostile_automata, infinite_automata
from tests.fixtures import cover_and_hide
from tests.fuzzing import times
from tltlc import backends
from tltlc.artefact import size as sizes
from tltlc.artefact.decode import read
from tltlc.artefact.encode import encode
from tltlc.artefact.json_layout import WIDTH, layout
from tltlc.automaton.fspa import Fspa, Text
from tltlc.core.record import replace
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.expression.python import compile_expressions
from tltlc.expression.tree import Condition, Const, Expression, Op, SignalValue, When
from tltlc.io.limits import ARITHMETIC, Limit
from tltlc.resolve.spec import Atom
from tltlc.tools.diff.relation import different_atoms


def json_text(fspa: Fspa) -> str:
    text = backends.emit("json", fspa)[f"{fspa.name}.fspa.json"]
    assert isinstance(text, str)
    return text


def test_cover_and_hide_is_read_back() -> None:
    assert read(SourceFile("x.fspa.json", json_text(cover_and_hide()))) == cover_and_hide()


@times(25)
@given(automata() | infinite_automata())
def test_automata_are_read_back_unchanged(fspa: Fspa) -> None:
    assert read(SourceFile("x.fspa.json", json_text(fspa))) == fspa


@times(25)
@given(hostile_automata())
def test_hostile_texts_are_read_back_unchanged(fspa: Fspa) -> None:
    text = json_text(fspa)
    assert read(SourceFile("x.fspa.json", text)) == fspa
    assert "</" not in text
    assert "<!" not in text
    assert not [
        character for character in text if character != "\n" and unicodedata.category(character) in ("Cc", "Cf")
    ]


@pytest.mark.parametrize("name", ["alive&alive", "(alive)", "G (alive)", "alive or not"])
def test_a_name_that_tltlc_would_write_otherwise_stays_a_name(name: str) -> None:
    fspa = cover_and_hide()
    label = Text(name, "in unicode", "In English.")
    fspa = replace(fspa, formula=label, states=(replace(fspa.states[0], label=label), *fspa.states[1:]))
    assert read(SourceFile("x.fspa.json", json_text(fspa))) == fspa


def test_invisible_characters_are_escaped() -> None:
    unseen = [chr(code) for code in range(sys.maxunicode + 1) if unicodedata.category(chr(code)) in ("Cc", "Cf", "Cs")]
    text = json_text(replace(cover_and_hide(), doc="".join(unseen)))
    assert not {*text} & {*unseen} - {"\n"}
    assert all(f"\\u{ord(character):04x}" in text for character in unseen if "\x7f" < character <= "\uffff")


@times(25)
@given(expressions())
def test_expressions_are_read_back_unchanged(expression: Expression) -> None:
    fspa = cover_and_hide()
    fspa = replace(fspa, atoms=(Atom("near", expression, "", ("s1",)), *fspa.atoms[1:]))
    assert read(SourceFile("x.fspa.json", json_text(fspa))) == fspa


@given(finite())
def test_numbers_keep_every_digit(number: float) -> None:
    fspa = cover_and_hide()
    fspa = replace(fspa, atoms=(Atom("near", Const(number), "", ("s1",)), *fspa.atoms[1:]))
    (atom, *_) = read(SourceFile("x.fspa.json", json_text(fspa))).atoms
    assert isinstance(atom.expression, Const)
    assert repr(atom.expression.value) == repr(number)


def test_unknown_fields_are_ignored_and_integers_may_have_a_decimal_point() -> None:
    document = json.loads(json_text(cover_and_hide()))
    document["generator"] = {"name": "another"}
    document["states"][0]["colour"] = "blue"
    document["spec_size"] = 3.0
    document["params"][0]["value"] = 20
    fspa = read(SourceFile("x.fspa.json", json.dumps(document)))
    assert fspa == cover_and_hide()
    assert isinstance(fspa.spec_size, int)
    assert isinstance(fspa.params[0].value, float)


def test_a_non_finite_number_is_never_written() -> None:
    fspa = cover_and_hide()
    with pytest.raises(ValueError, match="expression"):
        json_text(replace(fspa, atoms=(Atom("near(s1)", Const(float("inf"))), *fspa.atoms[1:])))


@pytest.mark.parametrize(
    ("text", "code", "title"),
    [
        ("", "TLT0601", "is not JSON"),
        ("{", "TLT0601", "is not JSON"),
        ('{"format": "fspa", "version": NaN}', "TLT0601", "NaN is not a finite number"),
        ("[" * 100_000, "TLT0006", "it nests too deep"),
        ("9" * 10_000, "TLT0601", "is JSON, but not an artefact"),
        ("[]", "TLT0601", "is JSON, but not an artefact"),
        ('{"format": "gltf"}', "TLT0601", "is JSON, but not an artefact"),
        ('{"format": "fspa"}', "TLT0602", "does not say its version"),
        ('{"format": "fspa", "version": true}', "TLT0602", "does not say its version"),
        ('{"format": "fspa", "version": "1"}', "TLT0602", "does not say its version"),
        ('{"format": "fspa", "version": 3}', "TLT0602", "has version 3, and only"),
        ('{"format": "fspa", "version": 1}', "TLT0603", "the artefact lacks `atoms`, `edges`"),
    ],
)
def test_invalid_artefacts_are_rejected(text: str, code: str, title: str) -> None:
    with pytest.raises(TltlError) as caught:
        read(SourceFile("x.fspa.json", text))
    (error,) = caught.value.diagnostics
    assert error.code == code
    assert title in error.title


def test_an_artefact_has_pairs_only_over_infinite_traces() -> None:
    document = json.loads(json_text(cover_and_hide()))
    with pytest.raises(TltlError, match="TLT0603: the artefact lacks `acceptance`"):
        read(SourceFile("x.fspa.json", json.dumps({**document, "semantics": "infinite"})))
    with pytest.raises(TltlError, match="TLT0603: `semantics` must be `infinite`"):
        read(SourceFile("x.fspa.json", json.dumps({**document, "acceptance": {"pairs": []}})))


def test_an_error_points_at_the_value() -> None:
    text = json_text(cover_and_hide()).replace('"distance": 2', '"distance": "2"')
    with pytest.raises(TltlError) as caught:
        read(SourceFile("x.fspa.json", text))
    (error,) = caught.value.diagnostics
    (label,) = error.labels
    assert error.title == "`states[1].distance` must be a whole number or null"
    assert label.source.slice(label.span) == '"2"'


@times(60)
@given(st.data())
def test_damaged_texts_raise_only_errors_of_artefacts(data: st.DataObject) -> None:
    text = json_text(cover_and_hide())
    start = data.draw(st.integers(0, len(text)))
    end = data.draw(st.integers(start, min(len(text), start + 30)))
    patch = data.draw(st.sampled_from(["", "0", "-1", "null", '"', "[", "}", ",", "1e400", "true", '"x"', "[]", "{}"]))
    try:
        read(SourceFile("x.fspa.json", text[:start] + patch + text[end:]))
    except TltlError as error:
        assert all(diagnostic.code.startswith("TLT06") for diagnostic in error.diagnostics)


values = st.recursive(
    st.none() | st.booleans() | st.integers() | finite() | st.text(),
    lambda v: st.lists(v) | st.dictionaries(st.text(), v),
)


@given(values)
def test_the_layout_changes_no_value(value: object) -> None:
    assert json.loads("".join(layout(value))) == json.loads(json.dumps(value))


def test_lines_are_short_unless_a_text_is_long() -> None:
    lines = json_text(cover_and_hide()).splitlines()
    assert max(map(len, lines)) <= WIDTH
    assert len(lines) < 250


def test_an_artefact_that_is_too_large_to_read_back_is_not_written(monkeypatch: pytest.MonkeyPatch) -> None:
    text = json_text(cover_and_hide())
    size, values = len(text.encode()), text.count(",") + 1
    monkeypatch.setattr(sizes, "ARTEFACT", Limit(size, 900, values))
    assert json_text(cover_and_hide()) == text
    for limit, code in ((Limit(size - 1, 900, values), "TLT0004"), (Limit(size, 900, values - 1), "TLT0006")):
        monkeypatch.setattr(sizes, "ARTEFACT", limit)
        with pytest.raises(TltlError) as caught:
            json_text(cover_and_hide())
        (diagnostic,) = caught.value.diagnostics
        assert diagnostic.code == code
        assert diagnostic.title.startswith("the artefact of `cover_and_hide` would ")
        assert "declare atoms that never hold together `exclusive`" in str(diagnostic.help)


def test_an_artefact_with_very_many_edges_is_rejected_before_it_is_encoded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tltlc.backends.json.encode", None)
    fspa = cover_and_hide()
    with pytest.raises(TltlError) as caught:
        json_text(replace(fspa, edges=fspa.edges * 500_000))
    assert [diagnostic.code for diagnostic in caught.value.diagnostics] == ["TLT0004"]


@times(25)
@given(automata() | infinite_automata())
def test_the_estimated_size_is_a_lower_bound(fspa: Fspa) -> None:
    text = json_text(fspa)
    size, commas = sizes.least_size(fspa)
    assert size <= len(text.encode())
    assert commas <= text.count(",")


@given(
    st.recursive(
        st.integers() | st.text(max_size=9),
        lambda inner: st.lists(inner) | st.dictionaries(st.text(max_size=9), inner),
        max_leaves=90,
    )
)
def test_a_value_is_on_one_line_if_and_only_if_it_fits(value: object) -> None:
    text = "".join(layout({"key": value}))
    flat = json.dumps(value, ensure_ascii=False)
    one_line = not isinstance(value, (dict, list)) or not value or len('  "key": ' + flat) < WIDTH
    assert (text.count("\n") == 3) == one_line


X: Expression = SignalValue("health")
BELOW = Condition("<", (X, Const(0.5)))


def nested(level: Callable[[Expression], Expression], count: int) -> Expression:
    """Return an expression with ``count`` nested levels."""
    expression = X
    for _ in range(count):
        expression = level(expression)
    return expression


def with_arithmetic(expression: Expression) -> Fspa:
    fspa = cover_and_hide()
    first, *rest = fspa.atoms
    return replace(fspa, atoms=(replace(first, expression=expression), *rest))


LEVELS: dict[str, tuple[int, Callable[[Expression], Expression]]] = {
    "minus": (1, lambda inner: Op("neg", (inner,))),
    "left": (1, lambda inner: Op("+", (inner, X))),
    "right": (1, lambda inner: Op("+", (X, inner))),
    "power": (1, lambda inner: Op("^", (inner, Const(2.0)))),
    "otherwise": (1, lambda inner: When(((BELOW, Const(1.0)),), inner)),
    "case": (1, lambda inner: When(((BELOW, inner),), Const(1.0))),
    "condition": (2, lambda inner: When(((Condition("<", (inner, X)), Const(1.0)),), Const(0.0))),
    "not": (3, lambda inner: When(((Condition("not", (Condition("<", (inner, X)),)), X),), X)),
}


@pytest.mark.parametrize("name", LEVELS)
def test_every_reader_of_an_automaton_handles_the_deepest_arithmetic(name: str) -> None:
    nodes, level = LEVELS[name]
    text = json_text(with_arithmetic(nested(level, (ARITHMETIC.compared - 1) // nodes)))
    one, other = read(SourceFile("x.fspa.json", text)), read(SourceFile("x.fspa.json", text))
    assert one == other
    assert different_atoms(one, other) == ()
    assert hash(one.atoms[0].expression) == hash(other.atoms[0].expression)
    compile_expressions([one.atoms[0].expression], [signal.name for signal in one.signals], {"level_size": 20.0})
    for target in ("python", "c", "csharp", "gdscript", "javascript", "lua", "rust"):
        assert backends.emit(target, one)


@pytest.mark.parametrize("name", LEVELS)
def test_deeper_arithmetic_is_rejected(name: str) -> None:
    nodes, level = LEVELS[name]
    text = json.dumps(encode(with_arithmetic(nested(level, ARITHMETIC.compared // nodes + 1))))
    with pytest.raises(TltlError) as caught:
        read(SourceFile("x.fspa.json", text))
    assert caught.value.diagnostics[0].code == "TLT0006"


@pytest.mark.parametrize(
    "wide",
    [
        lambda count: Op("min", (X,) * count),
        lambda count: When(tuple((Condition("<", (X, Const(case / count))), X) for case in range(count)), X),
    ],
    ids=["arguments", "cases"],
)
def test_wide_arithmetic_is_rejected(wide: Callable[[int], Expression]) -> None:
    fspa = read(SourceFile("x.fspa.json", json_text(with_arithmetic(wide(ARITHMETIC.parts)))))
    compile_expressions([fspa.atoms[0].expression], [signal.name for signal in fspa.signals], {"level_size": 20.0})
    with pytest.raises(TltlError) as caught:
        read(SourceFile("x.fspa.json", json_text(with_arithmetic(wide(ARITHMETIC.parts + 1)))))
    assert caught.value.diagnostics[0].code == "TLT0006"
