-- tltlc plays without a window.
function love.conf(t)
  t.identity = "hall"
  t.window.title = "The hall"
  if os.getenv("TLTL_PORT") then
    t.modules.window, t.modules.graphics, t.modules.audio = false, false, false
  end
end
