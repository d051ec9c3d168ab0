"""How many diagnostics of one kind the text output and the documents contain."""

from __future__ import annotations

import json
from io import StringIO

from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label
from tltlc.interfaces.cli.report import show


def diagnostics_of(code: str, count: int, file: str = "a.toml") -> list[Diagnostic]:
    label = Label(SourceFile(file, "key = 1\n"), Span(0, 3))
    return [Diagnostic(code, f"no key {number}", (label,)) for number in range(count)]


def text(diagnostics: list[Diagnostic], format_: str = "text") -> str:
    stream = StringIO()
    show(diagnostics, format_, stream)
    return stream.getvalue()


def test_text_shows_the_first_of_many_and_counts_the_rest() -> None:
    output = text(
        [*diagnostics_of("TLT0802", 4000), *diagnostics_of("TLT0803", 1), *diagnostics_of("TLT0802", 21, "b.toml")]
    )
    assert output.count("error[TLT0802]: no key") == 40
    assert "no key 19\n" in output and "no key 20\n" not in output
    assert "error[TLT0803]: no key 0" in output
    assert output.endswith(
        "\nerror[TLT0802]: 3,980 more like the 20 above in a.toml\n"
        "\nerror[TLT0802]: 1 more like the 20 above in b.toml\n"
    )


def test_a_few_diagnostics_are_all_shown() -> None:
    assert text(diagnostics_of("TLT0802", 20)).count("no key") == 20
    assert "more like" not in text(diagnostics_of("TLT0802", 20))


def test_documents_contain_all_diagnostics() -> None:
    assert len(json.loads(text(diagnostics_of("TLT0802", 4000), "json"))["diagnostics"]) == 4000
