"""The words of English that sentences about games are made of: the words that join, compare and count."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from tltlc.grammar.keywords import UNITS_ELSEWHERE
from tltlc.grammar.mistakes.sentences.words import Phrase, phrases

SUBJECTS: Final = phrases(
    "the player", "player", "the character", "character", "the hero", "hero", "the user", "you", "they", "it", "we",
    "he", "she", "i", "there", "the", "a", "an",
)  # fmt: skip
"""Words for who plays, and articles, which say nothing."""
FILLERS: Final = phrases(
    "player", "character", "hero", "user", "every", "each", "ever", "straight", "in a row", "must", "should",
    "must not", "whole", "entire", "please",
)  # fmt: skip
"""Words that make a clause a sentence of English: no operator of the language stands for them."""
COPULAS: Final = phrases(
    "is", "are", "be", "being", "been", "am", "have", "has", "having", "gets", "get", "getting", "is being",
    "stays", "stay", "staying", "remains", "remain", "remaining", "holds", "happens", "happen",
    "it is", "must be", "should be",
)  # fmt: skip
"""Words between a subject and what it is."""
MODALS: Final = phrases("must", "should", "shall", "has to", "have to", "needs to", "need to", "ought to", "will")
ALWAYS: Final = phrases("always", "at all times", "all the time", "the whole time", "throughout", "the entire time")
NEVER: Final = phrases("never", "never ever", "at no time", "under no circumstances", "not ever")
NOT: Final = phrases("not", "isn't", "is not", "aren't", "are not", "don't", "doesn't", "do not", "does not", "no")
PROHIBITIONS: Final = (
    *NEVER,
    *phrases("avoid", "no", "don't", "do not", "can't", "cannot", "forbid", "prevent", "without ever", "forbidden"),
    *(
        (*modal, *word)
        for modal in (*MODALS, ("can",), ("may",))
        for word in phrases("not", "never", "not ever", "avoid")
    ),
    *phrases("mustn't", "shouldn't", "won't"),
)
"""What begins a sentence about what must not be."""

SAME_STEP: Final = phrases(
    "if", "when", "whenever", "while", "during", "as long as", "so long as", "every time", "each time", "any time",
    "anytime", "as soon as", "given", "given that", "in case", "everytime", "for as long as",
)  # fmt: skip
"""Words before a condition on the same step."""
FROM_THEN: Final = phrases("after", "once", "following")
"""Words before an event, from which on something is asked for."""
DIRECTLY_AFTER: Final = phrases(
    "right after", "directly after", "immediately after", "straight after", "just after", "step after", "frame after",
)  # fmt: skip
"""Words before an event, at the step behind which something is asked for."""
ONLY_WHEN: Final = tuple(
    ("only", *word) for word in phrases("with", "if", "when", "while", "whenever", "during", "as long as")
)
ONLY_AFTER: Final = (
    *phrases("only after", "only once", "not before", "not until", "never before", "comes after", "happens after"),
    *((*modal, *verb, "after") for modal in MODALS for verb in phrases("come", "happen", "only happen", "only come")),
)
UNLESS: Final = phrases("unless", "except when", "except if", "except while", "except during")

LASTING: Final = phrases("while", "during", "as long as", "so long as", "for as long as")
"""Words before a condition that may have to hold until a goal is reached."""
UNTIL: Final = phrases("until", "till", "up until", "before")
AT_ONCE: Final = phrases("at the same time", "at once", "simultaneously", "together", "at the same step")

COMPARISONS: Final[Mapping[Phrase, str]] = {
    **dict.fromkeys(
        phrases(
            "at most", "no more than", "not more than", "up to", "maximum", "max", "maximum of", "not above",
            "less than or equal to", "not exceed",
            "no higher than", "never above", "never over", "never exceeds", "no longer than", "not longer than",
            "a maximum of", "never more than", "never longer than", "never for longer than", "never for more than",
        ),
        "<=",
    ),
    **dict.fromkeys(
        phrases(
            "at least", "no less than", "not less than", "no fewer than", "minimum", "min", "minimum of", "not below",
            "greater than or equal to", "more than or equal to",
            "never below", "never under", "a minimum of", "never less than", "never drops below", "never falls below",
            "never goes below", "doesn't drop below",
        ),
        ">=",
    ),
    **dict.fromkeys(
        phrases("more than", "greater than", "above", "over", "exceeds", "higher than", "longer than", "goes above",
                "rises above", "goes over", "go above", "rise above", "exceed"),
        ">",
    ),
    **dict.fromkeys(
        phrases("less than", "fewer than", "below", "under", "lower than", "shorter than", "drops below",
                "falls below", "goes below", "drops under", "falls under",
                "drop below", "fall below", "go below", "drop under", "fall under"),
        "<",
    ),
}  # fmt: skip
"""Maps the words of a comparison to its sign."""
NEGATED_SIGN: Final = {"<=": ">", ">": "<=", ">=": "<", "<": ">=", "==": "!=", "!=": "=="}
EQUALITIES: Final = phrases("==", "=", "===", "is", "equals", "is equal to", "equal to", "at", "reaches", "is exactly")
UNEQUAL: Final = phrases("!=", "is not", "isn't", "not", "is never", "never")
VERBS: Final = phrases(
    "reach", "get", "get to", "finish", "enter", "visit", "find", "take", "pick up", "grab", "steal", "defeat", "beat",
    "clear", "activate", "unlock", "talk to", "rescue", "destroy", "craft", "buy", "survive until", "press", "pull",
    "go to", "collect", "gather", "earn", "achieve", "obtain", "win", "complete", "try to",
    "make", "arrive at", "goal", "accomplish", "score", "do", "perform", "come to", "have", "end",
)  # fmt: skip
"""Words that begin a goal."""
SEQUENCE: Final = phrases("then", "and then", ", then", ", and then", "followed by", "and after that", "and finally")
WITHIN: Final = (
    *phrases("within", "in", "before", "by", "under", "in under", "in less than", "in at most", "in no more than"),
    *phrases("in max", "no later than", "within at most", "inside", "in the next", "within the next", "in fewer than"),
)
"""Words before a time in which something is to happen."""
FIRST_WITHIN: Final = phrases("within the first", "in the first", "during the first")
"""Words before a time from the first step on."""
FOR: Final = phrases(
    "lasts",
    "lasting",
    "lasts for",
    "for",
    "for at least",
    "for the next",
    "for a full",
    "for a total of",
    "at least for",
)
"""Words before a time for which something lasts."""

ENGLISH: Final = frozenset(
    word
    for known in (
        *(SUBJECTS, FILLERS, COPULAS, MODALS, ALWAYS, NEVER, NOT, PROHIBITIONS, SAME_STEP, FROM_THEN, ONLY_WHEN),
        DIRECTLY_AFTER,
        *(ONLY_AFTER, UNLESS, UNTIL, AT_ONCE, COMPARISONS, EQUALITIES, UNEQUAL, WITHIN, FOR, VERBS, SEQUENCE),
        phrases("of with without between times time true false all any either both neither nor next eventually and or"),
        phrases("later order first whole straight continuously allowed permitted finally immediately having but that"),
        tuple((unit,) for unit in UNITS_ELSEWHERE),
    )
    for phrase in known
    for word in phrase
)
"""All words that have a meaning in sentences."""
CHANGING: Final = frozenset(("changes", "changed", "varies", "change"))
"""Words for a change, beside the name of what changes."""
