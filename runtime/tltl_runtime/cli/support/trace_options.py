"""The options with which ``tltlc regress --spec`` judges recorded traces without a suite."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Final

import click

from tltlc.api import fileio, record

_ENDINGS: Final = (".fspa.json", ".tltl", ".json")
"""The endings of files with specs."""


@record
class TraceOptions:
    """The options of ``tltlc regress`` that have to do with recorded traces.

    ``spec``, ``now``, ``baseline`` and ``judged_as`` are None if the options are not given.
    ``thresholds`` has the thresholds that options set. ``others`` maps further options and arguments
    that do not fit ``--spec`` to whether they are given.
    """

    spec: str | None
    now: Path | None
    baseline: Path | None
    judged_as: str | None
    thresholds: Mapping[str, float]
    others: Mapping[str, bool]

    def check(self) -> None:
        """Raise UsageError unless the options fit together."""
        if self.spec is None:
            self._check_unused()
            return
        if not self.spec:
            raise click.UsageError("--spec is empty: name the spec that judges the recorded traces")
        paths = {"--now": (self.now, "to judge"), "--baseline": (self.baseline, "to compare with")}
        for option, (path, which) in paths.items():
            if path is None:
                raise click.UsageError(f"--spec needs {option}: name the recorded traces {which}, a file or a folder")
        if used := next((name for name, is_given in self.others.items() if is_given), None):
            hint = "" if used.startswith("--") else "; put several traces into one folder"
            raise click.UsageError(f"--spec judges recorded traces without a suite: leave out {used}{hint}")
        self._check_rates()

    def _check_unused(self) -> None:
        if self.now is not None:
            raise click.UsageError("--now works only with --spec, which names the spec that judges the traces")
        given = [*([] if self.judged_as is None else ["--judged-as"]), *map(threshold_option, self.thresholds)]
        if given:
            raise click.UsageError(f"{given[0]} works only with --spec; in a suite, write it as a key of the case")

    def _check_rates(self) -> None:
        from tltl_runtime.regression.suite.thresholds import Thresholds

        thresholds = Thresholds(**self.thresholds)
        if thresholds.fail_rate > thresholds.pass_rate:
            other = "fail_rate" if "pass_rate" in self.thresholds else "pass_rate"
            bound = f"of at {'most' if other == 'fail_rate' else 'least'} "
            bound += f"{thresholds.pass_rate if other == 'fail_rate' else thresholds.fail_rate:g}"
            raise click.UsageError(
                f"--fail-rate is {thresholds.fail_rate:g}, above --pass-rate, {thresholds.pass_rate:g}: "
                f"give {threshold_option(other)} a value {bound}"
            )


def threshold_option(threshold: str) -> str:
    """Return the option that sets a threshold: ``--pass-rate`` for ``pass_rate``."""
    return f"--{threshold.replace('_', '-')}"


def path_option(_: click.Context, option: click.Parameter, value: str | None) -> Path | None:
    """Return the path that an option names; None if the option is not given.

    Raises BadParameter if the value is empty.
    """
    if value == "":
        raise click.BadParameter("it is empty: name a file or a folder", param=option)
    return None if value is None else Path(value)


def spec_label(spec: str) -> str:
    """Return a name for a spec: ``NAME`` of ``FILE:NAME``, or the name of the file without its ending."""
    file, name = fileio.split_spec_name(spec)
    file_name = Path(file).name
    ending = next((ending for ending in _ENDINGS if file_name.endswith(ending)), "")
    return name or file_name.removesuffix(ending) or "spec"
