"""The tool ``check``: the errors and warnings of specs, with their fixes."""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.interfaces.mcp.answer import Answer, WrongUseError, with_diagnostics
from tltlc.interfaces.mcp.schemas import SETTINGS, TEXT, TEXTS, arguments, path_schema, result
from tltlc.interfaces.mcp.spec_argument import SpecArgument, read_spec
from tltlc.interfaces.mcp.tool import Tool
from tltlc.io.files import files_below, is_dir
from tltlc.tools.lint.importers import ImporterNames, importer_names, names_used_elsewhere
from tltlc.tools.lint.neighbours import neighbours
from tltlc.tools.lint.run import findings, view_of


def run(arguments: Mapping[str, Any]) -> Answer:
    """Check a file, a text, or all files of a folder."""
    path, text = arguments.get("path"), arguments.get("text")
    paths = [path] if path is None or text is not None or not is_dir(path) else _files(path)
    if not paths:
        raise WrongUseError(f"there is no .tltl file in `{path}`: name another folder")
    with_lint = arguments.get("lint", True)
    words = [importer_names(str(file), source) for file, source in neighbours(filter(None, paths)).items()]
    files: list[dict[str, Any]] = []
    diagnostics: list[Diagnostic] = []
    for file in paths:
        try:
            argument = read_spec({**arguments, **({} if file is None else {"path": file})})
            names, reported = _check(argument, words if with_lint else None)
        except TltlError as error:
            names, reported = None, error.diagnostics
        files.append({"file": file, "specs": names})
        diagnostics += reported
    document = {"ok": all(item.severity != "error" for item in diagnostics), "files": files}
    return with_diagnostics(document, diagnostics, _summary(len(files), diagnostics))


def _files(folder: str) -> list[str]:
    return [str(Path(folder, file)) for file in files_below(Path(folder))]


def _check(argument: SpecArgument, words: Iterable[ImporterNames] | None) -> tuple[list[str], tuple[Diagnostic, ...]]:
    """Return the names of the specs, and the warnings.

    ``words`` has the names in the files that may import this one; None if probable mistakes are not
    to be found. Errors: TltlError with all diagnostics if there are errors.
    """
    if argument.spec is not None:
        raise WrongUseError("`check` checks all specs of a file: leave out the name of the spec")
    if argument.is_artefact or words is None:
        compiled = argument.compiled()
        return [fspa.name for fspa in compiled.automata], compiled.diagnostics
    elsewhere: Container[str] = frozenset()
    if argument.source.kind == "file":
        elsewhere = names_used_elsewhere(argument.source.name, words)
    with argument.project.apply_lint_levels():
        view = replace(view_of(argument.source, argument.options), used_elsewhere=elsewhere)
        found = findings(view, argument.project.lint)
    return [spec.spec.name for spec in view.specs], tuple(finding.diagnostic for finding in found)


def _summary(files: int, diagnostics: Sequence[Diagnostic]) -> str:
    severities = [diagnostic.severity for diagnostic in diagnostics]
    counts = [(severities.count(severity), severity) for severity in ("error", "warning", "note")]
    tally = ", ".join(f"{number} {severity}{'s' * (number > 1)}" for number, severity in counts if number)
    return f"{files} file{'s' * (files > 1)}: {tally or 'nothing to report'}"


TOOL: Final = Tool(
    name="check",
    title="Check specs",
    description=(
        "Compile specs (.tltl) and report all errors, warnings and probable mistakes, with fixes as edits. Use it "
        "after each change of a spec. Give `path` (a file, or a folder for all files in it), or `text`."
    ),
    arguments=arguments(
        {
            "path": path_schema("a .tltl file, an artefact (.fspa.json), or a folder"),
            "text": TEXT,
            "lint": {
                "type": "boolean",
                "description": "also report probable mistakes in specs that compile (default: true)",
            },
            **SETTINGS,
        }
    ),
    result=result(
        {
            "ok": {"type": "boolean", "description": "true if there is no error; there may be warnings"},
            "files": {
                "type": "array",
                "items": {
                    "type": "object",
                    "required": ["file", "specs"],
                    "properties": {
                        "file": {"type": ["string", "null"], "description": "null for a text without a path"},
                        "specs": {"anyOf": [TEXTS, {"type": "null"}], "description": "null if the file has errors"},
                    },
                },
            },
        }
    ),
    run=run,
)
