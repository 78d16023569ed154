-- Breakpoints in tests.

local two = [[
(bridge robot sim)
(var n := [0])
(machine m
  (state a (running [n = n + 1]))
  (state b (onentry [robot.move{ linear = { x = 1 } }]))
  (ontime 300 a -> b go)
  (ontime 300 b -> a))
(spawn m a)
]]

test("a pause ends what was to be advanced, and resume goes on from there", function(t)
  t:source(two)
  t:break_at("m/b")
  t:advance(1000)
  t:expect(t:is_paused())
  t:expect_active("m/b")
  t:expect_output("robot.move")
  local pause = t:records("pause")[1]
  t:expect(pause.t == 300 and pause.at == "m/b" and pause.reason == "breakpoint: entered m/b", pause.reason)
  t:advance(1000)
  t:resume()
  t:expect(not t:is_paused())
  t:advance(299)
  t:expect_active("m/b")
  t:advance(1)
  t:expect_active("m/a")
end)

test("on a transition and on a condition", function(t)
  t:source(two)
  t:break_at("m: ontime 300 b -> a")
  t:break_at{ condition = "n == 2" }
  t:break_at{ condition = "elapsed() == 0", machine = "m" }
  local set = t:breakpoints()
  t:expect(#set == 3 and set[1].at == "transition" and set[1].transition == "m: ontime 300 b -> a" and set[1].by == "command")
  t:expect(set[2].condition == "n == 2" and set[2].machine == "" and set[3].machine == "m")
  t:advance(1000)
  t:expect(t:get("n") == 2)
  t:clear_break{ condition = "n == 2" }
  t:clear_break{ condition = "elapsed() == 0", machine = "m" }
  t:resume()
  t:advance(1000)
  local pauses = t:records("pause")
  t:expect(pauses[2].t == 600 and pauses[2].reason == "breakpoint: took m: ontime 300 b -> a", pauses[2].reason)
  t:clear_break("m: ontime 300 b -> a")
  t:expect(#t:breakpoints() == 0)
end)

test("one of the text", function(t)
  t:source(two)
  t:edit(function(text) return text:gsub("b go", "b go (break)") end)
  t:expect(t:breakpoints()[1].by == "source")
  t:advance(1000)
  t:expect(t:is_paused() and #t:records("restart") == 0)
  t:step(2)
  t:expect(t:is_paused() and #t:records("pause") == 1)
end)

test("an error pauses where that was asked for", function(t)
  t:source("(machine m (state a (running [if now() == 200 then error('no') end]))) (spawn m a)", { on_error = "pause" })
  t:advance(1000)
  t:expect(t:is_paused() and t:records("pause")[1].reason == "error in m/a: no")
end)

test("a state that isn't there", function(t)
  t:source(two)
  t:break_at("m/bb")
end)

test("a transition that isn't there", function(t)
  t:source(two)
  t:break_at("m: ontime 300 a -> b")
end)

test("a condition with a misspelt variable", function(t)
  t:source(two)
  t:break_at{ condition = "m > 3" }
end)

test("a misspelt field", function(t)
  t:source(two)
  t:break_at{ conditon = "n > 3" }
end)

test("no place at all", function(t)
  t:source(two)
  t:break_at(3)
end)

test("nothing to clear", function(t)
  t:source(two)
  t:clear_break("m/b")
end)

test("another option", function(t)
  t:source(two, { on_error = "stop" })
end)
