-- The courier, with a navigation that the test plays.

local function said(t)
  local texts = {}
  for _, record in ipairs(t:records("output")) do
    if record.name == "say" then texts[#texts + 1] = record.value.data end
  end
  return table.concat(texts, " | ")
end

test("takes the message to each place, and comes back", function(t)
  t:load("deliver.lrp")
  t:step()
  t:input("robot.order", { data = "lunch!" })
  t:step(2)
  for _ = 1, 2 do
    t:expect_active("courier/driving")
    t:reply("robot.go", {})
    t:step(2)
    t:expect_active("courier/delivering")
    t:advance(3100)
  end
  t:expect_active("courier/driving")
  t:reply("robot.go", {})
  t:step(3)
  t:expect_active("courier/waiting")
  t:expect(said(t) == "Anna: lunch! | Ben: lunch!", "it said " .. said(t))
end)

test("leaves out a place that it can't get to, and says so at the end", function(t)
  t:load("deliver.lrp")
  t:step()
  t:input("robot.order", { data = "lunch!" })
  t:step(2)
  t:fail("robot.go", "blocked")
  t:step(3)
  t:expect_active("courier/driving")
  t:reply("robot.go", {})
  t:step(2)
  t:advance(3100)
  t:reply("robot.go", {})
  t:step(3)
  t:expect_active("courier/waiting")
  t:expect(said(t) == "Ben: lunch! | I missed Anna", "it said " .. said(t))
end)
