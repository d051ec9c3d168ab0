"""How versions of Godot differ in their GDScript."""

from __future__ import annotations

from collections.abc import Mapping

from tltlc.core.record import record
from tltlc.program import snippets


@record
class Dialect:
    """How a version of Godot differs from other versions.

    ``version`` is the name of the version in templates, and ``title`` its name for readers.
    ``base`` is Godot's class of reference-counted objects. ``functions`` maps numeric functions of
    the monitor's program to functions of Godot with exactly the same results. Functions in
    ``swapped`` get their arguments in reverse order, because Godot returns the last of equal values
    (0 and -0) where the program needs the first. ``typed`` says whether GDScript has typed arrays
    and enum types, and ``wide`` whether its strings have escapes for characters above U+FFFF.
    """

    version: str
    title: str
    base: str
    functions: Mapping[str, str]
    swapped: frozenset[str]
    typed: bool
    wide: bool

    def types(self) -> dict[str, str]:
        """Map each name of a type in the templates to the type in this version: ``"ints"`` to ``"Array[int]"``."""
        arrays = {"strings": "String", "bools": "bool", "ints": "int", "floats": "float", "arrays": "Array"}
        arrays["verdict_array"] = "Verdict"
        types = {name: f"Array[{element}]" if self.typed else "Array" for name, element in arrays.items()}
        enums = {"verdict": "Verdict", "problem": "Problem"}
        return types | {name: enum if self.typed else "int" for name, enum in enums.items()}

    def string_literal(self, text: str) -> str:
        """Return a string literal with escapes for characters that do not print.

        NUL characters are left out, because they would end the string in the engine.
        """
        return snippets.string_literal(text.replace("\0", ""), self._escape)

    def _escape(self, character: str) -> str:
        code = ord(character)
        if 0xD800 <= code < 0xE000:
            return "?"
        if code > 0xFFFF:
            return f"\\U{code:06x}" if self.wide else character
        return {"\n": "\\n", "\r": "\\r", "\t": "\\t"}.get(character, f"\\u{code:04x}")
