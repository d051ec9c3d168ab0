# Branching: three switches in order, then the exit behind an open barrier, alive throughout; 600 steps.

extends "common.gd"

const ATOMS = ["near(s1)", "near(s2)", "near(s3)"]
const LABELS = [
	"F(near(s1) & X F(near(s2) & X F(near(s3) & X F(open_right & near(e_right) | open_left & near(e_left))))) & G alive",
	"F(near(s2) & X F(near(s3) & X F(open_right & near(e_right) | open_left & near(e_left)))) & G alive",
	"false",
	"F(near(s3) & X F(open_right & near(e_right) | open_left & near(e_left))) & G alive",
	"F(open_right & near(e_right) | open_left & near(e_left)) & G alive",
	"G alive",
]
const ENGLISH = [
	"Reach near(s1), then near(s2), then near(s3), then (open_right and near(e_right)) or (open_left and near(e_left)), and keep alive throughout.",
	"Reach near(s2), then near(s3), then (open_right and near(e_right)) or (open_left and near(e_left)), and keep alive throughout.",
	"The spec is violated.",
	"Reach near(s3), then (open_right and near(e_right)) or (open_left and near(e_left)), and keep alive throughout.",
	"Reach (open_right and near(e_right)) or (open_left and near(e_left)), and keep alive throughout.",
	"Keep alive throughout.",
]
const VERDICTS = [
	Verdict.PENDING,
	Verdict.PENDING,
	Verdict.VIOLATED,
	Verdict.PENDING,
	Verdict.PENDING,
	Verdict.HOLDING,
]
const SWITCH = [0, 1, -1, 2, -1, -1]
const NEXT = [1, 3, -1, 4, -1, -1]
const TRAP = 2
const EXITS = 4
const GOAL = 5
const LIMIT = 600


class Sample:
	var distance_s1: float
	var distance_s2: float
	var distance_s3: float
	var distance_e_right: float
	var distance_e_left: float
	var open_right: bool
	var open_left: bool
	var health: float


# States 0, 1 and 3 wait for a switch, 4 for an exit, 5 is the goal, 2 is the trap.
# Returns false, and the state stays, where a signal is not finite.
func step(sample: Sample) -> bool:
	if not _is_finite(sample.distance_s1):
		return _refuse("distance(s1) is not finite")
	if not _is_finite(sample.distance_s2):
		return _refuse("distance(s2) is not finite")
	if not _is_finite(sample.distance_s3):
		return _refuse("distance(s3) is not finite")
	if not _is_finite(sample.distance_e_right):
		return _refuse("distance(e_right) is not finite")
	if not _is_finite(sample.distance_e_left):
		return _refuse("distance(e_left) is not finite")
	if not _is_finite(sample.health):
		return _refuse("health is not finite")

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
	elif state == EXITS:
		reached = _leave(sample, alive)
	else:
		var switch: int = SWITCH[state]
		var distance: float = sample.distance_s3
		if switch == 0:
			distance = sample.distance_s1
		elif switch == 1:
			distance = sample.distance_s2
		var closeness: float = _near(distance)
		if closeness > 0.0:
			state = NEXT[state]
			robustness = closeness if closeness < alive else alive
			reached = (switch + 1) / 4.0
		else:
			robustness = -closeness if -closeness < alive else alive
			limiting = ATOMS[switch]
			reached = (switch + 1.0 + closeness) / 4.0
	accepting = state == GOAL
	verdict = VERDICTS[state]
	_advance(reached, accepting or state == TRAP, LIMIT)
	return true


# Through an open barrier, if there is one; returns the progress.
func _leave(sample: Sample, alive: float) -> float:
	var right_open: float = 1.0 if sample.open_right else -1.0
	var left_open: float = 1.0 if sample.open_left else -1.0
	var right_near: float = _near(sample.distance_e_right)
	var left_near: float = _near(sample.distance_e_left)
	var right: float = right_open if right_open < right_near else right_near
	var left: float = left_open if left_open < left_near else left_near
	var nearest: float = right if right > left else left
	if nearest > 0.0:
		state = GOAL
		robustness = nearest if nearest < alive else alive
		return 1.0
	robustness = -nearest if -nearest < alive else alive
	if right >= left:
		limiting = "open_right" if right_open <= right_near else "near(e_right)"
	else:
		limiting = "open_left" if left_open <= left_near else "near(e_left)"
	return (4.0 + nearest) / 4.0


func label() -> String:
	return LABELS[state]


func label_english() -> String:
	return ENGLISH[state]
