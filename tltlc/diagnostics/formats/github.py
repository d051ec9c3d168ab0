"""Diagnostics as workflow commands of GitHub Actions, which shows them beside the lines of a file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tltlc.diagnostics.diagnostic import Diagnostic

_COMMANDS = {"error": "error", "warning": "warning", "note": "notice"}


def render(diagnostics: Sequence[Diagnostic], *, color: bool = False) -> str:
    """Return a workflow command for each diagnostic, such as ``::error file=a.tltl,line=3…``, one on each line.

    ``color`` has no effect.
    """
    return "".join(_command(diagnostic) + "\n" for diagnostic in diagnostics)


def workflow_command(name: str, text: str, properties: Mapping[str, str | int]) -> str:
    """Return the command ``::NAME PROPERTIES::TEXT`` without a line end, escaped as GitHub requires."""
    property_list = ",".join(f"{key}={_escape_property(str(value))}" for key, value in properties.items())
    return f"::{name} {property_list}::{_escape_data(text)}"


def _command(diagnostic: Diagnostic) -> str:
    properties: dict[str, str | int] = {}
    label_message = ""
    if diagnostic.labels:
        label = diagnostic.labels[0]
        label_message = label.message
        line, column = label.source.position(label.span.start)
        end_line, end_column = label.source.position(label.span.end)
        properties = {"file": label.source.name, "line": line, "endLine": end_line}
        if line == end_line:
            # GitHub accepts columns only within one line; its end column is inclusive.
            properties |= {"col": column, "endColumn": max(column, end_column - 1)}
    properties["title"] = diagnostic.code
    text = "\n".join(part for part in (diagnostic.title, label_message, diagnostic.help) if part)
    return workflow_command(_COMMANDS[diagnostic.severity], text, properties)


def _escape_data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _escape_property(text: str) -> str:
    return _escape_data(text).replace(":", "%3A").replace(",", "%2C")
