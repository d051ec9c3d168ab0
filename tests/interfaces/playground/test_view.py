"""The data that the page shows."""

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
from tltlc.tools.lint.fix_application import fix
from tltlc.tools.lint.run import lint

BUTTONS = "signal a: bool\nsignal b: bool\nsignal fuel in [0, 5]\nspec both { reach a then b  keep fuel > 1 }\n"


def test_the_position_of_an_error_is_in_utf_16_units() -> None:
    text = "// 🎮\nsignal seen: bool\nspec hide = G !seem\n"
    document = view(text)
    (diagnostic,) = document["diagnostics"]
    assert (diagnostic["code"], diagnostic["severity"], document["specs"], document["spec"]) == (
        "TLT0201",
        "error",
        [],
        None,
    )
    (label,) = diagnostic["labels"]
    units = text.encode("utf-16-le")
    assert units[2 * label["start"] : 2 * label["end"]].decode("utf-16-le") == "seem"
    assert (label["file"], label["line"], label["column"]) == (None, 3, 16)


def test_warnings_findings_and_failed_tests_are_reported() -> None:
    tests = 'test "t" for x { step not a  expect holding }\ntest "u" for x { step a  expect satisfied }'
    text = f"signal a: bool\nentity e\nspec x = F a\n{tests}"
    document = view(text)
    assert [diagnostic["code"] for diagnostic in document["diagnostics"]] == ["TLT0421", "TLT0640"]
    assert [test["passed"] for test in document["tests"]] == [False, True]
    assert document["spec"]["name"] == "x"


def text_after(text: str, suggestion: dict[str, Any]) -> str:
    """Return the text after the edits of a suggestion, as the page applies them."""
    units = text.encode("utf-16-le")
    for edit in reversed(suggestion["edits"]):
        units = units[: 2 * edit["start"]] + edit["text"].encode("utf-16-le") + units[2 * edit["end"] :]
    return units.decode("utf-16-le")


def test_suggestions_equal_the_fixes_of_the_linter() -> None:
    spec = "spec x { limit 9 steps  reach alive then alive  keep alive  keep alive }"
    text = f"// 🎮\nimport core\nimport stealth\nentity e, f\n{spec}\n"
    diagnostics = view(text)["diagnostics"]
    source = SourceFile(NAME, text)
    assert [diagnostic["code"] for diagnostic in diagnostics] == [
        diagnostic.diagnostic.code for diagnostic in lint(source)
    ]
    while suggestions := [suggestion for diagnostic in view(text)["diagnostics"] for suggestion in diagnostic["fixes"]]:
        text = text_after(text, suggestions[0])
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
        # A text that could not be parsed before may still have other errors.
        ("spec x { kepe alive }", "Write `keep`", "spec x { keep alive }"),
    ],
)
def test_a_suggestion_mends_its_error(text: str, title: str | None, after: str | None) -> None:
    suggestions = [suggestion for diagnostic in view(text)["diagnostics"] for suggestion in diagnostic["fixes"]]
    assert [(suggestion["title"], text_after(text, suggestion)) for suggestion in suggestions] == (
        [(title, after)] if title else []
    )


def test_suggestions_use_the_libraries_of_the_project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "mine.tltl").write_text("signal shut: bool\n")
    (tmp_path / "tltl.toml").write_text('libraries = ["lib"]\n')
    (diagnostic,) = view("import mine\nspec x = F shutt")["diagnostics"]
    assert [suggestion["title"] for suggestion in diagnostic["fixes"]] == ["Write `shut`"]


def test_only_the_first_of_many_diagnostics_are_sent() -> None:
    document = view("signal a: bool\nspec x = F a\n" + "".join(f"entity e{number}\n" for number in range(300)))
    assert (len(document["diagnostics"]), document["more"]) == (200, 100)
    document = view("signal a: bool\nspec x = F a\n" + "".join(f"let e{number} = c\n" for number in range(300)))
    assert (len(document["diagnostics"]), document["more"]) == (200, 100)


