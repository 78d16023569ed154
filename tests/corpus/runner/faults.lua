-- What went wrong goes when it is mended, when a spawn that was refused succeeds, and with a restart.

local function wrong(t, codes)
  local seen = {}
  for _, each in ipairs(t:errors()) do seen[#seen + 1] = each.code .. " " .. each.count end
  t:expect(table.concat(seen, ", ") == codes, table.concat(seen, ", ") .. ", not " .. codes)
end

local function told(t, kind)
  local n = 0
  for _, record in ipairs(t:records()) do n = n + (record.kind == kind and 1 or 0) end
  return n
end

local TWICE = "(machine m (state a (onentry (spawn n x)) (onentry (spawn n z)) (machine n (state x) (state z)))) (spawn m a)"

test("a restart begins anew, what happens again is told again", function(t)
  t:source("(machine m (var n := [0]) (state a (onentry [n = n + nil]))) (machine k (state s) (on [true] s -> gone)) (spawn m a) (spawn k s)")
  wrong(t, "unknown-state 1, runtime-error 1")
  t:set("m/n", 1)
  t:restart()
  wrong(t, "unknown-state 1, runtime-error 1")
  t:expect(told(t, "error") == 4, "each told twice, not " .. told(t, "error"))
end)

test("what was only in the last run is gone", function(t)
  t:source("(machine m (var n := [1]) (state a (running [n = n + 1])) (state b)) (spawn m a)")
  t:set("m/n", "one")
  t:step(2)
  t:expect(#t:errors() == 1, "a string is no number")
  t:restart()
  t:step(2)
  wrong(t, "")
end)

for _, mode in ipairs { "restart", "keep" } do
  test("the conflicting spawn is removed, mode " .. mode, function(t)
    t:source(TWICE, { on_edit = mode })
    wrong(t, "already-running 1")
    t:edit(function(text) return (text:gsub("%(onentry %(spawn n x%)%) ", "")) end)
    t:step(2)
    wrong(t, "")
    t:expect(t:active()[2] == "m/a/n/z", "it is spawned by the other")
  end)
end

test("of two spawns at top level one is removed: what runs goes on, and nothing is wrong", function(t)
  t:source("(machine m (state a) (state b)) (spawn m a) (spawn m b)")
  wrong(t, "already-running 1")
  t:edit("(machine m (state a) (state b)) (spawn m b)")
  wrong(t, "")
  t:expect(t:active()[1] == "m/a", "it runs on")
end)

test("a spawn that was refused succeeds later", function(t)
  t:source[[
(machine w (state on) (state off))
(machine m (state a (onentry (spawn w on))) (state b) (ontime 100 a -> b))
(machine k (state s (onentry (spawn w off))) (state u) (ontime 300 s -> u) (ontime 100 u -> s))
(spawn m a) (spawn k s)]]
  wrong(t, "already-running 1")
  t:advance(300)
  wrong(t, "already-running 1")
  t:advance(200)
  wrong(t, "")
  t:expect(told(t, "mended") == 1, "it is told")
end)

test("a block that was stopped runs again after a restart", function(t)
  t:source("(var n := [0]) (onpause [while n == 0 do end n = 2]) (machine m (state a)) (spawn m a)")
  t:pause()
  t:expect(#t:errors() == 1, "stopped")
  t:restart()
  wrong(t, "")
  t:resume()
  t:set("n", 1)
  t:pause()
  t:expect(t:get("n") == 2, "it runs")
end)
