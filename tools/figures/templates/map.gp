set title @title@
set size ratio -1
@ranges@
set xlabel @x_label@
set ylabel @y_label@
set tics font ',11'
@plot@
