-- Without a window and without sound, so that no screen is needed.

function love.conf(settings)
  settings.identity = "tltl-counter"
  for _, name in ipairs({"audio", "font", "graphics", "image", "joystick", "keyboard", "mouse", "physics", "sound",
    "system", "touch", "video", "window"}) do
    settings.modules[name] = false
  end
end
