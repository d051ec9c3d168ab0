"""The report on a suite as JUnit XML, which continuous integration servers show as tests."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Final
from xml.etree import ElementTree as ET

from tltl_runtime.evaluation.figures import Figures
from tltl_runtime.regression.report.case_report import CaseReport, new_failure_text
from tltl_runtime.regression.report.suite_summary import suite_summary
from tltl_runtime.regression.suite.suite import Suite

_NOT_IN_XML: Final = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""The characters that XML 1.0 does not allow, not even escaped."""

_ELEMENTS: Final = {"fail": "failure", "review": "error"}
"""The XML element of each verdict, except for ``pass``, which has none.

In JUnit, an ``error`` is a test without a result. A ``review`` becomes an ``error``, so that no
viewer hides it.
"""


def junit(suite: Suite, reports: Sequence[CaseReport], missing: Sequence[str] = (), left_out: int = 0) -> str:
    """Format the reports as a ``testsuite`` with a ``testcase`` for each case.

    The schema is junit-10 of Jenkins' xUnit plugin. The reasons of a verdict are the text of an
    element in the ``testcase``. Figures are properties of the ``testsuite``, for example
    ``CASE.pass_rate``, because a ``testcase`` cannot have properties. ``missing`` are the names of
    cases that were not judged because the run was stopped; they count as errors. The ``system-out`` of
    the ``testsuite`` is the result of the suite in one sentence, which also counts the cases that were ``left_out``.
    """
    verdicts = [report.verdict for report in reports]
    counts = {
        "tests": str(len(reports) + len(missing)),
        "failures": str(verdicts.count("fail")),
        "errors": str(verdicts.count("review") + len(missing)),
    }
    root = ET.Element("testsuites", {"name": "tltlc regress", **counts})
    tests = ET.SubElement(root, "testsuite", {"name": _xml_text(suite.path.stem), **counts, "skipped": "0"})
    properties = ET.SubElement(tests, "properties")
    for name, value in _properties(suite, reports):
        ET.SubElement(properties, "property", {"name": _xml_text(name), "value": _xml_text(value)})
    for report in reports:
        tests.append(_testcase(suite, report))
    for name in missing:
        test = ET.SubElement(tests, "testcase", {"name": _xml_text(name), "classname": _xml_text(suite.path.stem)})
        ET.SubElement(test, "error", {"type": "missing", "message": "not judged: the run was stopped before this case"})
    ET.SubElement(tests, "system-out").text = suite_summary(reports, len(missing) + left_out).sentence
    ET.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def _testcase(suite: Suite, report: CaseReport) -> ET.Element:
    test = ET.Element("testcase", {"name": _xml_text(report.name), "classname": _xml_text(suite.path.stem)})
    new = map(new_failure_text, report.new_failures) if report.has_new_failure else ()
    text = _xml_text("\n".join((*new, *report.reasons)))
    if report.verdict in _ELEMENTS:
        message = _xml_text(f"{report.verdict}: {report.headline}")
        ET.SubElement(test, _ELEMENTS[report.verdict], {"type": report.verdict, "message": message}).text = text
    elif text:
        ET.SubElement(test, "system-out").text = text
    if report.retrained:
        ET.SubElement(test, "system-out").text = _xml_text(report.retrained.text)
    return test


def _properties(suite: Suite, reports: Sequence[CaseReport]) -> Iterator[tuple[str, str]]:
    yield "seed", str(suite.seed)
    yield "error", f"{suite.error:g}"
    for report in reports:
        yield f"{report.name}.verdict", report.verdict
        yield f"{report.name}.status", report.status
        yield f"{report.name}.new_failures", str(len(report.new_failures))
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


def _xml_text(text: str) -> str:
    """Return the text, with a replacement character for each character that XML does not allow."""
    return _NOT_IN_XML.sub("\N{REPLACEMENT CHARACTER}", text)
