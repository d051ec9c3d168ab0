"""The thresholds of a verdict, and how a suite sets them."""

from __future__ import annotations

from typing import Final

from tltl_runtime.support.checked_table import CheckedTable, wrong_value
from tltlc.api import Diagnostic, record

GREATEST: Final = {"pass_rate": 0.999}
"""The greatest allowed values of thresholds that must be less than 1.

No number of episodes can make a pass rate of 1 certain.
"""


@record
class Thresholds:
    """The thresholds of a verdict.

    To pass, a case needs a pass rate that is certainly at least ``pass_rate``. It fails if its pass
    rate is certainly below ``fail_rate``. Both are in [0, 1]. A change of the mean progress, or of the
    mean reward, counts only if it is at least ``progress`` or ``reward``.
    """

    pass_rate: float = 0.85
    fail_rate: float = 0.5
    progress: float = 0.05
    reward: float = 0.05


def read_thresholds(table: CheckedTable, defaults: Thresholds) -> Thresholds:
    """Read the table ``[thresholds]`` of a suite or a case, if there is one.

    ``defaults`` has the thresholds to use where the table does not set any. Errors are added to
    ``table.log``.
    """
    subtable = table.table("thresholds", needed=False)
    if subtable is None:
        return defaults
    before = len(table.log)
    values = [
        subtable.number(key, getattr(defaults, key), low=0.0, high=GREATEST.get(key, 1.0), unit="")
        for key in defaults.__match_args__
    ]
    subtable.report_unknown_keys()
    thresholds = Thresholds(*values)
    if thresholds.fail_rate > thresholds.pass_rate and len(table.log) == before:
        if "fail_rate" in subtable.entries:
            expected = f"a `fail_rate` of at most {thresholds.pass_rate:g}, the `pass_rate`"
            table.log.append(wrong_value(subtable.entries["fail_rate"], "fail_rate", expected))
        else:
            default = f"`fail_rate`, which is {thresholds.fail_rate:g} by default"
            title = f"`pass_rate` is {thresholds.pass_rate:g}, below the {default}"
            help_ = f"write a `fail_rate`, too, of at most {thresholds.pass_rate:g}"
            table.log.append(Diagnostic("TLT0803", title, (subtable.label_of("pass_rate"),), help_))
    return thresholds
