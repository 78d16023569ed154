-- Tests that never end by themselves.

test("loops", function() while true do end end)
test("catches errors", function() while true do pcall(function() while true do end end) end end)
test("hides in coroutines", function()
  while true do pcall(coroutine.wrap(function() while true do pcall(error, "x") end end)) end
end)
test("advances", function(t)
  t:source("(machine m (state a)) (spawn m a)")
  t:advance(1e12)
end)
test("is quick", function(t) t:expect(true) end)
