-- Expectations that fail, and what is said of them.

local pair = [[
(bridge robot sim)
(machine m
  (var x := [0])
  (var over := [false])
  (state a
    (running [x = x + 1; robot.move{ linear = { x = x / 10 } }]))
  (state b)
  (on go a -> b ab)
  (event go [over]))
(spawn m a)
]]

local function expect_b(t)
  t:expect_active("m/b")
end

test("an active state", function(t)
  t:source(pair)
  t:input("robot.light", { data = 3 })
  t:advance(300)
  expect_b(t)
end)

test("an output that satisfies", function(t)
  t:source(pair)
  t:step(2)
  t:expect_output("robot.move", function(m) return m.linear.x == 0.3 and m.angular.z == 0 end)
  t:expect_output("robot.move", function(m) return m.linear.x > 1 end)
end)

test("an output at all", function(t)
  t:source(pair)
  t:jump_to("m/b")
  t:step()
  t:expect_output("robot.move")
end)

test("a condition", function(t)
  t:source(pair)
  t:set("m/over", true)
  t:step()
  t:expect_active("m/b")
  t:expect(t:get("m/x") == 2)
end)

test("a condition in words", function(t)
  t:source(pair)
  t:expect(nil, "there is nothing")
end)

test("errors of the program are shown", function(t)
  t:source("(machine m (state a (running [1 + nil])) (eps a -> c)) (spawn m a)")
  t:advance(500)
  t:edit("(machine m (state a")
  t:expect(#t:errors() == 0, "there are errors")
end)

test("passes, and prints", function(t)
  t:source(pair)
  print("x is", t:get("m/x"))
end)
