"""Games in other processes, in any language: the protocol ``tltl/1``.

Begin with :mod:`~tltl_runtime.wire.env`. ``docs/wire.md`` describes the protocol.
"""
