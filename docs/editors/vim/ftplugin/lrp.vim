" Editing programs of lrp. `let g:lrp_autosave = 1` in the vimrc makes each keystroke count.
if exists("b:did_ftplugin")
  finish
endif
let b:did_ftplugin = 1

setlocal comments=:; commentstring=;\ %s
setlocal expandtab shiftwidth=2 softtabstop=2

" lrp writes tuned values into the file: what it wrote is loaded when the buffer has no changes of its own.
setlocal autoread

augroup lrp_buffer
  autocmd! * <buffer>
  autocmd FocusGained,BufEnter,CursorHold,InsertEnter <buffer> silent! checktime
  if get(g:, "lrp_autosave", 0)
    autocmd TextChanged,TextChangedI,InsertLeave <buffer> silent! update
  endif
augroup END

let b:undo_ftplugin = "setlocal comments< commentstring< expandtab< shiftwidth< softtabstop< autoread<"
      \ . " | execute 'autocmd! lrp_buffer * <buffer>'"
