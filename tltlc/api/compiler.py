"""Compile specs, read artefacts, write pictures and monitors."""

from tltlc.backends import Options as BackendOptions
from tltlc.backends import emit
from tltlc.pipeline import CompileOptions, compile_source, decode_artefact, read_artefact, unknown_spec

__all__ = [
    "BackendOptions",
    "CompileOptions",
    "compile_source",
    "decode_artefact",
    "emit",
    "read_artefact",
    "unknown_spec",
]
