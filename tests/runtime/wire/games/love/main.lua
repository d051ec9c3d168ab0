-- The counter game, or the recorder, in LÖVE: love FOLDER [record.lua WORDS…]

function love.load(words)
  local games = love.filesystem.getSource() .. "/.."
  local program = games .. "/" .. (table.remove(words, 1) or "counter.lua")
  arg = words
  arg[0] = program
  dofile(program)
  love.event.quit()
end