def test_a_spec_is_chosen_by_name_with_the_first_as_default() -> None:
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
    failure = "violated at step 4: `fuel <= 1`, clause 2: `keep fuel > 1`"
    assert [row["failure"] for row in rows] == [None, None, None, failure]
    # Each row has a sample of signals, which is judged alike.
    rows_of_signals = view(BUTTONS, "both", [row["signals"] for row in rows])["spec"]["rows"]
    assert [row["state"] for row in rows_of_signals] == [row["state"] for row in rows]


def test_a_trace_that_no_single_clause_fails_names_none() -> None:
    text = "signal a: bool\nsignal b: bool\nspec x { keep a implies next b  keep a implies next not b }"
    rows = view(text, "", [[], ["a"], []])["spec"]["rows"]
    failure = "violated at step 2: `a`, against several clauses together"
    assert [row["failure"] for row in rows] == [None, failure, failure]
    rows = view("signal a: bool\nspec never = F a & G !a", "", [["a"]])["spec"]["rows"]
    assert [row["failure"] for row in rows] == ["violated at step 1: no trace can meet the spec"]


def test_an_invalid_step_ends_the_rows() -> None:
    text = "signal a: bool\nsignal b: bool\nexclusive a, b\nspec x = F a & F b"
    rows = view(text, "", [["a"], ["a", "b"], ["b"]])["spec"]["rows"]
    assert [row.get("error") for row in rows] == [None, "step 2: `a` and `b` hold at once, against `exclusive a, b`"]
    rows = view(text, "", [{"a": 1}])["spec"]["rows"]
    assert rows[0]["error"] == "step 1: no value for `b`"
    letters = [{"a": 1, "b": 0, "of another spec": float("nan")}, {"a": float("nan"), "b": 0}]
    rows = view(text, "", letters)["spec"]["rows"]
    assert rows[0]["signals"] == {"a": 1.0, "b": 0.0}
    assert rows[1]["error"] == "step 2: the signal `a` is nan, not a finite number"


VARIES = """clock varies
signal seen: bool
signal x in [0, 1]
spec watch {
    keep seen implies eventually within 2 s x > 0.5
}
"""


def test_steps_have_lengths_if_the_clock_varies() -> None:
    seen, unseen = {"seen": 1.0, "x": 0.25}, {"seen": 0.0, "x": 0.25}
    for letters in ([seen, unseen, unseen], [["seen"], [], []]):
        for lengths, verdicts in {
            (0.0, 2.0, 0.5): ["pending", "pending", "violated"],
            (0.0, 1.5, 0.5): ["pending", "pending", "pending"],
            (9.0, 0.0, 1e9): ["pending", "pending", "violated"],
        }.items():
            rows = view(VARIES, "", letters, lengths=lengths)["spec"]["rows"]
            assert [row["verdict"] for row in rows] == verdicts
        for wrong, text in {None: "missing, and the clock varies", -0.5: "-0.5, not a number of seconds"}.items():
            rows = view(VARIES, "", letters, lengths=[1.0, wrong])["spec"]["rows"]
            assert [row.get("error") for row in rows] == [None, f"step 2: its time since the sample before is {text}"]
        assert len(view(VARIES, "", letters, lengths=[1.0])["spec"]["rows"]) == 2
    assert view(VARIES)["spec"]["idle"]["dt"] == 2.0


def test_a_fixed_clock_needs_no_lengths() -> None:
    text = VARIES.replace("varies", "2 Hz")
    assert view(text)["spec"]["idle"]["dt"] is None
    letters = [["seen"], [], [], [], [], []]
    rows = view(text, "", letters, lengths=[-1.0, 100.0])["spec"]["rows"]
    assert rows == view(text, "", letters)["spec"]["rows"]
    assert [row["verdict"] for row in rows] == ["pending"] * 4 + ["violated"] * 2


