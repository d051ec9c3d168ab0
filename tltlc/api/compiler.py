"""How do I get an automaton, and then a monitor or a picture of the automaton?

``compile_source`` compiles a source text. ``read_artefact`` and ``decode_artefact`` read an
automaton that was compiled before. ``emit`` returns the files for an automaton in some format: a
monitor in ``python``, a picture as ``svg``. ``encode_artefact`` returns the artefact of an automaton as
JSON data. ``imported_files`` yields the files that a source text imports, even if the text does not
compile.
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
from tltlc.resolve.imports import imported_files

__all__ = [
    "BackendOptions",
    "CompileOptions",
    "compile_source",
    "decode_artefact",
    "emit",
    "encode_artefact",
    "imported_files",
    "read_artefact",
    "unknown_spec",
]
