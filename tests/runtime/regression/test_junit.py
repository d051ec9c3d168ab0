"""The JUnit XML report, checked against the rules of the schema junit-10."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

from tests.runtime.regression.handmade import case, suite, summaries
from tltl_runtime.evaluation.figures import figures_of
from tltl_runtime.regression.explain.explain import Finding
from tltl_runtime.regression.report.case_report import CaseReport
from tltl_runtime.regression.report.junit import junit
from tltl_runtime.regression.report.retraining_result import FinishedRetraining, RetrainingResult
from tltl_runtime.regression.suite.suite import Suite
from tltlc.core.record import replace

TESTSUITE = {"name", "tests", "failures", "errors", "skipped"}
TESTSUITE |= {"group", "time", "timestamp", "hostname", "id", "package", "file", "log", "url"}
RULES: dict[str, tuple[set[str], set[str], set[str]]] = {
    # attributes, required attributes, children
    "testsuites": ({"name", "time", "tests", "failures", "errors"}, set(), {"testsuite"}),
    "testsuite": (
        TESTSUITE,
        {"name", "tests", "failures", "errors"},
        {"testsuite", "properties", "testcase", "system-out", "system-err"},
    ),
    "properties": (set(), set(), {"property"}),
    "property": ({"name", "value"}, {"name", "value"}, set()),
    "testcase": (
        {"name", "time", "classname", "group"},
        {"name"},
        {"skipped", "error", "failure", "system-out", "system-err"},
    ),
    "failure": ({"type", "message"}, set(), set()),
    "error": ({"type", "message"}, set(), set()),
    "skipped": ({"type", "message"}, set(), set()),
    "system-out": (set(), set(), set()),
    "system-err": (set(), set(), set()),
}
"""The rules of the schema, from https://github.com/jenkinsci/xunit-plugin."""
TEXTS = {"failure", "error", "skipped", "system-out", "system-err"}

GOOD = CaseReport("room:v0", "room", "v0", "pass", ("met in 40 of 40 episodes",), figures=figures_of(summaries(40)))
DOUBTED = CaseReport("room:v1", "room", "v1", "review", ("reward is lower", "dies `in` the <hall> & more"))
BAD = CaseReport("room:v2", "room", "v2", "fail", ("it cannot be played", "room.toml:3: TLT0803, …"))
GOOD = replace(GOOD, baseline=figures_of(summaries(30, 10)))
SUITE: Suite = suite(case("room:v0"), case("room:v1"), case("room:v2"), path=Path("levels/game.toml"))


def check(element: ET.Element) -> None:
    """Check an element and its children against the schema."""
    allowed, required, children = RULES[element.tag]
    assert required <= set(element.attrib) <= allowed, element.tag
    assert {child.tag for child in element} <= children
    if element.tag not in TEXTS:
        assert not (element.text or "").strip()
    for child in element:
        assert not (child.tail or "").strip()
        check(child)


def read(reports: tuple[CaseReport, ...]) -> ET.Element:
    text = junit(SUITE, reports)
    assert text.startswith('<?xml version="1.0" encoding="UTF-8"?>\n<testsuites')
    root = ET.fromstring(text.encode())
    check(root)
    return root


def test_the_suite_has_its_result_in_a_sentence() -> None:
    (tests,) = read((GOOD, DOUBTED, BAD))
    assert tests[-1].tag == "system-out"
    assert tests[-1].text == "1 of 3 cases cannot be played; 1 may have changed; 1 plays as before"
    (tests,) = ET.fromstring(junit(SUITE, (GOOD,), ("room:v1",), left_out=1).encode())
    assert tests[-1].text == "The level plays as before; 2 were not judged"


def test_a_new_failure_in_a_pass_is_its_first_reason() -> None:
    new = Finding("dies in 1 of 40 episodes; before: in 0 of 40", (3,))
    root = read((replace(GOOD, new_failures=(new,)),))
    (text,) = [element.text for element in root.findall(".//testcase/system-out")]
    assert text == "new failure: dies in 1 of 40 episodes; before: in 0 of 40\nmet in 40 of 40 episodes"
    assert {element.get("name"): element.get("value") for element in root.iter("property")}[
        "room:v0.new_failures"
    ] == "1"


