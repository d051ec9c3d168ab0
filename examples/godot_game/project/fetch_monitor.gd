# Monitor of the specification `fetch`, written by tltlc.
#
# Fetch the key, open the door with it, board the ferry, and walk to the beacon; do not meet the
# guard.
#
#     F(at(key, 0.8) & X F(at(door, 1.2) & X F(at(ferry, 1.2) & X F at(beacon, 1)))) & G !caught & G
#     !fallen
#
# For Godot 3.  `step` allocates nothing, except for a notice.  In a game:
#
#     const Monitor = preload("fetch_monitor.gd")
#     var monitor = Monitor.new()
#     var sample = Monitor.Sample.new()
#
#     sample.clear()  # at each step: then set its members
#     if monitor.step(sample):
#         print(monitor.progress, monitor.reward)
#     else:
#         push_error(monitor.message())
#
# A sample with a signal that was never set is refused.  A game that sets only the events that
# happened calls `sample.sparse()` instead of `clear`: then bools are false.

extends Reference

## What the verdict would be if the trace ended here: for good, so far, not yet, never.
enum Verdict { SATISFIED, HOLDING, PENDING, VIOLATED }

## Why a sample was refused: a number is missing, or not finite; an atom divides by zero, takes a
## root or power that does not exist, or is too large to compute; exclusive atoms hold at once; a
## param is not in its range; a bool is missing.
enum Problem { NONE, NOT_FINITE, BY_ZERO, NO_ROOT, TOO_LARGE, TOGETHER, WRONG_PARAM, NOT_SET }

## Names as the spec has them, and the members of a sample, in the same order as the signals.
const SIGNALS: Array = [
	"distance(key)",
	"distance(door)",
	"distance(ferry)",
	"distance(beacon)",
	"caught",
	"fallen",
]
const FIELDS: Array = [
	"distance_key",
	"distance_door",
	"distance_ferry",
	"distance_beacon",
	"caught",
	"fallen",
]
const ATOMS: Array = [
	"at(key, 0.8)",
	"at(door, 1.2)",
	"at(ferry, 1.2)",
	"at(beacon, 1)",
	"caught",
	"fallen",
]

## For each state: what remains to be satisfied, the same in words, the verdict, whether it is
## accepting, whether an episode ends on entry.
const LABELS: Array = [
	"F(at(key, 0.8) & X F(at(door, 1.2) & X F(at(ferry, 1.2) & X F at(beacon, 1)))) & G(!caught & !fallen)",
	"F(at(door, 1.2) & X F(at(ferry, 1.2) & X F at(beacon, 1))) & G(!caught & !fallen)",
	"false",
	"F(at(ferry, 1.2) & X F at(beacon, 1)) & G(!caught & !fallen)",
	"F at(beacon, 1) & G(!caught & !fallen)",
	"G(!caught & !fallen)",
]
const LABELS_ENGLISH: Array = [
	"Reach at(key, 0.8), then at(door, 1.2), then at(ferry, 1.2), then at(beacon, 1); avoid caught throughout; and avoid fallen throughout.",
	"Reach at(door, 1.2), then at(ferry, 1.2), then at(beacon, 1); avoid caught throughout; and avoid fallen throughout.",
	"The spec is violated.",
	"Reach at(ferry, 1.2), then at(beacon, 1); avoid caught throughout; and avoid fallen throughout.",
	"Reach at(beacon, 1), avoid caught throughout, and avoid fallen throughout.",
	"Avoid caught throughout, and avoid fallen throughout.",
]
const VERDICTS: Array = [
	Verdict.PENDING,
	Verdict.PENDING,
	Verdict.VIOLATED,
	Verdict.PENDING,
	Verdict.PENDING,
	Verdict.HOLDING,
]
const ACCEPTING: Array = [false, false, false, false, false, true]
const ENDS: Array = [false, false, true, false, false, true]

## What a step can fail at: the clause that it breaks, and the atom that decides it; "" for none.
const FAILED_CLAUSES: Array = ["avoid caught", "avoid fallen"]
const FAILED_ATOMS: Array = ["caught", "fallen"]


## A sample, in SI units.  A number that is not finite counts as missing, and a bool that is null.
class Sample:
	var distance_key: float = INF  ## distance(key): In [0, 25] m.
	var distance_door: float = INF  ## distance(door): In [0, 25] m.
	var distance_ferry: float = INF  ## distance(ferry): In [0, 25] m.
	var distance_beacon: float = INF  ## distance(beacon): In [0, 25] m.
	var caught = null  ## The guard has reached the player.
	var fallen = null  ## The player is in the chasm.

	## Makes all signals missing, so that a forgotten one is detected.
	func clear() -> void:
		distance_key = INF
		distance_door = INF
		distance_ferry = INF
		distance_beacon = INF
		caught = null
		fallen = null

	## Makes all numbers missing, and all bools false: for games that set only the events that
	## happened.
	func sparse() -> void:
		distance_key = INF
		distance_door = INF
		distance_ferry = INF
		distance_beacon = INF
		caught = false
		fallen = false


