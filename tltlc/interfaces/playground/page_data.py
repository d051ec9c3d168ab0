"""Compute everything that the playground page shows about a spec text, as JSON values."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, Final

from tltlc.automaton.fspa import NOTATIONS, Fspa, Notation
from tltlc.automaton.text import formula_text, label_text
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, Fix, Label, TltlError
from tltlc.diagnostics.shortening import shorten
from tltlc.interfaces.playground.fixes import of_errors
from tltlc.interfaces.playground.picture import picture
from tltlc.interfaces.playground.signal_sliders import signal_values
from tltlc.interfaces.playground.trace import PageLetter, idle_step, rows, shortest_traces
from tltlc.io.project import project_for
from tltlc.io.spec_file import STDIN
from tltlc.monitor.spec_tests import run_tests
from tltlc.pipeline import CompileOptions
from tltlc.resolve.registers import following_atoms
from tltlc.tools.explain.explanation import Explanation, explain
from tltlc.tools.explain.sections import failure_texts
from tltlc.tools.explain.values import json_values
from tltlc.tools.lint.fixes import OfferedFix, fixes_of_findings
from tltlc.tools.lint.run import findings, view_of

NAME: Final = "<playground>"
"""The name of the text in messages; its imports are resolved from the current folder."""

STATE_BUDGET: Final = 5_000
"""The most states of an automaton: more than anyone can look at, but few enough to be quick."""

MOST_MESSAGES: Final = 200
"""The most messages that are shown. If there are more, only the first ones are shown."""


def view(
    text: str,
    spec: str = "",
    letters: Iterable[PageLetter] = (),
    notation: Notation = "english",
    lengths: Iterable[float | None] = (),
) -> dict[str, Any]:
    """Return what the page shows about a text, one of its specs, and a trace of that spec.

    ``spec`` is the name of a spec; if none has that name, the first one is shown. ``letters`` are
    the steps of the trace. ``notation`` is the notation of formulas in the picture. ``lengths`` are
    the times since the steps before, in seconds, if the clock varies. The keys of the result:

    - ``diagnostics``: each with code, severity, title, help, labels and fixes. Failed tests are
      included. The fixes are those of :mod:`tltlc.tools.lint.fixes`, each with a title and
      edits that do not overlap. The ``start`` and ``end`` of labels and edits are offsets into the
      text in UTF-16 units, as in browsers; None for a label in another file.
    - ``more``: how many messages beyond :data:`MOST_MESSAGES` are left out.
    - ``specs``: the names of all specs; empty if there are errors.
    - ``tests``: the title of each test, its spec, and whether it passed.
    - ``spec``: None if there are errors or no specs. Otherwise its texts, its explanation as in
      ``tltlc explain``, the failures from that explanation, its atoms, signals and states, the
      picture of its automaton (:func:`tltlc.interfaces.playground.picture.picture`), the trace step
      by step (:func:`tltlc.interfaces.playground.trace.rows`), and some traces to start with.

    The contents of a text never raise an error. There is no time limit: the caller sets one.
    """
    source = SourceFile(NAME, text, "text")
    page: dict[str, Any] = {"diagnostics": [], "more": 0, "specs": [], "tests": [], "spec": None}
    libraries: tuple[Path, ...] = ()
    try:
        project = project_for(STDIN)
        libraries = project.libraries
        compiled = view_of(source, CompileOptions(library_dirs=libraries, state_budget=STATE_BUDGET))
    except TltlError as error:
        offered_fixes = of_errors(source, error.diagnostics, libraries)
        return {**page, **_messages(error.diagnostics, source, offered_fixes)}
    lint_findings = findings(compiled, project.lint)
    results = run_tests(compiled.program, (spec_view.fspa for spec_view in compiled.specs))
    messages = [
        *(finding.diagnostic for finding in lint_findings),
        *(result.failure for result in results if result.failure),
    ]
    page.update(_messages(messages, source, list(fixes_of_findings(lint_findings[:MOST_MESSAGES], compiled.module))))
    page["specs"] = [spec_view.spec.name for spec_view in compiled.specs]
    page["tests"] = [
        {"title": result.test.title, "spec": result.test.spec, "passed": result.passed} for result in results
    ]
    if compiled.specs:
        shown = next((spec_view for spec_view in compiled.specs if spec_view.spec.name == spec), compiled.specs[0])
        page["spec"] = _spec(shown.fspa, explain(shown.fspa), letters, lengths, notation)
    return page


def _messages(
    messages: Sequence[Diagnostic], source: SourceFile, offered_fixes: Sequence[OfferedFix]
) -> dict[str, Any]:
    shown = [diagnostic(message, source, offered_fixes) for message in messages[:MOST_MESSAGES]]
    return {"diagnostics": shown, "more": len(messages) - len(shown)}


def _spec(
    fspa: Fspa,
    source_explanation: Explanation,
    letters: Iterable[PageLetter],
    lengths: Iterable[float | None],
    notation: Notation,
) -> dict[str, Any]:
    explanation = json_values(source_explanation)
    svg, note = picture(fspa, notation)
    leads = {row["id"]: row["leads"] for row in explanation["states"]}
    following = following_atoms(fspa.atoms, fspa.registers)
    return {
        "name": fspa.name,
        "doc": fspa.doc,
        "formula": {name: formula_text(fspa, name) for name in NOTATIONS},
        "explanation": explanation,
        "failures": list(failure_texts(source_explanation)),
        "atoms": [{"name": atom.name, "doc": atom.doc, "follows": atom.name in following} for atom in fspa.atoms],
        "exclusive": [[fspa.atoms[index].name for index in group] for group in fspa.exclusive],
        "signals": signal_values(fspa),
        "states": [
            {
                "id": state.id,
                "label": {name: label_text(fspa, state.id, name) for name in NOTATIONS},
                "accepting": state.accepting,
                "verdict": state.verdict,
                "distance": state.distance,
                "leads": leads[state.id],
            }
            for state in fspa.states
        ],
        "picture": svg,
        "note": note,
        "rows": rows(fspa, letters, lengths),
        "idle": idle_step(fspa),
        **shortest_traces(fspa),
    }


def diagnostic(
    message: Diagnostic, source: SourceFile | None = None, offered_fixes: Iterable[OfferedFix] = ()
) -> dict[str, Any]:
    """Return a diagnostic as the JSON values that the playground page shows.

    ``source`` is the text on the page; labels in other files get no offsets. Of ``offered_fixes``,
    only the fixes of this diagnostic are used.
    """
    short = shorten(message)
    return {
        "code": short.code,
        "severity": short.severity,
        "title": short.title,
        "help": short.help,
        "labels": [_label(label, source) for label in short.labels],
        "fixes": [_fix_values(offer.fix, source) for offer in offered_fixes if source and offer.diagnostic is message],
    }


def _label(label: Label, source: SourceFile | None) -> dict[str, Any]:
    text = label.source.text
    line, column = label.source.position(label.span.start)
    here = label.source == source
    return {
        "file": None if here else label.source.name,
        "line": line,
        "column": column,
        "start": _utf16_offset(text, label.span.start) if here else None,
        "end": _utf16_offset(text, label.span.end) if here else None,
        "message": label.message,
    }


def _fix_values(fix: Fix, source: SourceFile) -> dict[str, Any]:
    edits = [
        {
            "start": _utf16_offset(source.text, edit.span.start),
            "end": _utf16_offset(source.text, edit.span.end),
            "text": edit.text,
        }
        for edit in sorted(fix.edits, key=lambda edit: edit.span.start)
    ]
    return {"title": fix.title, "edits": edits}


def _utf16_offset(text: str, offset: int) -> int:
    """Convert an offset in characters to UTF-16 units."""
    return len(text[:offset].encode("utf-16-le", "surrogatepass")) // 2
