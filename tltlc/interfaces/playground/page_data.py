"""Everything that the page shows of a text, as values that JSON has."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, Final

from tltlc.automaton.fspa import Fspa, Text
from tltlc.backends import Notation
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, Fix, Label, TltlError
from tltlc.diagnostics.shortening import shortened
from tltlc.interfaces.playground.fixes import of_errors
from tltlc.interfaces.playground.picture import picture
from tltlc.interfaces.playground.trace import Letter, idle, rows, shortest
from tltlc.interfaces.playground.values import signal_values
from tltlc.io.project import project_for
from tltlc.io.spec_file import STDIN
from tltlc.monitor.tests import run_tests
from tltlc.pipeline import CompileOptions
from tltlc.tools.explain.explanation import Explanation, explain
from tltlc.tools.explain.sections import failure_texts
from tltlc.tools.explain.values import values
from tltlc.tools.lint.fixes import Offer, of_findings
from tltlc.tools.lint.run import findings, view_of

NAME: Final = "<playground>"
"""What messages call the text; it imports as from the current folder."""

STATE_BUDGET: Final = 5_000
"""More than anybody can look at, and soon explored."""

MOST_MESSAGES: Final = 200
"""The first of them, where there are more."""


def view(text: str, spec: str = "", letters: Iterable[Letter] = (), notation: Notation = "english") -> dict[str, Any]:
    """What is to be seen of a text, of one of its specs, and of a trace of that spec.

    ``spec`` is the name of one, the first one where there is none of that name; ``notation`` is that of the picture.
    The keys of the result:

    - ``diagnostics``: each with code, severity, title, help, labels and ways_out; their ``start`` and ``end`` are
      offsets into the text in UTF-16 units, as browsers count, or None in another file.  Failed tests are among them.
      Ways out are those of :mod:`tltlc.tools.lint.fixes`, each with a title and edits that do not meet.
    - ``more``: how many messages are left out beyond :data:`MOST_MESSAGES`.
    - ``specs``: the names of all specs; none where there are errors.
    - ``tests``: the title of each test, its spec, and whether it passed.
    - ``spec``: None where there are errors, or no spec.  Else its texts, its explanation as of ``tltlc explain``, what
      breaks it as that says it, its atoms, signals and states, the picture of its automaton
      (:func:`tltlc.interfaces.playground.picture.picture`), the trace step by step
      (:func:`tltlc.interfaces.playground.trace.rows`) and some
      traces to begin with.

    Never raises for what a text holds, but takes as long as it takes.
    """
    source = SourceFile(NAME, text)
    found: dict[str, Any] = {"diagnostics": [], "more": 0, "specs": [], "tests": [], "spec": None}
    libraries: tuple[Path, ...] = ()
    try:
        project = project_for(STDIN)
        libraries = project.libraries
        seen = view_of(source, CompileOptions(library_dirs=libraries, state_budget=STATE_BUDGET))
    except TltlError as error:
        offers = of_errors(source, error.diagnostics, libraries)
        return {**found, **_told(error.diagnostics, source, offers)}
    remarks = findings(seen, project.lint)
    results = run_tests(seen.program, (each.fspa for each in seen.specs))
    said = [*(each.diagnostic for each in remarks), *(result.failure for result in results if result.failure)]
    found.update(_told(said, source, list(of_findings(remarks[:MOST_MESSAGES], seen.module))))
    found["specs"] = [each.spec.name for each in seen.specs]
    found["tests"] = [
        {"title": result.test.title, "spec": result.test.spec, "passed": result.passed} for result in results
    ]
    if seen.specs:
        shown = next((each for each in seen.specs if each.spec.name == spec), seen.specs[0])
        found["spec"] = _spec(shown.fspa, explain(shown.fspa, shown.spec.formula), letters, notation)
    return found


def _told(said: Sequence[Diagnostic], source: SourceFile, offers: Sequence[Offer]) -> dict[str, Any]:
    shown = [diagnostic(each, source, offers) for each in said[:MOST_MESSAGES]]
    return {"diagnostics": shown, "more": len(said) - len(shown)}


def _spec(fspa: Fspa, explained: Explanation, letters: Iterable[Letter], notation: Notation) -> dict[str, Any]:
    explanation = values(explained)
    drawn, note = picture(fspa, notation)
    leads = {row["id"]: row["leads"] for row in explanation["states"]}
    return {
        "name": fspa.name,
        "doc": fspa.doc,
        "formula": _texts(fspa.formula),
        "explanation": explanation,
        "failures": list(failure_texts(explained)),
        "atoms": [{"name": atom.name, "doc": atom.doc} for atom in fspa.atoms],
        "exclusive": [[fspa.atoms[index].name for index in group] for group in fspa.exclusive],
        "signals": signal_values(fspa),
        "states": [
            {
                "id": state.id,
                "label": _texts(state.label),
                "accepting": state.accepting,
                "verdict": state.verdict,
                "distance": state.distance,
                "leads": leads[state.id],
            }
            for state in fspa.states
        ],
        "picture": drawn,
        "note": note,
        "rows": rows(fspa, letters),
        "idle": idle(fspa),
        **shortest(fspa),
    }


def _texts(text: Text) -> dict[str, str]:
    return {"ascii": text.ascii, "unicode": text.unicode, "english": text.english}


def diagnostic(said: Diagnostic, source: SourceFile | None = None, offers: Iterable[Offer] = ()) -> dict[str, Any]:
    """A message as the page takes it; ``source`` is the text, of which the page can show places.

    Of the fixes that are offered it takes those of this very message.
    """
    short = shortened(said)
    return {
        "code": short.code,
        "severity": short.severity,
        "title": short.title,
        "help": short.help,
        "labels": [_label(label, source) for label in short.labels],
        "ways_out": [_way_out(each.fix, source) for each in offers if source and each.diagnostic is said],
    }


def _label(label: Label, source: SourceFile | None) -> dict[str, Any]:
    text = label.source.text
    line, column = label.source.position(label.span.start)
    here = label.source == source
    return {
        "file": None if here else label.source.name,
        "line": line,
        "column": column,
        "start": _units(text, label.span.start) if here else None,
        "end": _units(text, label.span.end) if here else None,
        "message": label.message,
    }


def _way_out(fix: Fix, source: SourceFile) -> dict[str, Any]:
    edits = [
        {"start": _units(source.text, edit.span.start), "end": _units(source.text, edit.span.end), "text": edit.text}
        for edit in sorted(fix.edits, key=lambda edit: edit.span.start)
    ]
    return {"title": fix.title, "edits": edits}


def _units(text: str, offset: int) -> int:
    """An offset in characters as one in units of UTF-16."""
    return len(text[:offset].encode("utf-16-le", "surrogatepass")) // 2