var state: int = 0
var verdict: int = Verdict.PENDING
var accepting: bool = false  ## whether the trace so far is accepted
var done: bool = false  ## an episode ends here, or ended before
var progress: float = 0.0  ## the best so far, between 0 and 1
var reward: float = 0.0  ## of the last step; 0 after the end of the episode
var robustness: float = 0.0  ## of the edge taken, between -1 and 1
## The place in ATOMS of the atom that bounds the nearest edge that would have improved the distance
## to acceptance; -1 if the automaton moved or no edge improves it.
var limiting: int = -1
var steps: int = 0
## The number, from 1, of the first step after which no continuation of the trace can meet the
## specification; 0 if there is one.
var failed_step: int = 0
## The place in FAILED_CLAUSES and FAILED_ATOMS of what this step failed at; -1 for none.
var failure: int = -1
## What was wrong with the last sample.
var problem: int = Problem.NONE
## The number of the signal, atom, group or param that has the problem.
var which: int = 0
## Texts about values outside their range; the nearest value inside was used. Each signal and atom
## is reported once.
var notices: Array = []

var _noticed: Dictionary = {}


## Goes back to the state before the first sample.
func reset() -> void:
	state = 0
	verdict = Verdict.PENDING
	accepting = false
	done = false
	progress = 0.0
	reward = 0.0
	robustness = 0.0
	limiting = -1
	steps = 0
	failed_step = 0
	failure = -1
	problem = Problem.NONE
	which = 0


