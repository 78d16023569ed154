-- A file that is not Lua.

test("unfinished", function(t)
  t:load("x.lrp"
end)
