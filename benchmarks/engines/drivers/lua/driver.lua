-- Runs the generated and the handwritten monitor over the same traces, which have a line of numbers for each sample.
--
--     driver rows TRACE...               a row for each step, first of the generated, then of the handwritten one
--     driver time ROUNDS SECONDS TRACE   JSON lines: steps per second of CPU time in each round

package.path = "./?.lua;@BY_HAND@/?.lua"

local WHO = { "generated", "by_hand" }
local MODULES = { generated = require("@SPEC@_monitor"), by_hand = require("@SPEC@") }

local function samples_of(path)
  local samples = {}
  for line in io.lines(path) do
    local row = {}
    for number in line:gmatch("%S+") do row[#row + 1] = tonumber(number) end
    samples[#samples + 1] = { @ASSIGNMENTS@ }
  end
  return samples
end

local function pass(who, samples)
  local monitor, result = assert(MODULES[who].new()), {}
  return function(taken)
    local rewards = 0.0
    monitor:reset()
    for i = 1, #samples do
      assert(monitor:step(samples[i], result))
      rewards = rewards + result.reward
      if taken then taken(result) end
    end
    return rewards
  end
end

local function rows(who, samples)
  pass(who, samples)(function(result)
    io.write(who, "\t", string.format("%d", result.state), "\t", result.label, "\t", result.verdict, "\t")
    io.write(tostring(result.accepting), "\t", tostring(result.done), "\t")
    io.write(string.format("%.17g\t%.17g\t%.17g\t", result.progress, result.reward, result.robustness))
    io.write(result.limiting or "", "\t", result.label_english, "\t", result.failed_clause or "", "\t")
    io.write(result.failed_atom or "", "\t", result.failed_step or "", "\n")
  end)
end

local function seconds_of(once, count)
  -- LuaJIT would compile the loops for the first monitor, and run the second one on side traces.
  if jit then jit.flush() end
  local started, rewards = os.clock(), 0.0
  for _ = 1, count do rewards = rewards + once() end
  return os.clock() - started, rewards / count
end

local function time(rounds, enough_s, samples)
  local passes, repeats = {}, {}
  for place, who in ipairs(WHO) do
    passes[place], repeats[place] = pass(who, samples), 1
    while seconds_of(passes[place], repeats[place]) < enough_s do repeats[place] = 2 * repeats[place] end
  end
  for _ = 1, rounds do
    local rates, rewards = {}, {}
    for place = 1, #WHO do
      local seconds, sum = seconds_of(passes[place], repeats[place])
      rates[place], rewards[place] = #samples * repeats[place] / seconds, sum
    end
    local text = '{"generated": %.0f, "by_hand": %.0f, "rewards": [%.17g, %.17g]}\n'
    io.write(text:format(rates[1], rates[2], rewards[1], rewards[2]))
  end
end

if arg[1] == "rows" then
  for i = 2, #arg do
    local samples = samples_of(arg[i])
    for _, who in ipairs(WHO) do rows(who, samples) end
  end
else
  time(tonumber(arg[2]), tonumber(arg[3]), samples_of(arg[4]))
end
