"""How do I get an automaton, and a monitor or picture of it?

``compile_source`` compiles a source text. ``read_artefact`` and ``decode_artefact`` read an
automaton that was compiled before. ``emit`` returns the files of a target, such as ``python`` or
``svg``. ``encode_artefact`` returns an artefact as JSON data.
"""

from tltlc.backends import Options as BackendOptions
from tltlc.backends import emit
from tltlc.pipeline import (
    CompileOptions,
    compile_source,
    decode_artefact,
    encode_artefact,
    read_artefact,
    unknown_spec,
)

__all__ = [
    "BackendOptions",
    "CompileOptions",
    "compile_source",
    "decode_artefact",
    "emit",
    "encode_artefact",
    "read_artefact",
    "unknown_spec",
]
