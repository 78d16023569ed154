((lua) @injection.content
  (#set! injection.language "lua"))
