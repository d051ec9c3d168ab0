# Navigation: near(s1), then near(s2), then near(exit); judged at the goal, 300 steps.

extends "common.gd"

const ATOMS = ["near(s1)", "near(s2)", "near(exit)"]
const LABELS = [
	"F(near(s1) & X F(near(s2) & X F near(exit)))",
	"F(near(s2) & X F near(exit))",
	"F near(exit)",
	"true",
]
const ENGLISH = [
	"Reach near(s1), then near(s2), then near(exit).",
	"Reach near(s2), then near(exit).",
	"Reach near(exit).",
	"Nothing remains to be done.",
]
const GOAL = 3
const LIMIT = 300


class Sample:
	var distance_s1: float
	var distance_s2: float
	var distance_exit: float


# The state is the number of marks that were reached in order.  Returns false, and the state stays, where a signal is
# not finite.
func step(sample: Sample) -> bool:
	if not _is_finite(sample.distance_s1):
		return _refuse("distance(s1) is not finite")
	if not _is_finite(sample.distance_s2):
		return _refuse("distance(s2) is not finite")
	if not _is_finite(sample.distance_exit):
		return _refuse("distance(exit) is not finite")

	var reached: float = 1.0
	robustness = 1.0
	limiting = ""
	if state < GOAL:
		var distance: float = sample.distance_exit
		if state == 0:
			distance = sample.distance_s1
		elif state == 1:
			distance = sample.distance_s2
		var closeness: float = _near(distance)
		if closeness > 0.0:
			state += 1
			robustness = closeness
			reached = state / 3.0
		else:
			robustness = -closeness
			limiting = ATOMS[state]
			reached = (state + 1.0 + closeness) / 3.0
	accepting = state == GOAL
	verdict = Verdict.SATISFIED if accepting else Verdict.PENDING
	_advance(reached, accepting, LIMIT)
	return true


func label() -> String:
	return LABELS[state]


func label_english() -> String:
	return ENGLISH[state]
