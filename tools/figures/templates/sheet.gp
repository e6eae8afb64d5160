set multiplot title @title@
unset key
set tics font ',9'
set xtics offset 0,0.4
set ytics offset 0.5,0
@panels@
# The legend, below all panels.
set lmargin at screen 0
set rmargin at screen 1
set bmargin at screen 0
set tmargin at screen @legend_top@
unset border
unset tics
unset grid
unset title
unset xlabel
unset label 1
set xrange [0:1]
set yrange [0:1]
set key at screen 0.5, screen @legend_middle@ center center horizontal reverse Left samplen 2.5 width 1 font ',11'
@legend@
unset multiplot
