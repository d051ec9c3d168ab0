"""The conformance corpus: specs, traces, and the output that a monitor in any language must give for them.

The corpus is generated. Every run writes the same bytes if the C library's ``exp``, ``tanh`` and
``pow`` are the same.
"""
