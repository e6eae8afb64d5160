set title @title@
set xlabel 'time [s]'
set xrange [0:@end@]
set ylabel @y_label@
set key maxrows @key_rows@
@rest@
@y_axis@
@plot@
