"""The parts of JSON schemas that the arguments and the results of several tools share."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

Schema = dict[str, Any]

_POSITION: Final[Schema] = {
    "type": "object",
    "required": ["line", "column", "offset"],
    "properties": {
        "line": {"type": "integer", "minimum": 1},
        "column": {"type": "integer", "minimum": 1},
        "offset": {"type": "integer", "minimum": 0, "description": "in characters, from 0"},
    },
}

_EDIT: Final[Schema] = {
    "type": "object",
    "required": ["start", "end", "text", "replaces"],
    "properties": {
        "start": _POSITION,
        "end": _POSITION,
        "text": {"type": "string", "description": "the new text between `start` and `end`"},
        "replaces": {"type": "string", "description": "the old text between `start` and `end`"},
    },
}

DIAGNOSTIC: Final[Schema] = {
    "type": "object",
    "required": ["code", "severity", "title", "help", "labels", "fixes"],
    "properties": {
        "code": {"type": "string", "description": "for example TLT0201; the tool `explain` has a page on each code"},
        "severity": {"enum": ["error", "warning", "note"]},
        "title": {"type": "string"},
        "help": {"type": ["string", "null"]},
        "labels": {
            "type": "array",
            "items": {
                "type": "object",
                "required": ["file", "start", "end", "message"],
                "properties": {
                    "file": {"type": "string"},
                    "start": _POSITION,
                    "end": _POSITION,
                    "message": {"type": "string"},
                },
            },
        },
        "fixes": {
            "type": "array",
            "description": "alternatives, the likeliest first; the edits of one fix are in the file of the first label",
            "items": {
                "type": "object",
                "required": ["title", "applicability", "edits"],
                "properties": {
                    "title": {"type": "string"},
                    "applicability": {
                        "enum": ["safe", "maybe"],
                        "description": "`safe` keeps the meaning of the text; `maybe` is a guess",
                    },
                    "edits": {"type": "array", "items": _EDIT},
                },
            },
        },
    },
}

_FILE_NAME: Final[Schema] = {"type": "string", "pattern": r"^[^\u0000\ud800-\udfff]*$"}
"""A text that can be part of the name of a file: without null characters, and without halves of characters."""

PATHS: Final[Schema] = {"type": "array", "items": _FILE_NAME}


def path_schema(description: str) -> Schema:
    """Return the schema of the name of a file, a folder or a Git revision."""
    return {**_FILE_NAME, "description": description}


SETTINGS: Final[Schema] = {
    "params": {
        "type": "object",
        "additionalProperties": {"type": ["string", "number", "boolean"]},
        "description": 'new values of params, for example {"level_size": "30 m"}',
    },
    "libraries": {**PATHS, "description": "folders to search for imports, besides those of tltl.toml"},
    "state_budget": {
        "type": "integer",
        "minimum": 1,
        "description": "the most states that an automaton may have (default: 50000)",
    },
}

TEXT: Final[Schema] = {
    "type": "string",
    "description": "the source text; with `path`, it is used instead of the file's content, such as unsaved changes",
}

SOURCE: Final[Schema] = {
    "path": path_schema("a .tltl file, FILE:SPEC, or an artefact (.fspa.json)"),
    "text": TEXT,
}

SPEC: Final[Schema] = {"spec": {"type": "string", "description": "the name of a spec in the file (default: all specs)"}}

ONE_SPEC: Final[Schema] = {
    "spec": {"type": "string", "description": "the name of a spec; needed if the file has several"}
}

TEXTS: Final[Schema] = {"type": "array", "items": {"type": "string"}}


def arguments(properties: Mapping[str, Schema], required: tuple[str, ...] = ()) -> Schema:
    """Return the schema of a tool's arguments."""
    return {
        "type": "object",
        "properties": dict(properties),
        "required": list(required),
        "additionalProperties": False,
    }


def result(properties: Mapping[str, Schema], definitions: Mapping[str, Schema] | None = None) -> Schema:
    """Return the schema of a tool's result: these properties, and the diagnostics. All are required."""
    everything = {
        **properties,
        "diagnostics": {"type": "array", "items": DIAGNOSTIC},
        "left_out": {"type": "integer", "minimum": 0, "description": "how many more diagnostics there are"},
    }
    schema = {"type": "object", "properties": everything, "required": list(everything), "additionalProperties": False}
    return {**schema, "$defs": dict(definitions)} if definitions else schema


def schema_file(package: str, name: str) -> Schema:
    """Return the schema in a file of a package of tools: ``schema_file("explain", "explain.schema.json")``."""
    import tltlc.tools

    text = (Path(tltlc.tools.__path__[0]) / package / name).read_text(encoding="utf-8")
    schema: Schema = json.loads(text)
    return schema
