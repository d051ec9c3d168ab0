-- Times steps of monitors that count: `steps ROUNDS MONITORS` prints nanoseconds of CPU time per step, as JSON lines.
-- `first` is the time of the first steps of a count, and `last` that of the last ones.

local Monitor = require("quiet_monitor")

local STEPS, BEFORE = 20, 570
local QUIET, LOUD = { pit = false }, { pit = true }
local result = {}

local function nanoseconds(monitors, before)
  for _, monitor in ipairs(monitors) do
    monitor:reset()
    assert(monitor:step(LOUD, result))
    for _ = 1, before do assert(monitor:step(QUIET, result)) end
  end
  local start = os.clock()
  for _, monitor in ipairs(monitors) do
    for _ = 1, STEPS do assert(monitor:step(QUIET, result)) end
  end
  return (os.clock() - start) * 1e9 / (#monitors * STEPS)
end

local monitors = {}
for i = 1, tonumber(arg[2]) do monitors[i] = assert(Monitor.new()) end
for _ = 1, tonumber(arg[1]) do
  local first = nanoseconds(monitors, 0)
  print(string.format('{"first": %.3f, "last": %.3f}', first, nanoseconds(monitors, BEFORE)))
end
