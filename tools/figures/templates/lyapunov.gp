set multiplot layout 4,1
set xlabel 'time [s]'
set xrange [0:@end@]
set lmargin 12
set rmargin at screen 0.77
set key inside left top at graph 1.02,1
@panels@
unset multiplot
