-- Branching: three switches in order, then the exit behind an open barrier, alive throughout; 600 steps.

local common = require("common")
local is_finite, near, advance = common.is_finite, common.near, common.advance
local min, max = math.min, math.max

local ATOMS = { [0] = "near(s1)", "near(s2)", "near(s3)" }
local LABELS = {
  [0] = "F(near(s1) & X F(near(s2) & X F(near(s3) & X F(open_right & near(e_right) | open_left & near(e_left))))) & G alive",
  "F(near(s2) & X F(near(s3) & X F(open_right & near(e_right) | open_left & near(e_left)))) & G alive",
  "false",
  "F(near(s3) & X F(open_right & near(e_right) | open_left & near(e_left))) & G alive",
  "F(open_right & near(e_right) | open_left & near(e_left)) & G alive",
  "G alive",
}
local ENGLISH = {
  [0] = "Reach near(s1), then near(s2), then near(s3), then (open_right and near(e_right)) or (open_left and near(e_left)), and keep alive throughout.",
  "Reach near(s2), then near(s3), then (open_right and near(e_right)) or (open_left and near(e_left)), and keep alive throughout.",
  "The spec is violated.",
  "Reach near(s3), then (open_right and near(e_right)) or (open_left and near(e_left)), and keep alive throughout.",
  "Reach (open_right and near(e_right)) or (open_left and near(e_left)), and keep alive throughout.",
  "Keep alive throughout.",
}
local VERDICTS = { [0] = "pending", "pending", "violated", "pending", "pending", "holding" }
local SWITCH = { [0] = 0, [1] = 1, [3] = 2 }
local NEXT = { [0] = 1, [1] = 3, [3] = 4 }
local TRAP, EXITS, GOAL, LIMIT = 2, 4, 5, 600

-- States 0, 1 and 3 wait for a switch, 4 for an exit, 5 is the goal, 2 is the trap.
local Monitor = common.class()

-- Take one sample, into `result` or a new table.  Returns nil and a message, and the state stays, where a signal is
-- missing or not finite.
function Monitor:step(signals, result)
  local s1, s2, s3 = signals["distance(s1)"], signals["distance(s2)"], signals["distance(s3)"]
  local to_right, to_left = signals["distance(e_right)"], signals["distance(e_left)"]
  local open_right, open_left, health = signals.open_right, signals.open_left, signals.health
  if not is_finite(s1) then return nil, "no finite number for distance(s1)" end
  if not is_finite(s2) then return nil, "no finite number for distance(s2)" end
  if not is_finite(s3) then return nil, "no finite number for distance(s3)" end
  if not is_finite(to_right) then return nil, "no finite number for distance(e_right)" end
  if not is_finite(to_left) then return nil, "no finite number for distance(e_left)" end
  if not is_finite(health) then return nil, "no finite number for health" end
  if open_right == nil or open_left == nil then return nil, "nothing says which barrier is open" end

  local alive = min(max(health, 0.0), 1.0)
  local state = self.state
  local robustness, progress, limiting = 0.0, 0.0, nil
  if state == TRAP then
    robustness = 1.0
  elseif alive <= 0.0 then
    state = TRAP
  elseif state == GOAL then
    robustness = alive
    progress = 1.0
  elseif state == EXITS then
    local right_open, left_open = open_right and 1.0 or -1.0, open_left and 1.0 or -1.0
    local right_near, left_near = near(to_right, self.level_size), near(to_left, self.level_size)
    local right, left = min(right_open, right_near), min(left_open, left_near)
    local nearest = max(right, left)
    if nearest > 0.0 then
      state = GOAL
      robustness = min(nearest, alive)
      progress = 1.0
    else
      robustness = min(-nearest, alive)
      progress = (4.0 + nearest) / 4.0
      if right >= left then
        limiting = right_open <= right_near and "open_right" or "near(e_right)"
      else
        limiting = left_open <= left_near and "open_left" or "near(e_left)"
      end
    end
  else
    local switch = SWITCH[state]
    local closeness = near(switch == 0 and s1 or switch == 1 and s2 or s3, self.level_size)
    if closeness > 0.0 then
      state = NEXT[state]
      robustness = min(closeness, alive)
      progress = (switch + 1) / 4.0
    else
      robustness = min(-closeness, alive)
      progress = (switch + 1.0 + closeness) / 4.0
      limiting = ATOMS[switch]
    end
  end

  self.state = state
  result = result or {}
  result.reward = advance(self, progress, state == TRAP, state == TRAP or state == GOAL, LIMIT)
  result.state = state
  result.label = LABELS[state]
  result.label_english = ENGLISH[state]
  result.verdict = VERDICTS[state]
  result.accepting = state == GOAL
  result.done = self.done
  result.progress = self.progress
  result.robustness = robustness
  result.limiting = limiting
  result.failed_clause = state == TRAP and "keep alive" or nil
  result.failed_atom = state == TRAP and "alive" or nil
  result.failed_step = self.failed_step
  return result
end

return Monitor
