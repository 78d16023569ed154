-- Minutes in a variable, tens of seconds as states, and a reset from anywhere.

test("passes through the tens of a minute", function(t)
  t:load("resettable_timer.lrp")
  t:step()
  for _, state in ipairs { "zero", "ten", "twenty", "thirty", "forty", "fifty", "zero" } do
    t:expect_active("timer/" .. state)
    t:advance(10000)
  end
  t:expect(t:get("minute") == 1, "a minute has passed")
end)

test("counts minutes for an hour", function(t)
  t:load("resettable_timer.lrp")
  t:step()
  t:advance(60 * 60 * 1000)
  t:expect(t:get("minute") == 60, "it counted " .. t:get("minute"))
  t:expect_active("timer/zero")
end)

for _, state in ipairs { "zero", "thirty", "fifty" } do
  test("can be reset from " .. state, function(t)
    t:load("resettable_timer.lrp")
    t:step()
    t:set("minute", 7)
    t:transition_to("timer/" .. state)
    t:set("doreset", true)
    t:step()
    t:expect_active("timer/init")
    t:expect(t:get("minute") == 0 and t:get("doreset") == false, "it begins at nothing, and the reset is over")
    t:step()
    t:expect_active("timer/zero")
    t:advance(10000)
    t:expect_active("timer/ten")
  end)
end
