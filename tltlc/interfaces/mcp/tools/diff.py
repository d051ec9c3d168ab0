"""The tool ``diff``: how two versions of a spec differ."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.interfaces.compiled_input import Input
from tltlc.interfaces.mcp.answer import Answer, WrongUseError, guarded, with_diagnostics
from tltlc.interfaces.mcp.schemas import SETTINGS, SOURCE, SPEC, Schema, arguments, path_schema, result, schema_file
from tltlc.interfaces.mcp.spec_argument import read_spec, search_work
from tltlc.interfaces.mcp.tool import Tool
from tltlc.io.spec_file import split
from tltlc.tools.diff.diff_json import document
from tltlc.tools.diff.pairs import diff_files
from tltlc.tools.diff.revisions import earlier_files
from tltlc.tools.diff.text import text

_SETTINGS: Final = tuple(SETTINGS)
_SCHEMA: Final = schema_file("diff", "diff.schema.json")


def run(arguments: Mapping[str, Any]) -> Answer:
    """Compare the specs of two files or texts."""
    return guarded({"diff": None}, lambda: _compare(arguments))


def _compare(arguments: Mapping[str, Any]) -> Answer:
    a, b = (_open(arguments[side], arguments) for side in ("a", "b"))
    specs = [_spec_name(arguments[side]) for side in ("a", "b")]
    one_each = any(name is not None for name in specs)
    if one_each:
        a, b = _matching_spec(specs[1], a), _matching_spec(specs[0], b)
        a.only_automaton(), b.only_automaton()
    difference = diff_files(
        (_side_name(a, specs[0]), a.automata),
        (_side_name(b, specs[1]), b.automata),
        one_each=one_each,
        by_name=arguments.get("by_name", False),
        work=search_work(arguments),
        declared=(a.program.exclusive if a.program else None, b.program.exclusive if b.program else None),
    )
    return with_diagnostics({"diff": document(difference)}, (*a.diagnostics, *b.diagnostics), text(difference))


def _open(side: Mapping[str, Any], arguments: Mapping[str, Any]) -> Input:
    """Compile one side: a file, a text, or a file at a Git revision."""
    settings = {name: arguments[name] for name in _SETTINGS if name in arguments}
    revision = side.get("revision")
    if revision is None:
        return read_spec(side, settings).compiled()
    if "path" not in side or "text" in side:
        raise WrongUseError("`revision` needs `path`, the path of the file now, and no `text`")
    path, name = split(side["path"])
    with earlier_files(revision, [path]) as old:
        before = old.old_path(path)
        if before is None:
            help_ = "name a file of that revision, by its path from the current folder"
            raise TltlError([Diagnostic("TLT0751", f"there is no file `{path}` in `{revision}`", help=help_)])
        libraries = old.old_libraries(settings.get("libraries", ()))
        source = {"path": before, **({"spec": spec} if (spec := side.get("spec", name)) else {})}
        try:
            compiled = read_spec(source, {**settings, "libraries": libraries}).compiled()
        except TltlError as error:
            raise TltlError(old.with_display_names(error.diagnostics)) from None
        return replace(compiled, name=f"{revision}:{path}", diagnostics=old.with_display_names(compiled.diagnostics))


def _spec_name(side: Mapping[str, Any]) -> str | None:
    name: str | None = side.get("spec")
    return split(side["path"])[1] if name is None and "path" in side else name


def _matching_spec(name: str | None, side: Input) -> Input:
    """Return a side with only its spec called ``name``; unchanged if it has no such spec."""
    return replace(side, automata=tuple(fspa for fspa in side.automata if fspa.name == name) or side.automata)


def _side_name(side: Input, spec: str | None) -> str:
    return side.name if spec is None else f"{side.name}:{spec}"


def _side_schema(which: str) -> Schema:
    revision = path_schema("a Git revision, such as HEAD; then `path` names a file of it")
    return {
        "type": "object",
        "properties": {**SOURCE, **SPEC, "revision": revision},
        "additionalProperties": False,
        "description": f"the {which} version",
    }


TOOL: Final = Tool(
    name="diff",
    title="Compare two specs",
    description=(
        "Say how spec B differs from spec A: whether it is equivalent, stricter or looser, with a shortest trace for "
        "each direction, and which limits, atoms, signals and params differ. Use it to check that a rewritten spec "
        "means the same. Each side is `path`, `text`, or `path` with `revision`: "
        '{"a": {"path": "hall.tltl", "revision": "HEAD"}, "b": {"path": "hall.tltl"}}. Specs with the same name are '
        "compared."
    ),
    arguments=arguments(
        {
            "a": _side_schema("first"),
            "b": _side_schema("second"),
            "by_name": {
                "type": "boolean",
                "description": "treat atoms with the same name as equal, even if their expressions differ",
            },
            **SETTINGS,
        },
        required=("a", "b"),
    ),
    result=result(
        {
            "diff": {
                "anyOf": [{"type": "null"}, {"$ref": "#/$defs/diff"}],
                "description": "null if a side has errors",
            }
        },
        {
            **_SCHEMA["$defs"],
            "diff": {name: value for name, value in _SCHEMA.items() if name not in ("$schema", "$defs", "title")},
        },
    ),
    run=run,
)