## Takes one sample.  Returns false, and leaves the state unchanged, if a signal is missing or not
## finite, an atom has no value, or exclusive atoms hold at once: see `problem` and `message`.
func step(sample: Sample) -> bool:
	problem = Problem.NONE

	var distance_key: float = sample.distance_key
	if not (distance_key >= 0.0 and distance_key <= 25.0):
		distance_key = _read(0, distance_key, 0.0, 25.0)
	var distance_door: float = sample.distance_door
	if not (distance_door >= 0.0 and distance_door <= 25.0):
		distance_door = _read(1, distance_door, 0.0, 25.0)
	var distance_ferry: float = sample.distance_ferry
	if not (distance_ferry >= 0.0 and distance_ferry <= 25.0):
		distance_ferry = _read(2, distance_ferry, 0.0, 25.0)
	var distance_beacon: float = sample.distance_beacon
	if not (distance_beacon >= 0.0 and distance_beacon <= 25.0):
		distance_beacon = _read(3, distance_beacon, 0.0, 25.0)
	if sample.caught == null and problem == Problem.NONE:
		problem = Problem.NOT_SET
		which = 4
	if sample.fallen == null and problem == Problem.NONE:
		problem = Problem.NOT_SET
		which = 5
	if problem != Problem.NONE:
		return false
	var caught: float = 1.0 if sample.caught else 0.0
	var fallen: float = 1.0 if sample.fallen else 0.0

	# caught: The guard has reached the player.
	var caught_atom: float = 2.0 * caught - 1.0
	# fallen: The player is in the chasm.
	var fallen_atom: float = 2.0 * fallen - 1.0

	var reached: float = 0.0
	if state == 0:
		# F(at(key, 0.8) & X F(at(door, 1.2) & X F(at(ferry, 1.2) & X F at(beacon, 1)))) & G(!caught &
		# !fallen)
		# at(key, 0.8): Within `near` of `x`: 1 at `x` itself, -1 as far away as possible.
		var at_key_0_8: float = 0.0
		if distance_key < 0.8:
			at_key_0_8 = 1.0 - distance_key / 0.8
		else:
			at_key_0_8 = (0.8 - distance_key) / 24.2
		if caught_atom > 0.0 or fallen_atom > 0.0:
			# caught | fallen
			state = 2
			robustness = fallen_atom if fallen_atom > caught_atom else caught_atom
			if caught_atom > 0.0:
				failure = 0
				failed_step = steps + 1
			else:
				failure = 1
				failed_step = steps + 1
			reached = 0.0
			limiting = -1
		elif at_key_0_8 <= 0.0 and caught_atom <= 0.0 and fallen_atom <= 0.0:
			# !at(key, 0.8) & !caught & !fallen
			state = 0
			robustness = _min((-caught_atom if -caught_atom < -at_key_0_8 else -at_key_0_8), -fallen_atom)
			var nearest: float = _min((-caught_atom if -caught_atom < at_key_0_8 else at_key_0_8), -fallen_atom)
			if at_key_0_8 == nearest:
				limiting = 0
			elif -caught_atom == nearest:
				limiting = 4
			else:
				limiting = 5
			reached = (1.0 + nearest) / 4.0
		else:
			# at(key, 0.8) & !caught & !fallen
			state = 1
			robustness = _min((-caught_atom if -caught_atom < at_key_0_8 else at_key_0_8), -fallen_atom)
			reached = 0.25
			limiting = -1
	elif state == 1:
		# F(at(door, 1.2) & X F(at(ferry, 1.2) & X F at(beacon, 1))) & G(!caught & !fallen)
		# at(door, 1.2)
		var at_door_1_2: float = 0.0
		if distance_door < 1.2:
			at_door_1_2 = 1.0 - distance_door / 1.2
		else:
			at_door_1_2 = (1.2 - distance_door) / 23.8
		if caught_atom > 0.0 or fallen_atom > 0.0:
			# caught | fallen
			state = 2
			robustness = fallen_atom if fallen_atom > caught_atom else caught_atom
			if caught_atom > 0.0:
				failure = 0
				failed_step = steps + 1
			else:
				failure = 1
				failed_step = steps + 1
			reached = 0.0
			limiting = -1
		elif at_door_1_2 <= 0.0 and caught_atom <= 0.0 and fallen_atom <= 0.0:
			# !at(door, 1.2) & !caught & !fallen
			state = 1
			robustness = _min((-caught_atom if -caught_atom < -at_door_1_2 else -at_door_1_2), -fallen_atom)
			var nearest: float = _min((-caught_atom if -caught_atom < at_door_1_2 else at_door_1_2), -fallen_atom)
			if at_door_1_2 == nearest:
				limiting = 1
			elif -caught_atom == nearest:
				limiting = 4
			else:
				limiting = 5
			reached = 0.25 + (1.0 + nearest) / 4.0
		else:
			# at(door, 1.2) & !caught & !fallen
			state = 3
			robustness = _min((-caught_atom if -caught_atom < at_door_1_2 else at_door_1_2), -fallen_atom)
			reached = 0.5
			limiting = -1
	elif state == 2:
		# false
		# true
		state = 2
		robustness = 1.0
		reached = 0.0
		limiting = -1
	elif state == 3:
		# F(at(ferry, 1.2) & X F at(beacon, 1)) & G(!caught & !fallen)
		# at(ferry, 1.2)
		var at_ferry_1_2: float = 0.0
		if distance_ferry < 1.2:
			at_ferry_1_2 = 1.0 - distance_ferry / 1.2
		else:
			at_ferry_1_2 = (1.2 - distance_ferry) / 23.8
		if caught_atom > 0.0 or fallen_atom > 0.0:
			# caught | fallen
			state = 2
			robustness = fallen_atom if fallen_atom > caught_atom else caught_atom
			if caught_atom > 0.0:
				failure = 0
				failed_step = steps + 1
			else:
				failure = 1
				failed_step = steps + 1
			reached = 0.0
			limiting = -1
		elif at_ferry_1_2 <= 0.0 and caught_atom <= 0.0 and fallen_atom <= 0.0:
			# !at(ferry, 1.2) & !caught & !fallen
			state = 3
			robustness = _min((-caught_atom if -caught_atom < -at_ferry_1_2 else -at_ferry_1_2), -fallen_atom)
			var nearest: float = _min((-caught_atom if -caught_atom < at_ferry_1_2 else at_ferry_1_2), -fallen_atom)
			if at_ferry_1_2 == nearest:
				limiting = 2
			elif -caught_atom == nearest:
				limiting = 4
			else:
				limiting = 5
			reached = 0.5 + (1.0 + nearest) / 4.0
		else:
			# at(ferry, 1.2) & !caught & !fallen
			state = 4
			robustness = _min((-caught_atom if -caught_atom < at_ferry_1_2 else at_ferry_1_2), -fallen_atom)
			reached = 0.75
			limiting = -1
	elif state == 4:
		# F at(beacon, 1) & G(!caught & !fallen)
		# at(beacon, 1)
		var at_beacon_1: float = 0.0
		if distance_beacon < 1.0:
			at_beacon_1 = 1.0 - distance_beacon / 1.0
		else:
			at_beacon_1 = (1.0 - distance_beacon) / 24.0
		if caught_atom > 0.0 or fallen_atom > 0.0:
			# caught | fallen
			state = 2
			robustness = fallen_atom if fallen_atom > caught_atom else caught_atom
			if caught_atom > 0.0:
				failure = 0
				failed_step = steps + 1
			else:
				failure = 1
				failed_step = steps + 1
			reached = 0.0
			limiting = -1
		elif at_beacon_1 <= 0.0 and caught_atom <= 0.0 and fallen_atom <= 0.0:
			# !at(beacon, 1) & !caught & !fallen
			state = 4
			robustness = _min((-caught_atom if -caught_atom < -at_beacon_1 else -at_beacon_1), -fallen_atom)
			var nearest: float = _min((-caught_atom if -caught_atom < at_beacon_1 else at_beacon_1), -fallen_atom)
			if at_beacon_1 == nearest:
				limiting = 3
			elif -caught_atom == nearest:
				limiting = 4
			else:
				limiting = 5
			reached = 0.75 + (1.0 + nearest) / 4.0
		else:
			# at(beacon, 1) & !caught & !fallen
			state = 5
			robustness = _min((-caught_atom if -caught_atom < at_beacon_1 else at_beacon_1), -fallen_atom)
			reached = 1.0
			limiting = -1
	elif state == 5:
		# G(!caught & !fallen)
		if caught_atom > 0.0 or fallen_atom > 0.0:
			# caught | fallen
			state = 2
			robustness = fallen_atom if fallen_atom > caught_atom else caught_atom
			if caught_atom > 0.0:
				failure = 0
				failed_step = steps + 1
			else:
				failure = 1
				failed_step = steps + 1
			reached = 0.0
			limiting = -1
		else:
			# !caught & !fallen
			state = 5
			robustness = -fallen_atom if -fallen_atom < -caught_atom else -caught_atom
			reached = 1.0
			limiting = -1

	robustness += 0.0
	verdict = VERDICTS[state]
	accepting = ACCEPTING[state]
	steps += 1
	var before: float = progress
	if reached > progress:
		progress = reached
	if done:
		reward = 0.0
	else:
		reward = progress - before - (1.0 / 300.0)
		if verdict == Verdict.VIOLATED:
			reward = reward - (300.0 - float(steps)) / 300.0
		done = ENDS[state] or steps >= 300
	return true


