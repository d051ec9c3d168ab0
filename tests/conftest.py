"""What holds for every test."""

from __future__ import annotations

from hypothesis import settings

# How long an example takes says more of what else the machine does than of the code.
settings.register_profile("fuzz", deadline=None, print_blob=True)
# The same examples in every run, so that a change is judged by what it changes; `make fuzz` draws others.
settings.register_profile("tests", deadline=None, derandomize=True)
settings.load_profile("tests")
