autocmd BufNewFile,BufRead *.tltl setfiletype tltl
