"""How many diagnostics of one kind people see, and programs."""

from __future__ import annotations

import json
from io import StringIO

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label
from tltlc.interfaces.cli.report import show


def found(code: str, count: int, file: str = "a.toml") -> list[Diagnostic]:
    label = Label(SourceFile(file, "key = 1\n"), Span(0, 3))
    return [Diagnostic(code, f"no key {number}", (label,)) for number in range(count)]


def text(diagnostics: list[Diagnostic], format_: str = "text") -> str:
    stream = StringIO()
    show(diagnostics, format_, stream)
    return stream.getvalue()


def test_people_see_the_first_of_many_and_how_many_there_are() -> None:
    shown = text([*found("TLT0802", 4000), *found("TLT0803", 1), *found("TLT0802", 21, "b.toml")])
    assert shown.count("error[TLT0802]: no key") == 40
    assert "no key 19\n" in shown and "no key 20\n" not in shown
    assert "error[TLT0803]: no key 0" in shown
    assert shown.endswith(
        "\nerror[TLT0802]: 3,980 more like the 20 above in a.toml\n"
        "\nerror[TLT0802]: 1 more like the 20 above in b.toml\n"
    )


def test_a_few_are_all_shown() -> None:
    assert text(found("TLT0802", 20)).count("no key") == 20
    assert "more like" not in text(found("TLT0802", 20))


def test_programs_get_all() -> None:
    assert len(json.loads(text(found("TLT0802", 4000), "json"))["diagnostics"]) == 4000
