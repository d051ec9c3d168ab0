"""The formats in which diagnostics are printed."""

from __future__ import annotations

import json
import os
from pathlib import Path

import jsonschema
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.calls import calls
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label, replacement_fix
from tltlc.diagnostics.formats.text import columns
from tltlc.diagnostics.render import FORMATS, render


def diagnostic(text: str, marked: str, message: str = "", **fields: object) -> Diagnostic:
    start = text.index(marked)
    label = Label(SourceFile("a.tltl", text), Span(start, start + len(marked)), message)
    return Diagnostic("TLT0101", "a title", (label,), **fields)  # type: ignore[arg-type]


def test_text_shows_title_place_line_caret_and_help() -> None:
    output = render([diagnostic("\nkeep a", "a", "a remark", help="one fix\nand another")])
    assert output == (
        "error[TLT0101]: a title\n  a.tltl:2:6\n2 | keep a\n  |      ^ a remark\n  help: one fix\n        and another\n"
    )


def test_empty_lines_separate_diagnostics_in_text() -> None:
    warning = Diagnostic("TLT0001", "no place", severity="warning")
    assert render([warning, warning]) == "warning[TLT0001]: no place\n\nwarning[TLT0001]: no place\n"
    assert render([]) == ""


@pytest.mark.parametrize(
    ("text", "marked", "line", "caret"),
    [
        ("\tkeep\ta", "a", "    keep    a", "            ^"),
        ("ab\tkeep", "\tkeep", "ab  keep", "  ^^^^^^"),
        ("漢字 keep", "keep", "漢字 keep", "     ^^^^"),
        ("keep 漢字", "漢字", "keep 漢字", "     ^^^^"),
        ("e\u0301 keep", "keep", "e\ufffd keep" if not "\u0301".isprintable() else "e\u0301 keep", "  ^^^^"),
        ("a\x1b[31m keep", "keep", "a\ufffd[31m keep", "       ^^^^"),
        ("keep", "", "keep", "^"),
    ],
)
def test_the_caret_is_under_the_marked_text(text: str, marked: str, line: str, caret: str) -> None:
    output = render([diagnostic(text, marked)]).splitlines()
    assert output[2:4] == [f"1 | {line}", f"  | {caret}"]


def test_the_caret_of_a_long_span_ends_with_its_first_line() -> None:
    output = render([diagnostic("spec a =\n  b\n  & c\n", "b\n  & c", "here")]).splitlines()
    assert output[2:4] == ["2 |   b", "  |   ^ (to line 3) here"]


def test_long_lines_are_cut_around_the_place() -> None:
    for marked in ("@", "@" * 3000):
        output = render([diagnostic("x" * 5000 + marked + "y" * 5000, marked)]).splitlines()
        assert max(map(len, output)) < 180
        caret = output[3].index("^")
        assert output[2][caret] == "@"


def test_a_line_of_a_megabyte_is_not_read_as_a_whole() -> None:
    source = SourceFile("a.tltl", "a\t" * 500_000 + "\x01")
    diagnostics = [
        Diagnostic("TLT0101", "a title", (Label(source, Span(i, i + 1)),)) for i in range(0, 1_000_000, 5_000)
    ]
    assert len(render(diagnostics).splitlines()) == 5 * len(diagnostics) - 1
    # Most spans have hundreds of thousands of characters before them.  Measured: 1300 calls for each.
    assert calls(lambda: render(diagnostics)) < 10_000 * len(diagnostics)


def test_several_labels_are_shown_in_order() -> None:
    source, second_source = SourceFile("a.tltl", "\n" * 9 + "one"), SourceFile("b.tltl", "two")
    labels = (Label(source, Span(9, 12), "here"), Label(second_source, Span(0, 3), "first here"))
    assert render([Diagnostic("TLT0201", "twice", labels)]).splitlines() == [
        "error[TLT0201]: twice",
        "  a.tltl:10:1",
        "10 | one",
        "   | ^^^ here",
        "  b.tltl:1:1",
        " 1 | two",
        "   | ^^^ first here",
    ]


def test_colour_adds_only_terminal_codes() -> None:
    plain = render([diagnostic("keep a", "a", "remark", help="help")])
    coloured = render([diagnostic("keep a", "a", "remark", help="help")], color=True)
    assert "\x1b[" not in plain
    assert "\x1b[1;31merror[TLT0101]\x1b[0m" in coloured
    for code in ("0", "1", "2", "1;31"):
        coloured = coloured.replace(f"\x1b[{code}m", "")
    assert coloured == plain


