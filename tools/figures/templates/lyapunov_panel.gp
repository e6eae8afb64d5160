set title @title@
set ylabel @y_label@
@y_axis@
@plot@
