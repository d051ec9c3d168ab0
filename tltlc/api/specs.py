"""Types of signals, and the standard library."""

from tltlc.core.names import full_name
from tltlc.resolve.imports import standard_library
from tltlc.resolve.spec import ValueType
from tltlc.resolve.units import TYPES

__all__ = [
    "TYPES",
    "ValueType",
    "full_name",
    "standard_library",
]