@given(st.text(), st.integers(0, 50), st.integers(0, 50), st.text(max_size=5), st.sampled_from(FORMATS))
def test_every_format_accepts_every_text(text: str, start: int, length: int, name: str, format_: str) -> None:
    start = min(start, len(text))
    label = Label(SourceFile(name, text), Span(start, min(len(text), start + length)), text)
    output = render([Diagnostic("TLT0101", text, (label,), text)], format_)
    assert "\x1b" not in output.replace(text, "") or format_ == "github"
    if format_ == "text":
        lines = output.splitlines()
        assert all(line.isprintable() for line in lines)


@given(st.text(alphabet=st.characters(categories=["L", "N", "P", "M"])))
def test_the_width_of_a_text_is_the_sum_of_its_characters(text: str) -> None:
    assert columns(text) == sum(columns(sign) for sign in text)


def test_json_contains_labels_and_fixes() -> None:
    fix = replacement_fix(SourceFile("a.tltl", "a\nkeep é"), Span(7, 8), "e")
    output = json.loads(render([diagnostic("a\nkeep é", "é", "remark", help="help", fixes=(fix,))], "json"))
    place = {"start": {"line": 2, "column": 6, "offset": 7}, "end": {"line": 2, "column": 7, "offset": 8}}
    assert output == {
        "diagnostics": [
            {
                "code": "TLT0101",
                "severity": "error",
                "title": "a title",
                "help": "help",
                "labels": [{"file": "a.tltl", **place, "message": "remark"}],
                "fixes": [{"title": "Write `e`", "applicability": "maybe", "edits": [{**place, "text": "e"}]}],
            }
        ]
    }


POSITION = {"type": "integer", "minimum": 1}
REGION = {
    "type": "object",
    "additionalProperties": False,
    "properties": dict.fromkeys(["startLine", "startColumn", "endLine", "endColumn"], POSITION),
}
ARTIFACT = {
    "type": "object",
    "required": ["uri"],
    "additionalProperties": False,
    "properties": {"uri": {"type": "string", "pattern": r"^[A-Za-z0-9._~:/%+-]+$"}},
}
REPLACEMENT = {
    "type": "object",
    "required": ["deletedRegion"],
    "additionalProperties": False,
    "properties": {"deletedRegion": REGION, "insertedContent": {"type": "object", "required": ["text"]}},
}
FIX = {
    "type": "object",
    "required": ["artifactChanges"],
    "additionalProperties": False,
    "properties": {
        "description": {"type": "object", "required": ["text"]},
        "artifactChanges": {
            "type": "array",
            "minItems": 1,
            "items": {
                "type": "object",
                "required": ["artifactLocation", "replacements"],
                "additionalProperties": False,
                "properties": {
                    "artifactLocation": ARTIFACT,
                    "replacements": {"type": "array", "minItems": 1, "items": REPLACEMENT},
                },
            },
        },
    },
}
LOCATION = {
    "type": "object",
    "required": ["physicalLocation"],
    "additionalProperties": False,
    "properties": {
        "message": {"type": "object", "required": ["text"]},
        "physicalLocation": {
            "type": "object",
            "required": ["artifactLocation", "region"],
            "additionalProperties": False,
            "properties": {
                "artifactLocation": ARTIFACT,
                "region": REGION,
            },
        },
    },
}
SARIF = {
    "type": "object",
    "required": ["version", "runs"],
    "additionalProperties": False,
    "properties": {
        "$schema": {"type": "string", "format": "uri"},
        "version": {"const": "2.1.0"},
        "runs": {
            "type": "array",
            "items": {
                "type": "object",
                "required": ["tool"],
                "additionalProperties": False,
                "properties": {
                    "columnKind": {"enum": ["utf16CodeUnits", "unicodeCodePoints"]},
                    "tool": {
                        "type": "object",
                        "required": ["driver"],
                        "properties": {
                            "driver": {
                                "type": "object",
                                "required": ["name"],
                                "properties": {
                                    "rules": {
                                        "type": "array",
                                        "uniqueItems": True,
                                        "items": {"type": "object", "required": ["id"]},
                                    }
                                },
                            }
                        },
                    },
                    "results": {
                        "type": "array",
                        "items": {
                            "type": "object",
                            "required": ["message"],
                            "additionalProperties": False,
                            "properties": {
                                "ruleId": {"type": "string"},
                                "ruleIndex": {"type": "integer", "minimum": 0},
                                "level": {"enum": ["none", "note", "warning", "error"]},
                                "message": {"type": "object", "required": ["text"]},
                                "locations": {"type": "array", "items": LOCATION},
                                "relatedLocations": {"type": "array", "items": LOCATION},
                                "fixes": {"type": "array", "items": FIX},
                            },
                        },
                    },
                },
            },
        },
    },
}
"""The part of the SARIF 2.1.0 schema that covers our output; some rules are stricter than the standard."""


