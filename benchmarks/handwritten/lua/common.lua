-- The parts that the handwritten monitors share: the reward, reading samples, and closeness.

local common = {}

local huge = math.huge

-- Whether the value of a signal is a finite number.
function common.is_finite(value)
  return type(value) == "number" and value > -huge and value < huge
end

-- Closeness in [-1, 1]: 1 at the target, 0 at 1 m, -1 from level_size on.
function common.near(distance, level_size)
  if distance < 1.0 then return distance > 0.0 and 1.0 - distance or 1.0 end
  if distance > level_size then return -1.0 end
  local rest = (level_size - distance) / (level_size - 1.0)
  return rest * rest - 1.0
end

-- Count a step with this progress; returns its reward.
function common.advance(monitor, progress, violated, ends, limit)
  local steps, before = monitor.steps + 1, monitor.progress
  local best = progress > before and progress or before
  local reward = 0.0
  if not monitor.done then
    reward = best - before - 1.0 / limit
    if violated then reward = reward - (limit - steps) / limit end
    monitor.done = ends or steps >= limit
  end
  if violated and not monitor.failed_step then monitor.failed_step = steps end
  monitor.steps = steps
  monitor.progress = best
  return reward
end

-- A class of monitors, whose `step` is to be written.
function common.class()
  local Monitor = {}
  Monitor.__index = Monitor

  function Monitor.new(level_size)
    local monitor = setmetatable({ level_size = level_size or 20.0 }, Monitor)
    monitor:reset()
    return monitor
  end

  function Monitor:reset()
    self.state = 0
    self.steps = 0
    self.progress = 0.0
    self.done = false
    self.failed_step = nil
  end

  return Monitor
end

return common
