-- The game without LÖVE: tltlc starts it with Lua 5.1 to 5.4 or LuaJIT, and LuaSocket.

local hall = require("hall")

function hall.read(scene)
  local file = assert(io.open("levels/" .. scene .. ".txt"))
  local text = file:read("*a")
  file:close()
  return text
end

require("tltl_client").play(hall)