def test_sarif_matches_its_schema(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names = ["level one/ä.tltl", str(tmp_path / "below.tltl"), str(tmp_path.parent / "above.tltl")]
    sources = [*(SourceFile(name, "keep a") for name in names), SourceFile("<stdin>", "keep a", "text")]
    labels = [Label(source, Span(5, 6), "here") for source in sources]
    diagnostics = [Diagnostic("TLT0101", "a title", (label,), "help") for label in labels]
    diagnostics.append(Diagnostic("TLT0001", "no place", severity="warning"))
    fixes = (replacement_fix(labels[0].source, labels[0].span, "b"),)
    diagnostics.append(Diagnostic("TLT0101", "two places", (labels[0], labels[1]), severity="note", fixes=fixes))
    log = json.loads(render(diagnostics, "sarif"))
    jsonschema.validate(log, SARIF)
    (run,) = log["runs"]
    rules = run["tool"]["driver"]["rules"]
    assert [rule["id"] for rule in rules] == ["TLT0001", "TLT0101"]
    assert rules[1]["shortDescription"] == {"text": "something else was expected"}
    for result in run["results"]:
        assert rules[result["ruleIndex"]]["id"] == result["ruleId"]
    uris = [
        location["physicalLocation"]["artifactLocation"]["uri"]
        for result in run["results"][:4]
        for location in result["locations"]
    ]
    above = f"file://{tmp_path.parent}/above.tltl".replace(os.sep, "/")
    assert uris == ["level%20one/%C3%A4.tltl", "below.tltl", above, "%3Cstdin%3E"]
    assert run["results"][0]["message"]["text"] == "a title\nhere\nhelp"
    assert [result["level"] for result in run["results"]] == ["error"] * 4 + ["warning", "note"]
    assert len(run["results"][5]["relatedLocations"]) == 1
    ((change,),) = (fix["artifactChanges"] for fix in run["results"][5]["fixes"])
    assert change["artifactLocation"]["uri"] == uris[0]
    region = {"startLine": 1, "startColumn": 6, "endLine": 1, "endColumn": 7}
    assert change["replacements"] == [{"deletedRegion": region, "insertedContent": {"text": "b"}}]


def test_a_file_of_the_current_folder_may_begin_with_two_dots(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    log = json.loads(
        render([Diagnostic("TLT0101", "a title", (Label(SourceFile("..a.tltl", "a"), Span(0, 1)),))], "sarif")
    )
    (location,) = log["runs"][0]["results"][0]["locations"]
    assert location["physicalLocation"]["artifactLocation"]["uri"] == "..a.tltl"


def test_a_file_on_another_drive_has_an_absolute_address(monkeypatch: pytest.MonkeyPatch) -> None:
    def relpath(path: str) -> str:
        raise ValueError(f"{path} is on another drive")

    monkeypatch.setattr("os.path.relpath", relpath)
    log = json.loads(
        render([Diagnostic("TLT0101", "a title", (Label(SourceFile("/a.tltl", "a"), Span(0, 1)),))], "sarif")
    )
    (location,) = log["runs"][0]["results"][0]["locations"]
    assert location["physicalLocation"]["artifactLocation"]["uri"] == "file:///a.tltl"


def test_github_commands_are_escaped() -> None:
    source = SourceFile("a:b,c.tltl", "one\nkeep é%\nlast")
    diagnostics = [
        Diagnostic("TLT0101", "50% of\r\nit", (Label(source, Span(9, 11), "here"),), "help"),
        Diagnostic("TLT0410", "long", (Label(source, Span(0, 8)),), severity="warning"),
        Diagnostic("TLT0001", "no place", severity="note"),
    ]
    assert render(diagnostics, "github").splitlines() == [
        "::error file=a%3Ab%2Cc.tltl,line=2,endLine=2,col=6,endColumn=7,title=TLT0101::50%25 of%0D%0Ait%0Ahere%0Ahelp",
        "::warning file=a%3Ab%2Cc.tltl,line=1,endLine=2,title=TLT0410::long",
        "::notice title=TLT0001::no place",
    ]


def test_an_unknown_format_is_an_error() -> None:
    with pytest.raises(ValueError, match="one of text, json, sarif, github"):
        render([], "xml")
