"""Check the range and continuity of predicates.

Begin with :mod:`tltlc.resolve.range_proof.check`.
"""

from tltlc.resolve.range_proof.check import RangeProblem, check_predicate

__all__ = ["RangeProblem", "check_predicate"]
