"""Generate ``validator.py`` from ``fspa.schema.json``: run ``python -m tltlc.artefact.generate``.

The generated module validates artefacts without a schema library, because the import of such a
library takes longer than most compilations. Generating needs fastjsonschema, which ``pip install
tltlc[dev]`` installs.
"""

from __future__ import annotations

import ast
import json
import re
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parent

HEADER = '''"""Validates artefacts. Generated from fspa.schema.json by generate.py: do not edit."""
# ruff: noqa
# mypy: ignore-errors
# fmt: off
'''

PLAIN_HEAD = "(data, custom_formats={}, name_prefix=None):"
TYPED_HEAD = "(data: object, custom_formats: object = {}, path: JsonPath = ()) -> object:"

PLACE = re.compile(r'(?:"" \+ )?\(name_prefix or "data"\) \+ "([^"]*)"(?:\.format\(\*\*locals\(\)\))?(?: \+ "")?')
"""Python code for the place of a value, as fastjsonschema generates it; the group is the part after the prefix."""
STEP = re.compile(r"\.(\w+)|\[\{(\w+)\}\]|\[(\d+)\]")
"""A step of a place: a key, the name of a variable that holds an index, or an index."""
RAISE = re.compile(r"Exception\((.*?), value=.*?, name=(.*?), definition=(.*), rule='(\w+)'\)$")
"""The arguments of an exception: its message, the place, the schema of the value, and the keyword."""

RECURSIVE = ("#/definitions/expression", "#/definitions/condition")


def validator_source() -> str:
    """Return the text of ``validator.py``: a module with ``validate(data)``, which raises at the first error."""
    import fastjsonschema

    schema = json.loads((FOLDER / "fspa.schema.json").read_text(encoding="utf-8"))
    code = fastjsonschema.compile_to_code(_inline(schema, schema["definitions"]), use_default=False)
    lines = [_shorten_line(line) for line in code.splitlines() if not line.startswith(("VERSION = ", "from "))]
    imports = (
        "from tltlc.artefact.errors import JsonSchemaValueException\nfrom tltlc.artefact.locations import JsonPath\n"
    )
    return HEADER + imports + "\n".join(lines).strip() + "\n"


def _inline(node: Any, definitions: dict[str, Any]) -> Any:
    """Return the schema with the definition in place of each reference, except for recursive references.

    This makes the validator faster. A reference would become a function call, and each call builds
    the path of the value.
    """
    if isinstance(node, list):
        return [_inline(item, definitions) for item in node]
    if not isinstance(node, dict):
        return node
    reference = node.get("$ref")
    if isinstance(reference, str) and reference not in RECURSIVE:
        return _inline(definitions[reference.rsplit("/", 1)[1]], definitions)
    return {key: _inline(value, definitions) for key, value in node.items()}


def _shorten_line(line: str) -> str:
    """Adapt a line of the code that fastjsonschema generates.

    Exceptions get the violated rule as data instead of a message. The path of a value becomes a tuple
    instead of a text. The class ``Decimal`` and the exception for several errors are removed, and the
    heads of functions get types.
    """
    line = RAISE.sub(_exception_arguments, line)
    line = PLACE.sub(_path, line)
    line = line.replace("(JsonSchemaValueException, JsonSchemaValuesException)", "JsonSchemaValueException")
    return line.replace(PLAIN_HEAD, TYPED_HEAD).replace(", Decimal", "").rstrip()


def _exception_arguments(match: re.Match[str]) -> str:
    """Return the code of an exception for a match of ``RAISE``, with new arguments.

    The arguments are those of :class:`~tltlc.artefact.errors.JsonSchemaValueException`: the path, the
    rule, what the schema says under the rule, and perhaps fields.
    """
    message, place, schema, rule = match.groups()
    definition = ast.literal_eval(schema)[rule]
    if rule == "dependencies":
        # A schema has several dependencies; only the message says which one is broken.
        needed, field = re.findall(r"missing dependency (\w+) for (\w+)", message)[0]
        definition = {field: needed}
    elif rule in ("required", "additionalProperties"):
        (names,) = re.findall(r"\b\w+_keys\b", message)
        return f"Exception({place}, {rule!r}, {definition!r}, sorted({names}))"
    return f"Exception({place}, {rule!r}, {definition!r})"


def _path(match: re.Match[str]) -> str:
    """Return the code of a tuple for a match of ``PLACE``, such as ``(*path, 'states', i, 'id')``."""
    steps = [repr(key) if key else index for key, *indices in STEP.findall(match[1]) for index in ["".join(indices)]]
    return f"({', '.join(['*path', *steps])})" if steps else "path"


if __name__ == "__main__":
    (FOLDER / "validator.py").write_text(validator_source(), encoding="utf-8")
