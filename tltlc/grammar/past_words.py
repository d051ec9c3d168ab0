"""The operators and functions about the trace so far, with their syntax and meaning."""

from __future__ import annotations

from typing import Final, NamedTuple


class PastWord(NamedTuple):
    """The forms in which a word is written, and what it means in a sentence."""

    forms: tuple[str, ...]
    meaning: str


OPERATORS: Final = {
    "once": PastWord(("once p", "once within 5 s p"), "p holds now or has held before (within this time)."),
    "historically": PastWord(
        ("historically p", "historically for 3 s p"),
        "p holds now and has held at all samples before (of this time).",
    ),
    "previously": PastWord(("previously p",), "p held at the sample before; false at the first sample."),
    "begins": PastWord(("begins p",), "p holds now, and did not at the sample before."),
    "ends": PastWord(("ends p",), "p held at the sample before, and does not now."),
    "since": PastWord(("p since q",), "q holds now, or has held before and p has held ever since."),
}
"""The operators by their words."""

FUNCTIONS: Final = {
    "times": PastWord(
        ("times(p)", "times(p, MAXIMUM)"), "How often p has begun to hold: a count, which stops at its maximum."
    ),
    "times_since": PastWord(
        ("times_since(p, q)", "times_since(p, q, MAXIMUM)"),
        "How often p has begun to hold since the last sample with q, which counts, too, or since the first sample.",
    ),
    "times_within": PastWord(
        ("times_within(p, 5 s)", "times_within(p, 5 s, MAXIMUM)"),
        "How often p has begun to hold in the last 5 s, with this sample: a count, which stops at its maximum.",
    ),
    "time_since": PastWord(
        ("time_since(p)", "time_since(p, MAXIMUM)"),
        "The time since p last held, in s: 0 where it holds, the maximum if it never has.",
    ),
    "time_holding": PastWord(
        ("time_holding(p)", "time_holding(p, MAXIMUM)"),
        "The time since p began to hold, in s, up to a maximum: 0 where it begins, and where it does not hold.",
    ),
    "total_time": PastWord(
        ("total_time(p)", "total_time(p, MAXIMUM)"),
        "The time for which p has held in all, in s, up to a maximum: the lengths of all steps with p together.",
    ),
    "total_time_since": PastWord(
        ("total_time_since(p, q)", "total_time_since(p, q, MAXIMUM)"),
        "The time for which p has held since the last sample with q, which counts, too, or since the first sample.",
    ),
    "total_time_within": PastWord(
        ("total_time_within(p, T)", "total_time_within(p, T, MAXIMUM)"),
        "The time for which p has held in the last T: the lengths of the steps with p in it.",
    ),
    "previous": PastWord(
        ("previous(x)", "previous(x, T)"),
        "The value of x at the sample before, or a time T ago; as long as there is no such sample, that of the first.",
    ),
    "initial": PastWord(("initial(x)",), "The value of x at the first sample."),
    "highest": PastWord(("highest(x)",), "The greatest value of x so far."),
    "lowest": PastWord(("lowest(x)",), "The least value of x so far."),
    "highest_since": PastWord(
        ("highest_since(x, q)",), "The greatest value of x since the last sample with q, or since the first sample."
    ),
    "lowest_since": PastWord(
        ("lowest_since(x, q)",), "The least value of x since the last sample with q, or since the first sample."
    ),
    "highest_within": PastWord(
        ("highest_within(x, T)",), "The greatest value of x at this sample and those at most T before."
    ),
    "lowest_within": PastWord(
        ("lowest_within(x, T)",), "The least value of x at this sample and those at most T before."
    ),
    "value_at": PastWord(
        ("value_at(x, q)",), "The value of x at the last sample with q; before the first one, its value at the start."
    ),
}
"""The functions by their names, which are not reserved."""

SINCE: Final = {
    "times": "times_since",
    "total_time": "total_time_since",
    "highest": "highest_since",
    "lowest": "lowest_since",
}
"""The functions that begin anew at an event, by those that begin at the first sample."""

MOST_STEPS_BACK: Final = 600
"""The most steps that ``previous(x, T)`` and its like look back: a monitor keeps a number for each."""

OF_EVENTS: Final = ("times_since", "total_time_since", "highest_since", "lowest_since", "value_at")
"""The functions whose second argument is a formula: the event since which, or the step at which, they ask."""

SYNONYMS: Final = {
    **dict.fromkeys(("count", "counter", "count_of"), "times"),
    **dict.fromkeys(("prev", "pre", "old"), "previous"),
    **dict.fromkeys(("duration", "how_long"), "time_holding"),
    **dict.fromkeys(("elapsed", "elapsed_since"), "time_since"),
    **dict.fromkeys(("rise", "rising", "rises", "rose", "rising_edge", "begin", "starts", "started"), "begins"),
    **dict.fromkeys(("fall", "falling", "falls", "fell", "falling_edge", "stops", "ended"), "ends"),
    **dict.fromkeys(("max_so_far", "maximum"), "highest"),
    **dict.fromkeys(("min_so_far", "minimum"), "lowest"),
    "yesterday": "previously",
    **dict.fromkeys(("count_since", "counts_since", "number_since"), "times_since"),
    **dict.fromkeys(("total_since", "time_in_all_since", "duration_since"), "total_time_since"),
    **dict.fromkeys(("max_since", "maximum_since"), "highest_since"),
    **dict.fromkeys(("min_since", "minimum_since"), "lowest_since"),
    **dict.fromkeys(("value_when", "at_event", "sample_at"), "value_at"),
    **dict.fromkeys(("total", "time_total", "cumulative_time"), "total_time"),
}
"""Names that functions and operators about the past have elsewhere."""
