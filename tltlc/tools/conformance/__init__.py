"""The conformance corpus: specs, traces, and what every monitor says of them, whatever its language.

It is the same byte for byte at each run, as far as the C library's ``exp``, ``tanh`` and ``pow`` are.
"""