## What remains to be satisfied.
func label() -> String:
	return LABELS[state]


## The label in words.
func label_english() -> String:
	return LABELS_ENGLISH[state]


## The name of the limiting atom, "" for none.
func limiting_atom() -> String:
	return "" if limiting < 0 else ATOMS[limiting]


## The clause that the step `failed_step` broke, "" if only several clauses together cannot be met
## any more.
func failed_clause() -> String:
	return "" if failure < 0 else FAILED_CLAUSES[failure]


## The atom that decides it, "" for none: the one that had to hold but did not, or else the one that
## must not hold but did.
func failed_atom() -> String:
	return "" if failure < 0 else FAILED_ATOMS[failure]


## Why the last sample was refused.
func message() -> String:
	match problem:
		Problem.NONE:
			return ""
		Problem.NOT_FINITE:
			return "step %d: no finite number for the signal `%s`" % [steps + 1, SIGNALS[which]]
		Problem.NOT_SET:
			return "step %d: the signal `%s` is not set" % [steps + 1, SIGNALS[which]]
	var reason: String = "is too large to compute"
	if problem == Problem.BY_ZERO:
		reason = "divides by zero"
	elif problem == Problem.NO_ROOT:
		reason = "takes a root or power that does not exist"
	return "step %d: the atom `%s` %s" % [steps + 1, ATOMS[which], reason]


# --- helpers ---


func _refuse(reason: int, place: int) -> bool:
	problem = reason
	which = place
	return false


# The nearest value inside a range; the first time is reported.  `place` is the number of a signal,
# or the number of signals plus the number of an atom.
func _clamped(place: int, value: float, low: float, high: float) -> float:
	var nearest: float = low if value < low else high
	if not _noticed.has(place):
		_noticed[place] = true
		var count: int = SIGNALS.size()
		var name: String = SIGNALS[place] if place < count else ATOMS[place - count]
		var kind: String = "signal" if place < count else "atom"
		var texts: Array = [steps + 1, kind, name, value, low, high, nearest]
		notices.append("step %d: the %s `%s` is %s, outside [%s, %s]: it counts as %s" % texts)
	return nearest


# Brings a signal into its range, or records that it is not a finite number.
func _read(place: int, value: float, low: float, high: float) -> float:
	if problem != Problem.NONE:
		return 0.0
	if not _is_number(value):
		problem = Problem.NOT_FINITE
		which = place
		return 0.0
	return _clamped(place, value, low, high)


# The function of the engine rounds to single precision.
func _min(x: float, y: float) -> float:
	return y if y < x else x


# Whether a value is finite, and not NAN.
func _is_number(value: float) -> bool:
	return not (is_nan(value) or is_inf(value))
