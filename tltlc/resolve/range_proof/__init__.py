"""Check the range and continuity of predicates. The result is proved, wrong at a point, or unproved."""

from tltlc.resolve.range_proof.check import RangeProblem, check_predicate

__all__ = ["RangeProblem", "check_predicate"]
