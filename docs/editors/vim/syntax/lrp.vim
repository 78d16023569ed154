" Programs of lrp: forms in round brackets, Lua in square ones.
if exists("b:current_syntax")
  finish
endif

syntax include @lrpLua syntax/lua.vim
unlet! b:current_syntax

" A word begins a form only behind its bracket.
syntax match lrpBracket "[()]"
syntax match lrpBracket "(" nextgroup=lrpKeyword skipwhite skipempty
syntax keyword lrpKeyword contained bridge import export var machine state event on eps ontime exit spawn onentry running onexit break onpause onresume
syntax match lrpName "\%((\s*\%(machine\|state\|event\|var\)\s\+\)\@<=[[:alnum:]_-]\+"
syntax match lrpOperator ":=\|->\|\*"
syntax match lrpNumber "\<\d\+\%(\.\d\+\)\?\>"
syntax region lrpString start=+"+ skip=+\\"+ end=+"+ oneline

" Square brackets within a block are Lua's own, but for those of its long strings.
syntax region lrpLuaIndex contained transparent start="\[\%(=*\[\)\@!" end="\]" contains=@lrpLua,lrpLuaIndex
syntax region lrpBlock matchgroup=lrpBlockBracket start="\[" end="\]" contains=@lrpLua,lrpLuaIndex
syntax keyword lrpLuaName contained containedin=lrpBlock,lrpLuaIndex robot log now elapsed

syntax match lrpComment ";.*$" contains=@Spell

syntax sync fromstart

highlight default link lrpBracket Delimiter
highlight default link lrpBlockBracket Special
highlight default link lrpKeyword Keyword
highlight default link lrpName Function
highlight default link lrpOperator Operator
highlight default link lrpNumber Number
highlight default link lrpString String
highlight default link lrpLuaName Identifier
highlight default link lrpComment Comment

let b:current_syntax = "lrp"
