"""C99 and C++17, by GNU's compilers with every warning an error, and with sanitizers."""

from __future__ import annotations

from tests.conformance.runner import Runner

STRICT = ("-O1", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-fsanitize=address,undefined")
_SOURCE = ("-DTLTL_MAIN", "{name}_monitor.h", "-o", "{name}_c", "-lm")

RUNNERS = (
    Runner(
        name="c",
        target="c",
        build=("gcc", "-std=c99", *STRICT, "-x", "c", *_SOURCE),
        run=("./{name}_c",),
        tools=("gcc",),
    ),
    Runner(
        name="c++",
        target="c",
        build=("g++", "-std=c++17", *STRICT, "-x", "c++", *_SOURCE),
        run=("./{name}_c",),
        tools=("g++",),
    ),
)
