" Vim's tarPlugin takes *.lrp for archives (of the Linux Router Project). It is loaded after this file, or in a package
" before it: what it claims is given back as soon as it is claimed.
augroup lrp_no_archive
  autocmd!
  autocmd SourcePost */plugin/tarPlugin.vim silent! autocmd! tar BufReadCmd *.lrp
augroup END
silent! autocmd! tar BufReadCmd *.lrp
