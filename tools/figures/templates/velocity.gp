set multiplot layout 2,1
set lmargin 9
@x@
@y@
unset multiplot
