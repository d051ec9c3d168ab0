"""The values that an expression can take."""

from tltlc.resolve.range_proof.cases import TooManyCasesError, cases
from tltlc.resolve.range_proof.interval import Interval, UndefinedError
from tltlc.resolve.range_proof.region import ConstrainedBox, Variable, bound

__all__ = [
    "ConstrainedBox",
    "Interval",
    "TooManyCasesError",
    "UndefinedError",
    "Variable",
    "bound",
    "cases",
]
