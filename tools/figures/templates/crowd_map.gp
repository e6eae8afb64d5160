unset grid
set tics out
set palette defined (0 '#f7fbff', 0.25 '#b5d4e9', 0.5 '#6baed6', 0.75 '#2878b8', 1 '#08306b')
set cblabel @value@ offset 2,0
set cbrange [0:@most@]
set colorbox
set rmargin 16
@plane@
