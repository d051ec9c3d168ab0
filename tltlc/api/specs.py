"""What types do signals have, and where is the standard library?

``TYPES`` has the dimension of each type; ``full_name`` writes a signal or predicate with its
arguments, as in artefacts.
"""

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
