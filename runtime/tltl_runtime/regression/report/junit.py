"""The report on a suite as JUnit XML, which continuous integration shows as tests."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Final
from xml.etree import ElementTree as ET

from tltl_runtime.evaluation.figures import Figures
from tltl_runtime.regression.report.case_report import CaseReport
from tltl_runtime.regression.suite.suite import Suite

_NO_XML: Final = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""What no XML 1.0 may hold, be it escaped."""

_ELEMENTS: Final = {"fail": "failure", "review": "error"}
"""A review is an ``error``, by which JUnit means a test that came to no result: nothing that shows it may hide it."""


def junit(suite: Suite, reports: Sequence[CaseReport], missing: Sequence[str] = ()) -> str:
    """A ``testsuite`` with a ``testcase`` for each case, as the schema junit-10 of Jenkins' xUnit plugin has it.

    Reasons are texts, figures properties of the ``testsuite``, since a ``testcase`` has none: ``CASE.pass_rate``.
    Cases that are ``missing``, since the run was stopped, are errors.
    """
    verdicts = [report.verdict for report in reports]
    counts = {
        "tests": str(len(reports) + len(missing)),
        "failures": str(verdicts.count("fail")),
        "errors": str(verdicts.count("review") + len(missing)),
    }
    root = ET.Element("testsuites", {"name": "tltlc regress", **counts})
    tests = ET.SubElement(root, "testsuite", {"name": _legal(suite.path.stem), **counts, "skipped": "0"})
    properties = ET.SubElement(tests, "properties")
    for name, value in _properties(suite, reports):
        ET.SubElement(properties, "property", {"name": _legal(name), "value": _legal(value)})
    for report in reports:
        tests.append(_testcase(suite, report))
    for name in missing:
        test = ET.SubElement(tests, "testcase", {"name": _legal(name), "classname": _legal(suite.path.stem)})
        ET.SubElement(test, "error", {"type": "missing", "message": "not judged: the run was stopped before"})
    ET.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def _testcase(suite: Suite, report: CaseReport) -> ET.Element:
    test = ET.Element("testcase", {"name": _legal(report.name), "classname": _legal(suite.path.stem)})
    text = _legal("\n".join(report.reasons))
    if report.verdict in _ELEMENTS:
        message = _legal(f"{report.verdict}: {report.headline}")
        ET.SubElement(test, _ELEMENTS[report.verdict], {"type": report.verdict, "message": message}).text = text
    elif text:
        ET.SubElement(test, "system-out").text = text
    if report.retrained:
        ET.SubElement(test, "system-out").text = _legal(report.retrained.text)
    return test


def _properties(suite: Suite, reports: Sequence[CaseReport]) -> Iterator[tuple[str, str]]:
    yield "seed", str(suite.seed)
    yield "error", f"{suite.error:g}"
    for report in reports:
        yield f"{report.name}.verdict", report.verdict
        for prefix, figures in (("", report.figures), ("baseline_", report.baseline)):
            if figures:
                yield from ((f"{report.name}.{prefix}{name}", value) for name, value in _figures(figures))
        if retrained := report.retrained:
            yield f"{report.name}.retrained", retrained.outcome
            yield f"{report.name}.retrained_pass_rate", f"{retrained.figures.pass_rate:.4f}"


def _figures(figures: Figures) -> Iterator[tuple[str, str]]:
    yield "episodes", str(figures.episodes)
    yield "pass_rate", f"{figures.pass_rate:.4f}"
    yield "progress", f"{figures.progress.mean:.4f}"
    yield "reward", f"{figures.reward.mean:.4f}"


def _legal(text: str) -> str:
    return _NO_XML.sub("\N{REPLACEMENT CHARACTER}", text)
