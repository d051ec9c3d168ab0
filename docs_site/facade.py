"""Make the reference of ``import tltlc`` from docstrings."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from typing import Any, Final

import tltlc
from docs_site.page import Page

URI: Final = "api.md"
_EXAMPLE: Final = re.compile(r"(?:^>>> .*\n?(?:^\S.*\n?)*)+", re.MULTILINE)
_EMPTY: Final = inspect.Parameter.empty


def page() -> Page:
    """Return the page: the functions, then the classes."""
    values = {name: getattr(tltlc, name) for name in tltlc.__all__ if not name.startswith("_")}
    functions = {name: value for name, value in values.items() if not isinstance(value, type)}
    lines = ["# Python, in full", "", "The functions and values of `import tltlc`.", "", "## Functions", ""]
    for name, value in functions.items():
        lines += _entry(f"tltlc.{name}", _signature(f"tltlc.{name}", value), value)
    lines += ["## Values", ""]
    for name, value in values.items():
        if name not in functions:
            lines += _entry(f"tltlc.{name}", _fields(value), value)
            for method, function in _methods(value):
                lines += ["```python", _signature(method, function), "```", "", _prose(function), ""]
    return Page(URI, "\n".join(lines), "docs/python.md")


def _entry(name: str, head: str, value: Any) -> list[str]:
    return [f"### `{name}`", "", *(["```python", head, "```", ""] if head else []), _prose(value), ""]


def _signature(name: str, function: Any) -> str:
    signature = inspect.signature(function)
    parameters = [
        _field(parameter.name, parameter.annotation, parameter.default) for parameter in signature.parameters.values()
    ]
    result = "" if signature.return_annotation is _EMPTY else f" -> {signature.return_annotation}"
    one_line = f"{name}({', '.join(parameters)}){result}"
    if len(one_line) <= 80:
        return one_line
    return "\n".join([f"{name}(", *(f"    {parameter}," for parameter in parameters), f"){result}"])


def _field(name: str, kind: Any, default: Any) -> str:
    return name + (f": {kind}" if kind is not _EMPTY else "") + (f" = {default!r}" if default is not _EMPTY else "")


def _fields(value: type) -> str:
    """Return the fields of a record with types and defaults, one a line."""
    types = inspect.get_annotations(value)
    parameters = inspect.signature(value).parameters if types else {}
    return "\n".join(
        _field(name, kind, parameters[name].default if name in parameters else _EMPTY) for name, kind in types.items()
    )


def _methods(value: type) -> Iterator[tuple[str, Any]]:
    for name, member in value.__dict__.items():
        if inspect.isfunction(member) and not name.startswith("_") and member.__doc__:
            yield name, member


def _prose(value: Any) -> str:
    """Return a docstring as Markdown: roles and double backquotes become code, examples become blocks."""
    text = inspect.cleandoc(value.__doc__ or "")
    text = re.sub(r":\w+:`~?([^`]+)`", r"`\1`", text).replace("``", "`")
    return _EXAMPLE.sub(lambda example: f"```python\n{example[0].rstrip()}\n```\n", text)
