# The parts that the handwritten monitors share: the reward, and closeness.

extends Reference

enum Verdict { SATISFIED, HOLDING, PENDING, VIOLATED }

var level_size: float = 20.0
var state: int = 0
var steps: int = 0
var verdict: int = Verdict.PENDING
var accepting: bool = false
var done: bool = false
var progress: float = 0.0
var reward: float = 0.0
var robustness: float = 0.0
var limiting: String = ""
var failed_step: int = 0
var problem: String = ""  # why the last sample was refused


func reset():
	state = 0
	steps = 0
	verdict = Verdict.PENDING
	accepting = false
	done = false
	progress = 0.0
	reward = 0.0
	robustness = 0.0
	limiting = ""
	failed_step = 0
	problem = ""


# Counts a step with this progress.
func _advance(reached: float, ends: bool, limit: int):
	steps += 1
	if verdict == Verdict.VIOLATED and failed_step == 0:
		failed_step = steps
	var gained: float = reached - progress if reached > progress else 0.0
	progress += gained
	if done:
		reward = 0.0
		return
	reward = gained - 1.0 / limit
	if verdict == Verdict.VIOLATED:
		reward -= float(limit - steps) / limit
	done = ends or steps >= limit


func _refuse(reason: String) -> bool:
	problem = reason
	return false


# The clause that the trace broke, the only one that it must not break; empty for none.
func failed_clause() -> String:
	return "keep alive" if failed_step > 0 else ""


# The atom that decides it; empty for none.
func failed_atom() -> String:
	return "alive" if failed_step > 0 else ""


# Closeness in [-1, 1]: 1 at the target, 0 at 1 m, -1 from level_size on.
func _near(distance: float) -> float:
	if distance < 1.0:
		return 1.0 - distance if distance > 0.0 else 1.0
	if distance > level_size:
		return -1.0
	var rest: float = (level_size - distance) / (level_size - 1.0)
	return rest * rest - 1.0


func _is_finite(value: float) -> bool:
	return not (is_nan(value) or is_inf(value))


# In [0, 1].  The engine's own `clamp`, `min` and `max` round to single precision.
func _in_range(value: float) -> float:
	if value < 0.0:
		return 0.0
	return value if value < 1.0 else 1.0
