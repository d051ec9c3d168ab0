"""The tool ``explain``: what a spec asks for in plain words, or what an error code means."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from tltlc.diagnostics import code_pages
from tltlc.interfaces.mcp.answer import Answer, WrongUseError, guarded, with_diagnostics
from tltlc.interfaces.mcp.schemas import SETTINGS, SOURCE, SPEC, arguments, result, schema_file
from tltlc.interfaces.mcp.spec_argument import read_spec
from tltlc.interfaces.mcp.tool import Tool
from tltlc.tools.explain.explanation import explain
from tltlc.tools.explain.markdown import markdown
from tltlc.tools.explain.text import text
from tltlc.tools.explain.values import json_values

_SCHEMA: Final = schema_file("explain", "explain.schema.json")


def run(arguments: Mapping[str, Any]) -> Answer:
    """Explain the specs of a file, or an error code."""
    if "code" in arguments:
        return _code_page(arguments["code"])
    return guarded({"specs": [], "page": None}, lambda: _explain(arguments))


def _explain(arguments: Mapping[str, Any]) -> Answer:
    compiled = read_spec(arguments).compiled()
    explanations = [explain(fspa) for fspa in compiled.automata]
    write = markdown if arguments.get("format") == "markdown" else text
    document = {"specs": list(map(json_values, explanations)), "page": None}
    return with_diagnostics(document, compiled.diagnostics, "\n".join(map(write, explanations)))


def _code_page(code: str) -> Answer:
    full_code = code.strip().upper()
    if full_code not in code_pages.codes():
        nearest = " or ".join(f"`{name}`" for name in code_pages.nearest_codes(full_code))
        raise WrongUseError(f"there is no code `{code}`: did you mean {nearest}?")
    page = code_pages.page(full_code)
    return with_diagnostics({"specs": [], "page": page}, (), page)


TOOL: Final = Tool(
    name="explain",
    title="Explain a spec or a code",
    description=(
        "Say in plain words what a spec asks for: its steps, what must always hold, what violates it, when it ends, "
        "and a shortest trace that succeeds and one that fails. Use it to find out whether a spec means what was "
        "intended. Or, with `code`, say what an error code such as TLT0201 means and how to mend the mistake."
    ),
    arguments=arguments(
        {
            **SOURCE,
            **SPEC,
            "code": {"type": "string", "description": "an error code, such as TLT0201, instead of a spec"},
            "format": {"enum": ["text", "markdown"], "description": "the format of the text (default: text)"},
            **SETTINGS,
        }
    ),
    result=result(
        {
            "specs": _SCHEMA["properties"]["specs"],
            "page": {"type": ["string", "null"], "description": "the page on an error code, as Markdown"},
        },
        _SCHEMA["$defs"],
    ),
    run=run,
)
