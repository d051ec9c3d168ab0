# Runs the generated and the handwritten monitor over the same traces, which have a line of numbers for each sample.
#
#     driver rows TRACE...               a row for each step, first of the generated, then of the handwritten one
#     driver time ROUNDS SECONDS TRACE   JSON lines: steps per second in each round

extends SceneTree

const MODULES = [preload("@SPEC@_monitor.gd"), preload("@SPEC@.gd")]
const WHO = ["generated", "by_hand"]
const VERDICTS = ["satisfied", "holding", "pending", "violated"]


func _init():
	var words: Array = []
	for word in OS.get_cmdline_args():
		if words.size() > 0 or word == "rows" or word == "time":
			words.append(word)
	if words[0] == "rows":
		for path in words.slice(1, words.size() - 1):
			for who in range(2):
				_rows(who, _samples(MODULES[who], path))
	else:
		_time(int(words[1]), float(words[2]), words[3])
	quit()


func _samples(module, path: String) -> Array:
	var found: Array = []
	var file = File.new()
	file.open(path, File.READ)
	for line in file.get_as_text().split("\n", false):
		var row: Array = []
		for cell in line.split(" "):
			# `float(cell)` would round to single precision.
			row.append(float(str2var(cell)))
		var sample = module.Sample.new()
@ASSIGNMENTS@
		found.append(sample)
	return found


func _rows(who: int, samples: Array):
	var monitor = MODULES[who].new()
	for sample in samples:
		if not monitor.step(sample):
			printerr(WHO[who], " refuses a sample")
		var cells: Array = [WHO[who], str(monitor.state), monitor.label(), VERDICTS[monitor.verdict]]
		cells += ["true" if monitor.accepting else "false", "true" if monitor.done else "false"]
		cells += ["%.17f" % monitor.progress, "%.17f" % monitor.reward, "%.17f" % monitor.robustness]
		cells += [monitor.limiting_atom() if who == 0 else monitor.limiting, monitor.label_english()]
		cells += [monitor.failed_clause(), monitor.failed_atom(), str(monitor.failed_step) if monitor.failed_step else ""]
		print(PoolStringArray(cells).join("\t"))


func _pass(monitor, samples: Array) -> float:
	var rewards: float = 0.0
	monitor.reset()
	for sample in samples:
		if not monitor.step(sample):
			printerr("a sample is refused")
		rewards += monitor.reward
	return rewards


# CPU time so far, of this thread: GDScript has no clock of its own for it.
func _cpu_seconds() -> float:
	var file = File.new()
	file.open("/proc/thread-self/schedstat", File.READ)
	return float(file.get_line().split(" ")[0]) / 1e9


func _seconds_of(monitor, samples: Array, count: int) -> float:
	var started: float = _cpu_seconds()
	for _i in range(count):
		_pass(monitor, samples)
	return _cpu_seconds() - started


func _time(rounds: int, enough_s: float, path: String):
	var monitors: Array = []
	var samples: Array = []
	var repeats: Array = [1, 1]
	for who in range(2):
		monitors.append(MODULES[who].new())
		samples.append(_samples(MODULES[who], path))
		while _seconds_of(monitors[who], samples[who], repeats[who]) < enough_s:
			repeats[who] *= 2
	for _round in range(rounds):
		var rates: Array = []
		var rewards: Array = []
		for who in range(2):
			var seconds: float = _seconds_of(monitors[who], samples[who], repeats[who])
			rates.append(samples[who].size() * repeats[who] / seconds)
			rewards.append(_pass(monitors[who], samples[who]))
		var texts: Array = [rates[0], rates[1], rewards[0], rewards[1]]
		print("{\"generated\": %.0f, \"by_hand\": %.0f, \"rewards\": [%.17f, %.17f]}" % texts)
