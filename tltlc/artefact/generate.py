"""Generate ``validator.py`` from ``fspa.schema.json``: run ``python -m tltlc.artefact.generate``.

The generated module validates artefacts without a schema library, because the import of such a
library takes longer than most compilations. Generating needs fastjsonschema, which ``pip install
tltlc[dev]`` installs.
"""

from __future__ import annotations

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
TYPED_HEAD = "(data: object, custom_formats: object = {}, name_prefix: object = None) -> object:"

RECURSIVE = ("#/definitions/expression", "#/definitions/condition")


def validator_source() -> str:
    """Return the text of ``validator.py``: a module with ``validate(data)``, which raises at the first error."""
    import fastjsonschema

    schema = json.loads((FOLDER / "fspa.schema.json").read_text(encoding="utf-8"))
    code = fastjsonschema.compile_to_code(_inline(schema, schema["definitions"]), use_default=False)
    lines = [_shorten_line(line) for line in code.splitlines() if not line.startswith(("VERSION = ", "from "))]
    imports = "from tltlc.artefact.errors import JsonSchemaValueException\n"
    return HEADER + imports + "\n".join(lines).strip() + "\n"


def _inline(node: Any, definitions: dict[str, Any]) -> Any:
    """Return the schema with every reference replaced by its definition, except recursive references.

    This makes the validator faster. A reference would become a function call, and each call builds
    the text of the value's path.
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
    """Return a line of the code that fastjsonschema generates, with the changes that the project needs.

    Removes the value and the schema from a ``raise``, the class ``Decimal``, and the exception for
    several errors. Adds types to the heads of functions, and sorts the keys in messages.
    """
    line = re.sub(r", value=.*?, name=(.*?), definition=.*, rule='(\w+)'\)$", r", \1, '\2')", line)
    line = line.replace("(JsonSchemaValueException, JsonSchemaValuesException)", "JsonSchemaValueException")
    line = line.replace(PLAIN_HEAD, TYPED_HEAD)
    return line.replace(", Decimal", "").replace("str(data_keys)", "str(sorted(data_keys))").rstrip()


if __name__ == "__main__":
    (FOLDER / "validator.py").write_text(validator_source(), encoding="utf-8")
