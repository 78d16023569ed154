; Programs of lrp. What begins a form is a keyword only where lrp has a form of that name.

((form head: (name) @keyword)
  (#any-of? @keyword
    "bridge" "import" "export" "var" "machine" "state" "event" "on" "eps" "ontime" "exit" "spawn" "onentry" "running"
    "onexit" "break" "onpause" "onresume"))

((form head: (name) @_head . (name) @function)
  (#any-of? @_head "machine" "state" "event" "var"))

(comment) @comment
(string) @string
(number) @constant.numeric
[(arrow) (assign) (wildcard)] @operator
["(" ")"] @punctuation.bracket
(block ["[" "]"] @punctuation.special)
