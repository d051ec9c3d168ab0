"""What types do signals have, how is a clock read, and where is the standard library?

``TYPES`` maps each type to its dimension, such as metres per second. ``clock_from_text`` reads a clock
such as ``20 Hz``.
``full_name`` returns the name of a signal or predicate with its arguments, as it is written in
artefacts. ``standard_library`` returns the folder of the library.
"""

from tltlc.core.names import full_name
from tltlc.resolve.clock import clock_from_text
from tltlc.resolve.imports import standard_library
from tltlc.resolve.spec import ValueType
from tltlc.resolve.units import TYPES

__all__ = [
    "TYPES",
    "ValueType",
    "clock_from_text",
    "full_name",
    "standard_library",
]
