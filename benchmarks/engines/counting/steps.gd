# Times steps of monitors that count: `steps ROUNDS MONITORS` prints nanoseconds per step, as JSON lines.
# `first` is the time of the first steps of a count, and `last` that of the last ones. Godot has no clock for CPU time, so
# steps are timed in short blocks: the median is the time of a block that no other process interrupted.

extends SceneTree

const Monitor = preload("quiet_monitor.gd")
const STEPS = 20
const BEFORE = 570
const BLOCK = 10

var _quiet = Monitor.Sample.new()
var _loud = Monitor.Sample.new()


func _init():
	var words: Array = []
	for word in OS.get_cmdline_args():
		if word.is_valid_integer():
			words.append(int(word))
	_quiet.pit = false
	_loud.pit = true
	var monitors: Array = []
	for _i in range(words[1]):
		monitors.append(Monitor.new())
	for _i in range(words[0]):
		var first: float = _nanoseconds(monitors, 0)
		print('{"first": %.3f, "last": %.3f}' % [first, _nanoseconds(monitors, BEFORE)])
	quit()


func _nanoseconds(monitors: Array, before: int) -> float:
	for monitor in monitors:
		monitor.reset()
		if not monitor.step(_loud):
			printerr("a sample is refused")
		for _i in range(before):
			monitor.step(_quiet)
	var times: Array = []
	for place in range(0, monitors.size(), BLOCK):
		var start: int = OS.get_ticks_usec()
		for offset in range(BLOCK):
			var monitor = monitors[place + offset]
			for _i in range(STEPS):
				monitor.step(_quiet)
		times.append(OS.get_ticks_usec() - start)
	times.sort()
	return times[times.size() / 2] * 1000.0 / (BLOCK * STEPS)
