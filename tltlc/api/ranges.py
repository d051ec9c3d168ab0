"""Which values can an expression take, if its signals and params stay in their ranges?

``cases`` splits an expression into the cases of its ``when``. ``bound`` returns an ``Interval``
that contains every value of a case, for signals and params in a given region.
"""

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
