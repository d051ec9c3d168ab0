"""The conformance corpus: specs, traces, and the expected output of a monitor in any language.

Every run writes the same bytes if the C library's ``exp``, ``tanh`` and ``pow`` are the same.
"""
