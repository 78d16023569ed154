" Programs of lrp.
autocmd BufNewFile,BufRead *.lrp setlocal filetype=lrp