def test_a_spec_without_time_is_shown_on_a_clock_that_varies() -> None:
    text = VARIES.replace("within 2 s ", "")
    assert view(text)["spec"]["idle"]["dt"] == 1.0
    rows = view(text, "", [["seen"], ["x > 0.5"]], lengths=[0.0, 60.0])["spec"]["rows"]
    assert [row["accepting"] for row in rows] == [False, True]


def test_many_failing_states_are_counted() -> None:
    spec = view("signal a: bool\nsignal b: bool\nspec x = (G[0,20] !a) & F b")["spec"]
    assert len(spec["explanation"]["failures"][0]["states"]) > 20
    assert spec["failures"] == ["a, in 41 of 44 states"]


def test_the_picture_is_in_words_by_default() -> None:
    request = {"text": "signal a: bool\nspec x = F a"}
    specs = [
        json.loads(answer(json.dumps({**request, **options})))["spec"] for options in ({}, {"notation": "unicode"})
    ]
    assert [">Reach a.<" in spec["picture"] for spec in specs] == [True, False]
    assert [">◇a<" in spec["picture"] for spec in specs] == [False, True]


@pytest.mark.parametrize("example", examples(), ids=lambda example: example["title"].partition(":")[0])
def test_the_examples_have_pictures_and_traces(example: dict[str, str]) -> None:
    document = view(example["text"])
    assert document["diagnostics"] == []
    for name in document["specs"]:
        spec = view(example["text"], name)["spec"]
        assert spec["picture"].startswith("<svg ")
        assert spec["idle"]["signals"] is not None
        for way, accepted in (("succeed", True), ("fail", False)):
            for kind in ("atoms", "signals"):
                letters = [letter[kind] for letter in spec[way] or []]
                rows = view(example["text"], name, letters)["spec"]["rows"]
                assert len(rows) == len(letters)
                # A prefix of an infinite trace need not be accepted.
                if rows and spec["explanation"]["semantics"] == "finite":
                    assert rows[-1]["accepting"] is accepted
        assert spec["succeed"] or spec["explanation"]["semantics"] == "infinite"
    json.dumps(document, allow_nan=False)


def test_an_idle_step_stays_in_the_initial_state() -> None:
    for example in examples():
        idle = view(example["text"])["spec"]["idle"]
        for letter in (idle["atoms"], idle["signals"]):
            assert [row["state"] for row in view(example["text"], "", [letter])["spec"]["rows"]] == [0]


def test_sliders_have_finite_ends() -> None:
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


def test_enums_are_set_by_their_values() -> None:
    text = "signal mode: (idle, alert)\nsignal phase: int in [0, 5]\nspec x = F mode is alert & F phase == 2"
    mode, phase = view(text)["spec"]["signals"]
    assert (mode["values"], mode["slider"]) == (["idle", "alert"], [0.0, 1.0])
    assert (phase["values"], phase["type"]) == ([], "int")


def test_the_project_file_of_the_folder_applies(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
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
    document = view(text)
    assert json.loads(answer(json.dumps({"text": text}))) == document
    length = len(text.encode("utf-16-le")) // 2
    for diagnostic in document["diagnostics"]:
        assert all(
            0 <= label["start"] <= label["end"] <= length for label in diagnostic["labels"] if label["file"] is None
        )


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
def test_invalid_requests_are_rejected(request_: str) -> None:
    with pytest.raises(RequestError):
        answer(request_)


def test_a_bug_is_reported_as_a_diagnostic(monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(*_: object) -> None:
        raise KeyError("unforeseen")

    monkeypatch.setattr(protocol, "view", fails)
    (diagnostic,) = json.loads(answer('{"text": ""}'))["diagnostics"]
    assert (diagnostic["code"], diagnostic["title"]) == ("TLT0775", "a bug in tltlc stopped this")


def test_the_page_gets_the_keywords_of_the_language() -> None:
    configuration = json.loads(answer("{}"))
    assert configuration == start()
    assert {"spec", "reach", "eventually", "F"} <= set(configuration["words"])
    assert "near" not in configuration["words"]