def test_each_case_is_a_testcase() -> None:
    (tests,) = read((GOOD, DOUBTED, BAD))
    assert tests.attrib == {"name": "game", "tests": "3", "failures": "1", "errors": "1", "skipped": "0"}
    good, doubted, bad = tests.iter("testcase")
    assert [testcase.attrib for testcase in (good, doubted)] == [
        {"name": "room:v0", "classname": "game"},
        {"name": "room:v1", "classname": "game"},
    ]
    assert [child.tag for child in good] == ["system-out"]
    (error,), (failure,) = doubted, bad
    assert (error.tag, error.attrib) == ("error", {"type": "review", "message": "review: reward is lower"})
    assert error.text == "reward is lower\ndies `in` the <hall> & more"
    assert (failure.tag, failure.get("type")) == ("failure", "fail")
    assert failure.get("message") == "fail: it cannot be played"


def test_figures_are_properties() -> None:
    root = read((GOOD, BAD))
    properties = {element.get("name"): element.get("value") for element in root.iter("property")}
    assert properties == {
        "seed": "7",
        "error": "0.05",
        "room:v0.verdict": "pass",
        "room:v0.status": "as_before",
        "room:v0.new_failures": "0",
        "room:v0.episodes": "40",
        "room:v0.pass_rate": "1.0000",
        "room:v0.progress": "1.0000",
        "room:v0.reward": "0.7000",
        "room:v0.baseline_episodes": "40",
        "room:v0.baseline_pass_rate": "0.7500",
        "room:v0.baseline_progress": "0.8750",
        "room:v0.baseline_reward": "0.4250",
        "room:v2.verdict": "fail",
        "room:v2.status": "unplayable",
        "room:v2.new_failures": "0",
    }


def test_the_outcome_of_a_retraining_is_included() -> None:
    trained = FinishedRetraining("met", 4096, 60.0, 200_000, True, 97)
    retrained = RetrainingResult(
        "learned", "feasible: <after> …", trained, figures_of(summaries(3, 1)), (0.2, 0.9), None, "p", None
    )
    root = read((replace(BAD, retrained=retrained), GOOD))
    bad, _ = root.iter("testcase")
    assert [(child.tag, child.text) for child in bad][1:] == [("system-out", "feasible: <after> …")]
    properties = {element.get("name"): element.get("value") for element in root.iter("property")}
    assert (properties["room:v2.retrained"], properties["room:v2.retrained_pass_rate"]) == ("learned", "0.7500")
    assert "room:v0.retrained" not in properties


def test_cases_that_were_not_judged_are_errors() -> None:
    root = ET.fromstring(junit(SUITE, (GOOD,), ("room:v1", "room:v2")).encode())
    check(root)
    (tests,) = root
    assert (tests.get("tests"), tests.get("failures"), tests.get("errors")) == ("3", "0", "2")
    assert [testcase.get("name") for testcase in tests.iter("testcase") if testcase.find("error") is not None] == [
        "room:v1",
        "room:v2",
    ]


def test_a_report_without_cases_is_valid() -> None:
    (tests,) = read(())
    assert (tests.get("tests"), tests.get("failures"), tests.get("errors")) == ("0", "0", "0")


@pytest.mark.parametrize("odd", ["\0", "\x1b[31m", "\x0b", "\ufffe", "]]>", "<![CDATA[", "&#0;", "\U0001f512", "\r"])
def test_any_text_gives_valid_xml(odd: str) -> None:
    text = f"a{odd}b"
    report = replace(BAD, name=f"room{odd}", causes=(text, "more"))
    root = read((report,))
    (failure,) = root.iter("failure")
    shown = re.sub("[\0\x1b\x0b\ufffe]", "\ufffd", text)
    assert (failure.text or "").replace("\n", "\r").startswith(shown.replace("\n", "\r"))


def test_a_case_without_reasons_is_valid() -> None:
    root = read((replace(GOOD, causes=()), replace(DOUBTED, causes=())))
    good, doubted = root.iter("testcase")
    assert not list(good)
    assert doubted[0].get("message") == "review: "
