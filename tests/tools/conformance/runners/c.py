"""C99 and C++17, compiled by GNU's compilers with every warning an error.

The program of a single monitor is built with ``-O1`` and sanitizers. The program of many monitors
is built with sanitizers in C++; in C it is built without, and by :data:`OPTIMIZED` with ``-O1``, which takes four
times as long.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path

from tests.tools.conformance.runner import Runner, execute
from tltlc.core.record import replace

STRICT = ("-Wall", "-Wextra", "-Wpedantic", "-Werror")
SANITIZED = ("-fsanitize=address,undefined", "-fno-sanitize-recover=all")
C = ("gcc", "-x", "c", "-std=c99")
CPP = ("g++", "-x", "c++", "-std=c++17")
_SOURCE = ("-DTLTL_MAIN", "{name}_monitor.h", "-o", "{name}_c", "-lm")

# Each trace runs in a child process, so that every run starts with unchanged variables.
_DRIVER = r"""
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>
#include <stdlib.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

int run(const char *name, int argc, char **argv);

int main(int argc, char **argv) {
    for (int i = 1; i + 1 < argc; i += 2) {
        int status = 0;
        printf("@@ %s\n", argv[i + 1]);
        fprintf(stderr, "@@ %s\n", argv[i + 1]);
        fflush(stdout);
        char full[] = "--full";
        char *arguments[] = {argv[0], full, argv[i + 1], NULL};
        const pid_t child = fork();
        if (child == 0) exit(run(argv[i], 3, arguments));
        waitpid(child, &status, 0);
        fprintf(stderr, "@@status %d\n", WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status));
    }
    return 0;
}
"""


def link(compiler: Sequence[str], folder: Path, names: Sequence[str]) -> None:
    """Build the program ``monitors`` from all headers, included in one translation unit."""
    lines = ["#define TLTL_MAIN"]
    for name in names:
        lines += [f"#define main main_of_{name}", f'#include "{name}_monitor.h"', "#undef main"]
    lines += ["int run(const char *name, int argc, char **argv);"]
    lines += ["int run(const char *name, int argc, char **argv) {"]
    lines += [f'    if (strcmp(name, "{name}") == 0) return main_of_{name}(argc, argv);' for name in names]
    (folder / "monitors.c").write_text("\n".join([*lines, "    return 70;", "}", ""]))
    (folder / "driver.c").write_text(_DRIVER)
    execute([*compiler, "monitors.c", "driver.c", "-o", "monitors", "-lm"], folder)


RUNNERS = (
    Runner(
        name="c",
        target="c",
        build=(*C, "-O1", *STRICT, *SANITIZED, *_SOURCE),
        run=("./{name}_c",),
        build_all=partial(link, (*C, *STRICT)),
        run_all=("./monitors",),
        tools=("gcc",),
    ),
    Runner(
        name="c++",
        target="c",
        build=(*CPP, "-O1", *STRICT, *SANITIZED, *_SOURCE),
        run=("./{name}_c",),
        build_all=partial(link, (*CPP, *STRICT, *SANITIZED)),
        # Detecting leaks takes longer than the rest of the run, so only the programs of single monitors do it.
        run_all=("env", "ASAN_OPTIONS=detect_leaks=0", "./monitors"),
        tools=("g++",),
    ),
)

WITHOUT_REGISTERS = replace(
    RUNNERS[0], name="c -DTLTL_NO_REGISTERS", build_all=partial(link, (*C, "-DTLTL_NO_REGISTERS", *STRICT))
)
VERDICT_ONLY = replace(
    RUNNERS[0], name="c -DTLTL_VERDICT_ONLY", build_all=partial(link, (*C, "-DTLTL_VERDICT_ONLY", *STRICT))
)
"""Its rows have only the columns step, state and verdict."""
OPTIMIZED = replace(RUNNERS[0], name="c -O1", build_all=partial(link, (*C, "-O1", *STRICT)))
