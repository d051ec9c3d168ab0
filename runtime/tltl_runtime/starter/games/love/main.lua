-- The game in LÖVE. tltlc plays it if it has started the game; otherwise a person does, with the arrow keys.

local hall = require("hall")
local tltl_client = require("tltl_client")

local KEYS = {up = 0, down = 1, left = 2, right = 3} -- in the order of the moves
local CELL = 48 -- pixels

local recorder, now
local seed -- of a walk whose first move is still to come

function hall.read(scene)
  return (assert(love.filesystem.read("levels/" .. scene .. ".txt")))
end

local function begin()
  seed = love.math.random(0, 2 ^ 31)
  now = hall:reset("hall", "v0", seed)
  recorder:finish() -- the next move begins a trace and a tape
end

function love.load()
  if os.getenv("TLTL_PORT") then
    tltl_client.play(hall)
    love.event.quit()
    return
  end
  recorder = tltl_client.Recorder("traces", {"has_key", "at_door", "on_spikes"}, hall.hello.clock_hz, hall.hello.name)
  begin()
end

function love.keypressed(key)
  if key == "r" or now.ended then
    begin()
  elseif KEYS[key] then
    now = hall:step(KEYS[key])
    if seed then recorder:begin("hall", "v0", seed) end
    seed = nil
    recorder:sample(now.signals, KEYS[key])
  end
end

function love.quit()
  if recorder then recorder:finish() end
end

function love.draw()
  if not now then return end
  for y, row in ipairs(hall.rows) do
    for x = 1, #row do
      love.graphics.print(row:sub(x, x), x * CELL, (#hall.rows - y + 1) * CELL, 0, 2)
    end
  end
  local x, y = hall.player[1] + 1, #hall.rows - hall.player[2]
  love.graphics.print("@", x * CELL, y * CELL, 0, 2)
  love.graphics.print(hall.has_key and "You have the key. R starts again." or "Fetch the key K.", CELL, CELL / 2)
end
