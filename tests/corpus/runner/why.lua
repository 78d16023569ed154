-- `t:why` tells what the ways out of a state wait for, and a failure why a state was not reached.

local program = [[
(bridge robot sim)
(var limit := [100])
(machine m
  (event dark [robot.light.data < limit])
  (state a)
  (state b
    (machine n (state c) (state d) (exit [limit == 0] d -> a))
    (onentry (spawn n c)))
  (on dark a -> b found)
  (ontime 1000 * -> b))
(spawn m a)
]]

local function row(way)
  local reads = {}
  for name, value in pairs(way.reads) do reads[#reads + 1] = name .. "=" .. value end
  table.sort(reads)
  return ("%s: %s %s -> %s [%s]"):format(way.transition, way.guard, way.name or way.left or "", way.to, table.concat(reads, " "))
end

local function rows(t, path)
  local all = {}
  for _, way in ipairs(t:why(path)) do all[#all + 1] = row(way) end
  return table.concat(all, "\n")
end

test("what it waits for", function(t)
  t:source(program)
  t:advance(200)
  print(rows(t, "m"))
  print(t:why("m/a")[1].message)
  t:input("robot.light", { data = 100 })
  t:step()
  print(rows(t, "m/a"))
  t:expect(t:why("m")[1].guard == "false" and t:why("m")[1].reads.limit == 100)
  t:input("robot.light", { data = 99 })
  t:step()
  print(rows(t, "m"))
  print(rows(t, "m/b/n"))
  print(t:why("m/b")[2].message)
  print(t:why("m/a")[1].message)
end)

test("why it isn't active", function(t)
  t:source(program)
  t:input("robot.light", { data = 120 })
  t:advance(300)
  t:expect_active("m/b")
end)

test("a state that isn't there", function(t)
  t:source(program)
  t:why("m/bb")
end)

test("a machine that doesn't run", function(t)
  t:source(program)
  t:why("m/b/n")
end)
