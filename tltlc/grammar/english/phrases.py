"""The phrases of which the sentences of designers are made, by the rules of the grammar that they stand for."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

_MUST: Final = "must|should|shall|has to|have to|needs to|need to|ought to|will"
_CANNOT: Final = (
    "must not|should not|shall not|may not|can not|cannot|will not|must never|should never|may never|can never|"
    "has never to|mustn't|shouldn't|can't|won't|must not ever|is not allowed|are not allowed|is forbidden|never|"
    "not allowed|not permitted|isn't allowed|are forbidden"
)

DROPPED: Final = frozenset(
    "the a an player hero character user you they we it there he she i please just it's he's she's".split()
)
"""Words that say nothing, because a spec is always about the player."""

PHRASES: Final[Mapping[str, str]] = {
    "when": "when|as soon as|given|given that|in case|in case that",
    "while": "while|during|whilst",
    "as_long_as": "as long as|so long as|for as long as",
    "each_time": "whenever|every time|each time|any time|anytime|everytime|for each|for every|at every|at each|"
    "on each|"
    "on every|on|upon",
    "after": "after|once|following|from",
    "directly_after": "right after|directly after|immediately after|straight after|on the step after|"
    "at the step after|in the step after|on the frame after|on the next step after|at the next step after|"
    "one step after",
    "unless": "unless|except when|except if|except while|except during|except|unless when",
    "only_when": "only with|only if|only when|only while|only whenever|only during|only as long as|only at|only in",
    "per": "per|in each|in every|each|every|for each|for every|during each|within each|"
    "during every|in any|within|between|in one|in single|in same|during one|during single|within one|within single|"
    "throughout each|over each|for one|from one|of each|of every|in any one|within any|during any",
    "during_one": "per|in each|in every|each|every|for each|for every|during each|within each|during every|in any|"
    "in one|in single|in same|during one|during single|within one|within single|throughout each|over each|within any|"
    "during any|over one|over whole|in whole|during whole",
    "in": "in|during|while|within|throughout|over",
    "lose": "lose|loses|lose more|drop|drops",
    "gain": "gain|gains|earn|earns|get|gets|collect|score",
    "returns": "returns to|return to|is back to|is back at|goes back to|comes back to|is restored to|is reset to|"
    "is set back to|gets back to|back to|must be back at|falls back to|returns|resets to",
    "its_value": "what was|its value|value|was|where was|value was|what had been|as high as was|that|what has been|"
    "its value was|level",
    "same_as": "same as|equal to|equals|exactly|is same as|is equal to|must be same as|has same value as",
    "stay_within": "stays within|stay within|is within|remains within|remain within|must stay within|must be within|"
    "within|be within|must remain within",
    "at_end_of": "at end of|when end of",
    "total_time": "total time|total time of|total time in|total time spent|total time spent in|total duration|"
    "total duration of|total|cumulative time|cumulative time in|overall time|total of|accumulated time|"
    "accumulated time in|sum of time|time in total|total time with|total time on|total amount of time|"
    "cumulative duration of",
    "time_spent": "time spent|time spent in|time in|time of|time with|time",
    "needs": "requires|needs|depends on",
    "only_after": "only after|only once|not before|not until|comes after|happens after|only happens after",
    "iff": "iff|if and only if|exactly when|exactly if|exactly while",
    "until": "until|till|up until",
    "before": "before",
    "second": "second|further|other|another|new|more|next",
    "above": "above|over|more than|higher than",
    "below": "below|under|less than|lower than",
    "passed": "have passed|has passed|passed|are over|is over|have elapsed|elapsed|later",
    "whichever": "whichever comes first|whichever is first|whichever is earlier|whichever happens first|"
    "whichever comes earlier|whichever is sooner|whichever comes sooner",
    "before_that": "before|first|beforehand|earlier|before that",
    "between": "between|in between",
    "never": "never|never ever|at no time|under no circumstances|not ever",
    "avoid": "avoid|no|no more|don't|do not|can't|cannot|forbid|prevent|without ever|must not|must never|should not|"
    "should never|forbidden|illegal|disallowed|not allowed|may not|may never|mustn't|shouldn't|won't|"
    "can't be|cannot be|must not be|should not be|may not be|can't ever be|can never be",
    "must_not": _CANNOT,
    "must": _MUST,
    "may": "can|may|can only|may only|is allowed|allowed|can happen|can be|may be|is possible|may happen|"
    "happens|must only",
    "allowed": "allowed|permitted|ever|at all|at any time|at any point|happens|happen",
    "always": "always|at all times|all the time|the whole time|throughout|at every step|on every step|every frame|"
    "on every frame|forever|for ever|from then on|for good|for the rest|in every frame|at every frame",
    "for_good": "forever|for ever|for good|permanently|from then on|until end|till end|until end of game|"
    "until end of play|until end of run|for rest of game|for rest of play|for rest|for rest of run|always from then on|"
    "stays so forever|stays that way|stays so|remains so",
    "toggles": "changes|change|changing|toggles|toggle|toggling|switches|switch|switching|flips|flip|flipping|"
    "changes state|changes value|"
    "switches state|turns on or off|switches on or off",
    "changes_of": "changes of|changes in|toggles of|switches of|flips of|switchings of",
    "having_lasted": "having lasted|after having lasted|after it lasted|after it has lasted|after lasting",
    "eventually": "eventually|at some point|sooner or later|later|finally|at some time|afterwards",
    "also": "also|immediately|instantly|right away|at once|too|as well",
    "next_step": "on the next step|at the next step|in the next step|next step|one step later|on next step|"
    "in next step|at next step|the step after|immediately after",
    "stops": "must stop|must end|is interrupted|is cancelled|stops being true|must be over",
    "lasts": "lasts|last|must last|should last|has to last|shall last|always lasts|must always last|needs to last|"
    "takes|must take|stays on|lasts for|holds for|holds",
    "each": "each|every|any",
    "for_total": "for a total of|for a total time of|for a combined",
    "spend": "spend|spends|be",
    "for": "for|for the next|for a full|for next|for at least|at least for|for the following",
    "for_last": "for last|for previous|throughout last|during last|over last|for whole last|for at least last|for past",
    "within": "within|in|by|in under|within under|in less than|within less than|in at most|in no more than|"
    "no later than|within at most|inside|"
    "in the next|within the next|in next|within next|not later than|under",
    "first": "in the first|within the first|during the first|in first|within first|during first|for the first|"
    "for first",
    "all_time": "time|episode|run|recording|session|play|game|match",
    "in_last": "in last|during last|within last|for last|throughout last|over last",
    "must_have_been": "must have been|must have been true|must have held|must have stayed|should have been|"
    "has to have been",
    "last_long": "last|lasts|take|go on|continue|go on for|last for|stay on|be on",
    "stop": "end|stop|be over|finish|be finished",
    "hold": "hold|must hold|have to hold|need to hold|maintain|must maintain",
    "with": "have|has|had|having|with|own|owns|owning|holding|carrying|wearing",
    "fewer": "less|fewer|lower|below|under|smaller",
    "further": "more|higher|above|greater|over|up",
    "only_last": "can only last|may only last|must only last|should only last|only lasts|can only last for|"
    "may only last for|only lasts for|can only stay on for|can only be on for",
    "not_more_often": "not more often than every|no more often than every|not more often than once every|"
    "no more often than once every|not more often than once in|must not be more often than every|"
    "not more often than once per|no more often than once per",
    "only": "only|only ever|can only|may only|must only|should only|can only ever|may only ever|only may|only can|"
    "must only ever",
    "sometime": "at some point|at some time|sometime|sooner or later|at one point",
    "directly_follow": "directly follow|immediately follow|come right after|come directly after|follow directly|"
    "come straight after|directly come after|be right after|happen right after|happen directly after|"
    "immediately come after",
    "directly_follows": "directly follows|immediately follows|comes right after|comes directly after|"
    "follows directly|must directly follow|must immediately follow|must always directly follow|"
    "always directly follows|must always come right after|must come right after|must come directly after|"
    "must come straight after|must always come directly after|always comes right after|"
    "always comes directly after|must follow directly after|must always immediately follow|should directly follow|"
    "may only directly follow|may only come right after|may only come directly after|can only come right after|"
    "can only come directly after|can only directly follow",
    "directly_followed_by": "is directly followed by|is immediately followed by|must be directly followed by|"
    "must be immediately followed by|is always directly followed by|must always be directly followed by|"
    "should be directly followed by",
    "followed_by": "be followed by|is followed by|leads to|lead to|causes|cause|triggers|trigger|is answered by|"
    "be answered by|results in|result in",
    "go_to": "go to|go straight to|go directly to|go straight into|jump to|jump straight to|change to|"
    "change directly to|switch to|switch directly to|directly go to|become|"
    "go straight|go directly|jump straight|switch directly|change directly|directly become",
    "happen": "must happen|may happen|can happen|must occur|may occur|can occur|should happen|should occur|happens|"
    "occurs|happen|occur|must begin|may begin|can begin|must start|may start|can start|may only happen|"
    "can only happen|may only occur|can only occur|must be used|may be used|can be used|can only be used|"
    "may only be used|is allowed|must come|comes",
    "at": "at|in",
    "remain": "stay|stays|remain|remains|stay so|stays so|stay there|stays there|stay that way|stays that way|"
    "remains so|stay at|stays at|remain at|remains at|stay like that|stay in|stays in",
    "highest": "highest|maximum|greatest|largest|peak|max|highest value of|maximum of|max of|highest value",
    "mean": "mean|mean of|average|average of|avg|mean value of|average value of",
    "lowest": "lowest|minimum|smallest|least|min|lowest value of|minimum of|min of|lowest value",
    "so_far": "so far|until now|until then|ever|up to now|up to then|yet|till now",
    "at_most_for": "for at most|for no more than|for no longer than|no longer than|at most for|not longer than|"
    "for up to|"
    "for a maximum of|never for longer than|never for more than|never longer than",
    "exactly": "exactly|precisely",
    "later": "later|afterwards|after that|after",
    "straight": "straight|in a row|without a break|continuously|or more|in one go|at a stretch|without interruption",
    "or_more": "or more|or longer",
    "last": "last|previous",
    "then": "then|and then|and after that|and finally|, then|, and then|, and after that",
    "at_once": "at the same time|simultaneously|together|at the same step|at same time|at same step|"
    "on the same frame|at a time|at any one time|at once|at the same moment|in the same step",
    "at_end": "at the end|at the last step|on the last step|at end|at last step|on last step",
    "at_start": "at the start|at the beginning|on the first step|at the first step|initially|at start|at beginning|"
    "on first step|at first step|in the beginning|started with|began with|when started|had at start|had at beginning",
    "times": "times|time|x",
    "times_relation": "only",
    "not": "not|isn't|don't|doesn't|aren't|do not|does not",
    "be": "is|are|be|being|am|gets|get|has|have|having|stays|stay|remains|remain|holds|hold|happens|happen|occurs|"
    "occur|come|comes|is being|must be|should be|is on|is active|is set|is true|stays true|remains true|is held|"
    "be true|happens to be|stays on|is still|still|is pressed|pressed|is shown|shown|is visible|visible|is displayed|"
    "be shown|be pressed|be visible|be displayed|be active|be on|must be shown|must be visible|must be displayed|"
    "should be shown|should be visible|must stay shown|must be pressed|must be on|must be active|again|is back|"
    "is back again|comes back|returns|must happen|must occur|must hold",
    "is": "is|equals|is equal to|equal to|is exactly|has|at|in|on|stays|remains|stays at|remains at|is at|is in|"
    "is on|"
    "be|was|stays in|must be|should be|shall be|has to be|needs to be|must be at|must be in|must equal|must stay|"
    "must stay at|must stay in|must remain|should stay|waits at|waits in|must wait at",
    "is_not": "is not|isn't|not|not in|not at|is not in|is not at|does not equal|differs from|is other than|"
    "must not be|should not be|must not equal|cannot be|can't be|may not be|mustn't be|shouldn't be",
    "earlier": "before|earlier|ago|beforehand|before that",
    "in_total": "in total|total|altogether|overall|in all|in sum|in whole run|in whole game|in entire run|"
    "in entire game|cumulative|cumulatively|over whole run|over whole game|over entire run|over entire game|"
    "during whole run|during whole game|in whole level|over whole level|all in all|all together|summed up|added up|"
    "combined|accumulated|throughout whole run|throughout whole game|in whole episode|over whole episode|"
    "across whole run|across whole game|per game|per run|per episode",
    "falls_below": "falls below|drops below|goes below|drops under|falls under",
    "rises_above": "rises above|goes above|goes over",
    "comes_to": "reaches|hits|gets to|comes to|arrives at|climbs to|gets up to|reach|hit|get to|come to|climb to|"
    "get up to",
    "is_never": "is never|never",
    "when_it": "at start of|at beginning of|at|when|on|from|as of|at time of|at moment of|at step of|"
    "as when|than when|than at|than at start of|as at|as at start of",
    "at_least_every": "at least every|at least once every|at least once each|at least once in every|"
    "at least once in any|at least once per|at least once within any|at least one time every|no less often than every|"
    "every|at least once in each|not less often than every",
    "any_order": "in any order|, in any order|in whatever order|in no particular order|regardless of order|"
    "in either order|no matter order|, in whatever order|order does not matter|, order doesn't matter|"
    ", order does not matter",
    "cooldown": "has cooldown of|has cooldown|cooldown of|cooldown|cooldown is|has cooldown time of|"
    "cools down for|with cooldown of|has delay of",
    "meanwhile": "in between|between|between them|in between them|on way|meanwhile|along way|in meantime|between two",
    "only_goes": "only goes|goes only|only changes|changes only|only moves|moves only|only switches|switches only|"
    "only cycles|cycles|cycles through|only cycles through|always goes|always changes|can only go|"
    "may only go|must only go|can only change|may only change|only advances|only steps|only goes through|only runs|"
    "must only change|goes always|only follows|only passes through|only progresses|progresses only",
    "in_that_order": "in that order|in this order|in order|, in that order|, in this order",
    "in_any": "within|in|in any|per|during|within any|every|each",
    "was": "was|was previously|had been|was before",
    "has_been": "has been|have been|has been true|has been on|has been active|had been|has stayed|has remained|"
    "has held|has been in|has been at|has stayed in|has stayed at|held",
    "becomes": "becomes|become|turns|turn|changes to|change to|turns to|turns into|goes to|go to|switches to|"
    "switch to|"
    "enters|enter|is set to|gets|moves to|changes into|reaches|starts being|turned|became",
    "leaves": "leaves|leave|stops being|exits|is left",
    "begins": "has begun|have begun|has started|"
    "begins|begin|began|starts|start|started|begun|triggers|is triggered|goes up|turns on|happens|appears|"
    "turns true",
    "begins_first": "begins|start of|beginning of|begin of|onset of|starts of|beginnings of",
    "ends": "is lost|lost|gets lost|ends|end|ended|stops|stop|stopped|is over|goes down|turns off|"
    "is finished|disappears|turns false|"
    "finishes|is put out|goes out|fails|breaks down|is extinguished",
    "is_out": "is out|is gone",
    "was_before": "was true before|on the step before|on step before|on the frame before|on frame before|"
    "at the step before|at step before|was true on step before",
    "ever": "ever|has ever happened|has happened|has already happened",
    "previously": "previously|prev",
    "at_most": "at most|"
    "no more than|not more than|up to|maximum|max|maximum of|not above|less than or equal to|"
    "not exceed|no higher than|no longer than|not longer than",
    "at_least": "at least|"
    "no less than|not less than|no fewer than|minimum|min|minimum of|not below|"
    "greater than or equal to|more than or equal to",
    "more": "more than|greater than|above|over|exceeds|higher than|longer than|exceed|bigger than|larger than",
    "less": "less than|fewer than|below|under|lower than|shorter than|smaller than",
    "falls": "falling|dropping|decreasing|shrinking|going down|"
    "decreases|decrease|drops|drop|falls|fall|shrinks|shrink|goes down|go down|is reduced|gets lower|"
    "is lowered|"
    "goes lower|is decreased|sinks|declines",
    "rises": "rising|increasing|growing|going up|"
    "increases|increase|rises|rise|grows|grow|goes up|go up|gets higher|is raised|goes higher|is increased",
    "stays": "stays the same|stay the same|stays same|stay same|remains the same|remains same|does not change|"
    "doesn't change|do not change|must not change|"
    "cannot change|can't change|may not change|should not change|"
    "mustn't change|shouldn't change|must stay the same|must remain the same|must stay constant|"
    "must remain constant|must be constant|has to stay the same|"
    "is unchanged|stays constant|remains unchanged|stays unchanged|unchanged|constant|"
    "remains constant|keeps its value|is constant|frozen|is frozen|stays frozen|stays put|not change|fixed|is fixed|"
    "are unchanged|are constant|are frozen|are fixed|stay constant|stay unchanged|remain unchanged|"
    "stay fixed|stay frozen|keep their values|keep their value|keep same value|keeps same value|must be unchanged|"
    "must stay unchanged",
    "changes": "changes|change|changed|varies",
    "come": "go on|come on|be triggered|be raised|sound|ring|start|begin|come|trigger|appear|take place|be reached",
    "go_off": "go off|goes off|went off",
    "move": "go|goes|change|changes|switch|switches|jump|jumps|move|moves|pass|passes|transition|transitions|turn|"
    "turns",
    "to": "to|straight to|directly to|right to|immediately to|into|straight into|directly into",
    "goes": "goes|go|must go|should go|goes through|must go through|order|goes in order|sequence|follows|must follow",
    "next_value": "then|, then|and then|, and then|followed by",
    "is_forbidden": "is forbidden|forbidden|is not allowed|not allowed|must not happen|is illegal|illegal|"
    "is invalid|never happens|is impossible|must never happen|never|is never allowed|cannot happen",
    "transition": "transition|transitions|direct transition|going|switching|changing|jumping|changes|"
    "going straight|going directly",
    "when_only": "when|if|while|during|whenever|as long as|in|at|with|in case",
    "stays_so": "stays that way|stays so|remains so|remains that way|stays like that|stays forever|never ends|"
    "never goes away|never stops|stays on forever|must stay so|must stay that way|stays true forever|"
    "stays that way forever|is permanent|for ever",
    "stays_on": "stays|stays on|must stay|must stay on|remains|stays active|must last|lasts|keeps on|remains on|"
    "stays true|remains true|must remain|must hold|has to stay on|should stay on|goes on|continues|stay on|"
    "remain on|holds|keeps going|stays up",
    "was_true": "was true|was on|was active|was|has been true|has been on|has been|was used|has been used|was pressed|"
    "has been pressed|was shown|was visible|was seen|was heard|happened|has happened|occurred|has occurred",
    "anymore": "anymore|any more|any longer|now",
    "no_longer": "is no longer",
    "by_then": "by then|first|in time|in this time|in that time|in meantime|meanwhile|in between",
    "once_before": "once before|sometime before|at some time before|previously once",
    "happened_before": "happened before|has happened before|happened earlier|has happened earlier|happened already|"
    "happened once|has happened once|once before|came before|has come before|happened at some time before",
    "distance": "distance|difference|gap|absolute difference|absolute distance|abs difference",
    "just_before": "just before|right before|immediately before|directly before|just before that|right before that|"
    "until just before|up to then|until then|before that|just beforehand",
    "keeps": "stays|remains|is always|always|must stay|must remain|will stay|stays forever|keeps being|always stays",
    "many": "many|much",
    "end_with": "finish with|end with|end up with|finish having|finishes with|ends with|must end with|must finish with|"
    "ends up with",
    "finally": "finally|in the end|ultimately|at the very end|when it ends",
    "never_above": "never rises above|never exceeds|never goes above",
    "never_below": "never drops below|never falls below|never goes below|doesn't drop below|does not drop below",
    "per_step": "per step|each step|in one step|every step|from one step to next|from step to step|per frame|"
    "in single step|at once|between steps|between two steps|per tick|at time|at one time|in one go|in step|each time",
    "pause_of": "cooldown of|cooldown|pause of|pause of at least|wait at least|wait|gap of|gap of at least",
    "in_sequence": "consecutive|successive|next|another",
    "until_then": "until then|up to then|all the time until then|until that step|all the way|on the way|along the way",
    "resets_to": "resets to|is reset to|is set to|gets set to|goes back to|is back to|is back at",
    "in_row": "in a row|consecutively|in succession|successively|one after other|running",
    "means": "means|means that|implies that",
    "count_of": "count|number of|number of times",
    "duration_of": "duration|duration of|time_in|hold_time|length of|how long",
    "happened": "happened|has happened|was|occurred|has occurred|came|has come|was true|was last true|held|began",
    "no_sooner": "no sooner than|no earlier than|not sooner than|not earlier than|not before|never sooner than|"
    "never earlier than|must not come sooner than|must not come earlier than",
    "from_now": "later|from now|afterwards",
    "ago": "ago|earlier|before",
    "previous": "previous|prev|old|previous value of|last value of|last",
}  # fmt: skip
"""Maps each rule of the grammar to its phrases, which `|` separates."""


def grammar_text() -> str:
    """Return the rules of the phrases, in the syntax of lark."""
    lines = []
    for name, texts in PHRASES.items():
        known = {tuple(word for word in text.split() if word not in DROPPED) for text in texts.split("|")}
        alternatives = " | ".join(" ".join(map(_symbol, phrase)) for phrase in sorted(known) if phrase)
        lines.append(f"_w_{name}: {alternatives}")
    return "\n".join(lines)


def _symbol(word: str) -> str:
    return "_COMMA" if word == "," else f'"{word}"'
