"""The tool ``test``: run the ``test`` blocks of a file."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from tltlc.diagnostics.diagnostic import TltlError
from tltlc.interfaces.compiled_input import artefact_error
from tltlc.interfaces.mcp.answer import Answer, guarded, with_diagnostics
from tltlc.interfaces.mcp.schemas import SETTINGS, SOURCE, SPEC, arguments, result
from tltlc.interfaces.mcp.spec_argument import read_spec
from tltlc.interfaces.mcp.tool import Tool
from tltlc.monitor.spec_tests import TestResult, run_tests


def run(arguments: Mapping[str, Any]) -> Answer:
    """Run the test blocks of a file, or those of one spec."""
    return guarded({"passed": 0, "failed": 0, "tests": []}, lambda: _run(arguments))


def _run(arguments: Mapping[str, Any]) -> Answer:
    compiled = read_spec(arguments).compiled()
    if compiled.program is None:
        raise TltlError([artefact_error(compiled.name)])
    results = run_tests(compiled.program, compiled.automata)
    passed = sum(result.passed for result in results)
    tests = list(map(_values, results))
    failures = [result.failure for result in results if result.failure is not None]
    lines = [
        f"{'passed' if test['passed'] else 'FAILED'}  {test['file']}:{test['line']}  {test['title']}" for test in tests
    ]
    lines.append(f"{passed} passed, {len(tests) - passed} failed")
    document = {"passed": passed, "failed": len(tests) - passed, "tests": tests}
    return with_diagnostics(document, (*compiled.diagnostics, *failures), "\n".join(lines))


def _values(result: TestResult) -> dict[str, Any]:
    test = result.test
    line = test.source.position(test.span.start)[0]
    return {
        "title": test.title,
        "spec": test.spec,
        "file": test.source.name,
        "line": line,
        "passed": result.passed,
        "failure": result.failure.title if result.failure else None,
    }


TOOL: Final = Tool(
    name="test",
    title="Run the tests of a spec",
    description=(
        "Run the `test` blocks of a spec file. Each failure is a diagnostic that points at the expectation that failed."
    ),
    arguments=arguments({**SOURCE, **SPEC, **SETTINGS}),
    result=result(
        {
            "passed": {"type": "integer", "minimum": 0},
            "failed": {"type": "integer", "minimum": 0},
            "tests": {
                "type": "array",
                "items": {
                    "type": "object",
                    "required": ["title", "spec", "file", "line", "passed", "failure"],
                    "properties": {
                        "title": {"type": "string"},
                        "spec": {"type": "string"},
                        "file": {"type": "string"},
                        "line": {"type": "integer", "minimum": 1},
                        "passed": {"type": "boolean"},
                        "failure": {"type": ["string", "null"], "description": "why the test failed"},
                    },
                },
            },
        }
    ),
    run=run,
)
