# Cover and Hide: near(s1), then near(s2), then near(exit), alive throughout; judged at the goal, 400 steps.  The three
# places exclude each other.

extends "common.gd"

const ATOMS = ["near(s1)", "near(s2)", "near(exit)"]
const LABELS = [
	"F(near(s1) & X F(near(s2) & X F near(exit))) & G alive",
	"F(near(s2) & X F near(exit)) & G alive",
	"false",
	"F near(exit) & G alive",
	"G alive",
]
const ENGLISH = [
	"Reach near(s1), then near(s2), then near(exit), and keep alive throughout.",
	"Reach near(s2), then near(exit), and keep alive throughout.",
	"The spec is violated.",
	"Reach near(exit), and keep alive throughout.",
	"Keep alive throughout.",
]
const VERDICTS = [Verdict.PENDING, Verdict.PENDING, Verdict.VIOLATED, Verdict.PENDING, Verdict.HOLDING]
const PLACE = [0, 1, -1, 2, -1]
const NEXT = [1, 3, -1, 4, -1]
const TRAP = 2
const GOAL = 4
const LIMIT = 400


class Sample:
	var distance_s1: float
	var distance_s2: float
	var distance_exit: float
	var health: float


# States 0, 1 and 3 wait for a place, 4 is the goal, 2 is the trap.  Returns false, and the state stays, where a
# signal is not finite or two places are near at once.
func step(sample: Sample) -> bool:
	if not _is_finite(sample.distance_s1):
		return _refuse("distance(s1) is not finite")
	if not _is_finite(sample.distance_s2):
		return _refuse("distance(s2) is not finite")
	if not _is_finite(sample.distance_exit):
		return _refuse("distance(exit) is not finite")
	if not _is_finite(sample.health):
		return _refuse("health is not finite")
	var s1: float = _near(sample.distance_s1)
	var s2: float = _near(sample.distance_s2)
	var exit: float = _near(sample.distance_exit)
	if (s1 > 0.0 and (s2 > 0.0 or exit > 0.0)) or (s2 > 0.0 and exit > 0.0):
		return _refuse("only one of near(s1), near(s2), near(exit) may hold at a time")

	var alive: float = _in_range(sample.health)
	var reached: float = 0.0
	robustness = 0.0
	limiting = ""
	if state == TRAP:
		robustness = 1.0
	elif alive <= 0.0:
		state = TRAP
	elif state == GOAL:
		robustness = alive
		reached = 1.0
	else:
		var place: int = PLACE[state]
		var here: float = exit
		var elsewhere: float = s1 if s1 > s2 else s2
		if place == 0:
			here = s1
			elsewhere = s2 if s2 > exit else exit
		elif place == 1:
			here = s2
			elsewhere = s1 if s1 > exit else exit
		if here > 0.0:
			state = NEXT[state]
			robustness = here if here < alive else alive
			reached = (place + 1) / 3.0
		else:
			# At another place the player is certainly not here, because the places exclude each other.
			robustness = -here if -here > elsewhere else elsewhere
			if robustness > alive:
				robustness = alive
			limiting = ATOMS[place]
			reached = (place + 1.0 + here) / 3.0
	accepting = state == GOAL
	verdict = VERDICTS[state]
	_advance(reached, accepting or state == TRAP, LIMIT)
	return true


func label() -> String:
	return LABELS[state]


func label_english() -> String:
	return ENGLISH[state]
