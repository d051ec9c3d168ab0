"""Check that predicates stay in their ranges, and that they do not jump between cases.

To read the code, begin with :mod:`tltlc.resolve.range_proof.check`.
"""

from tltlc.resolve.range_proof.check import RangeProblem, check_predicate

__all__ = ["RangeProblem", "check_predicate"]
