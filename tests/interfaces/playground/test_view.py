"""What the page shows, as values."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tltlc.core.source import SourceFile
from tltlc.interfaces.playground import protocol, view
from tltlc.interfaces.playground.page_config import examples, start
from tltlc.interfaces.playground.page_data import NAME
from tltlc.interfaces.playground.protocol import RequestError, answer
from tltlc.tools.lint.fixing import fix
from tltlc.tools.lint.run import lint

BUTTONS = "signal a: bool\nsignal b: bool\nsignal fuel in [0, 5]\nspec both { reach a then b  keep fuel > 1 }\n"


def test_an_error_has_its_place_in_the_units_of_a_browser() -> None:
    text = "// 🎮\nsignal seen: bool\nspec hide = G !seem\n"
    found = view(text)
    (said,) = found["diagnostics"]
    assert (said["code"], said["severity"], found["specs"], found["spec"]) == ("TLT0201", "error", [], None)
    (label,) = said["labels"]
    units = text.encode("utf-16-le")
    assert units[2 * label["start"] : 2 * label["end"]].decode("utf-16-le") == "seem"
    assert (label["file"], label["line"], label["column"]) == (None, 3, 16)


def test_warnings_lints_and_failed_tests_are_told() -> None:
    tests = 'test "t" for x { step not a  expect holding }\ntest "u" for x { step a  expect satisfied }'
    text = f"signal a: bool\nentity e\nspec x = F a\n{tests}"
    found = view(text)
    assert [each["code"] for each in found["diagnostics"]] == ["TLT0421", "TLT0640"]
    assert [test["passed"] for test in found["tests"]] == [False, True]
    assert found["spec"]["name"] == "x"


def edited(text: str, way_out: dict[str, Any]) -> str:
    """The text after the edits of a way out, as the page makes them."""
    units = text.encode("utf-16-le")
    for edit in reversed(way_out["edits"]):
        units = units[: 2 * edit["start"]] + edit["text"].encode("utf-16-le") + units[2 * edit["end"] :]
    return units.decode("utf-16-le")


def test_fixes_are_those_of_the_linter() -> None:
    spec = "spec x { limit 9 steps  reach alive then alive  keep alive  keep alive }"
    text = f"// 🎮\nimport core\nimport stealth\nentity e, f\n{spec}\n"
    said = view(text)["diagnostics"]
    source = SourceFile(NAME, text)
    assert [each["code"] for each in said] == [each.diagnostic.code for each in lint(source)]
    while ways := [way for each in view(text)["diagnostics"] for way in each["ways_out"]]:
        text = edited(text, ways[0])
    assert text == fix(source).source.text


@pytest.mark.parametrize(
    ("text", "title", "after"),
    [
        ("spec x = F alive", "Add `import stealth`", "import stealth\nspec x = F alive"),
        ("signal 🎮: bool", None, None),
        (
            "// 🎮\nimport stealth\nspec x { kepe alive }",
            "Write `keep`",
            "// 🎮\nimport stealth\nspec x { keep alive }",
        ),
        # What could not be read before may be wrong in itself.
        ("spec x { kepe alive }", "Write `keep`", "spec x { keep alive }"),
    ],
)
def test_ways_out_of_errors(text: str, title: str | None, after: str | None) -> None:
    ways = [way for each in view(text)["diagnostics"] for way in each["ways_out"]]
    assert [(way["title"], edited(text, way)) for way in ways] == ([(title, after)] if title else [])


def test_ways_out_know_the_libraries_of_the_project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "mine.tltl").write_text("signal shut: bool\n")
    (tmp_path / "tltl.toml").write_text('libraries = ["lib"]\n')
    (said,) = view("import mine\nspec x = F shutt")["diagnostics"]
    assert [way["title"] for way in said["ways_out"]] == ["Write `shut`"]


def test_of_many_messages_the_first_are_told() -> None:
    found = view("signal a: bool\nspec x = F a\n" + "".join(f"entity e{number}\n" for number in range(300)))
    assert (len(found["diagnostics"]), found["more"]) == (200, 100)
    found = view("signal a: bool\nspec x = F a\n" + "".join(f"let e{number} = c\n" for number in range(300)))
    assert (len(found["diagnostics"]), found["more"]) == (200, 100)


def test_a_spec_is_picked_by_name_and_else_the_first() -> None:
    text = "signal a: bool\nspec one = F a\nspec two = G a"
    assert [view(text, name)["spec"]["name"] for name in ("two", "one", "none", "")] == ["two", "one", "one", "one"]
    assert view("signal a: bool\nlet x = a")["spec"] is None


def test_a_trace_of_atoms_is_judged_step_by_step() -> None:
    fuel = "fuel > 1"
    rows = view(BUTTONS, "both", [[fuel], ["a", fuel], ["b", fuel, "unknown"], []])["spec"]["rows"]
    assert [(row["from"], row["verdict"], row["accepting"]) for row in rows] == [
        (0, "pending", False),
        (0, "pending", False),
        (rows[1]["state"], "holding", True),
        (rows[2]["state"], "violated", False),
    ]
    assert [row["progress"] for row in rows] == [0.0, 0.5, 1.0, 1.0]
    assert rows[0]["limiting"] == "a"
    # Each has a sample, which is judged alike.
    again = view(BUTTONS, "both", [row["signals"] for row in rows])["spec"]["rows"]
    assert [row["state"] for row in again] == [row["state"] for row in rows]


def test_what_the_monitor_refuses_ends_the_rows() -> None:
    text = "signal a: bool\nsignal b: bool\nexclusive a, b\nspec x = F a & F b"
    rows = view(text, "", [["a"], ["a", "b"], ["b"]])["spec"]["rows"]
    assert [row.get("error") for row in rows] == [None, "step 2: `a` and `b` hold at once, against `exclusive a, b`"]
    rows = view(text, "", [{"a": 1}])["spec"]["rows"]
    assert rows[0]["error"] == "step 1: no value for `b`"
    letters = [{"a": 1, "b": 0, "of another spec": float("nan")}, {"a": float("nan"), "b": 0}]
    rows = view(text, "", letters)["spec"]["rows"]
    assert rows[0]["signals"] == {"a": 1.0, "b": 0.0}
    assert rows[1]["error"] == "step 2: the signal `a` is nan, not a finite number"


def test_of_many_states_in_which_it_breaks_the_first_are_told() -> None:
    spec = view("signal a: bool\nsignal b: bool\nspec x = (G[0,20] !a) & F b")["spec"]
    assert len(spec["explanation"]["failures"][0]["states"]) > 20
    assert spec["failures"] == ["a, in states 0, 1, 2, 4, 5, 6, 7, 8, …"]


def test_the_picture_is_in_words_unless_asked_for_otherwise() -> None:
    asked = {"text": "signal a: bool\nspec x = F a"}
    shown = [json.loads(answer(json.dumps({**asked, **more})))["spec"] for more in ({}, {"notation": "unicode"})]
    assert [">Reach a.<" in spec["picture"] for spec in shown] == [True, False]
    assert [">◇a<" in spec["picture"] for spec in shown] == [False, True]


@pytest.mark.parametrize("example", examples(), ids=lambda example: example["title"].partition(":")[0])
def test_the_examples_show_everything(example: dict[str, str]) -> None:
    found = view(example["text"])
    assert found["diagnostics"] == []
    for name in found["specs"]:
        spec = view(example["text"], name)["spec"]
        assert spec["picture"].startswith("<svg ")
        assert spec["idle"]["signals"] is not None
        for way, accepted in (("succeed", True), ("fail", False)):
            for kind in ("atoms", "signals"):
                letters = [letter[kind] for letter in spec[way] or []]
                rows = view(example["text"], name, letters)["spec"]["rows"]
                assert len(rows) == len(letters)
                # Over infinite traces a prefix says little.
                if rows and spec["explanation"]["semantics"] == "finite":
                    assert rows[-1]["accepting"] is accepted
        assert spec["succeed"] or spec["explanation"]["semantics"] == "infinite"
    json.dumps(found, allow_nan=False)


def test_an_idle_step_changes_nothing() -> None:
    for example in examples():
        idle = view(example["text"])["spec"]["idle"]
        for letter in (idle["atoms"], idle["signals"]):
            assert [row["state"] for row in view(example["text"], "", [letter])["spec"]["rows"]] == [0]


def test_sliders_end_somewhere() -> None:
    text = (
        "param far: length in [1 m, 9 m] = 7 m\nsignal d: length\nsignal t: time\nsignal n in [2, 3]\n"
        "predicate p in [-1, 1] = clamp(d / far + t / 1 s + n, -1, 1)\nspec x = F p"
    )
    signals = {signal["name"]: signal for signal in view(text)["spec"]["signals"]}
    assert {name: signal["slider"] for name, signal in signals.items()} == {
        "d": [-7.0, 7.0],
        "t": [-100.0, 100.0],
        "n": [2.0, 3.0],
    }
    assert (signals["d"]["unit"], signals["d"]["low"], signals["n"]["high"]) == ("m", None, 3.0)


def test_the_project_file_of_the_folder_counts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "mine.tltl").write_text("signal a: bool\n")
    assert view("import mine\nspec x = F a")["diagnostics"][0]["code"] == "TLT0010"
    (tmp_path / "tltl.toml").write_text('libraries = ["lib"]\n')
    assert view("import mine\nspec x = F a")["specs"] == ["x"]
    (tmp_path / "tltl.toml").write_text("libraries = 3\n")
    assert view("spec x = F a")["diagnostics"][0]["code"] == "TLT0703"


@given(st.text(alphabet='spec xyF=&|!{}()\n"/\U0001f3ae reach then a', max_size=60))
def test_every_text_has_an_answer(text: str) -> None:
    found = view(text)
    assert json.loads(answer(json.dumps({"text": text}))) == found
    length = len(text.encode("utf-16-le")) // 2
    for said in found["diagnostics"]:
        assert all(0 <= label["start"] <= label["end"] <= length for label in said["labels"] if label["file"] is None)


NO_REQUESTS = (
    "",
    "[]",
    "{",
    "[" * 100_000,
    '{"text": 3}',
    '{"text": "", "letters": [3]}',
    '{"text": "", "spec": 1}',
    '{"text": "", "notation": []}',
)


@pytest.mark.parametrize("request_", NO_REQUESTS)
def test_what_is_no_request_is_refused(request_: str) -> None:
    with pytest.raises(RequestError):
        answer(request_)


def test_a_bug_is_no_end(monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(*_: object) -> None:
        raise KeyError("unforeseen")

    monkeypatch.setattr(protocol, "view", fails)
    (said,) = json.loads(answer('{"text": ""}'))["diagnostics"]
    assert (said["code"], said["title"]) == ("TLT0775", "a bug in tltlc stopped this")


def test_the_words_of_the_language_are_known_to_the_page() -> None:
    begun = json.loads(answer("{}"))
    assert begun == start()
    assert {"spec", "reach", "eventually", "F"} <= set(begun["words"])
    assert "near" not in begun["words"]
