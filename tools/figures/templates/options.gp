set title @title@
set xrange [0:@end@]
set yrange [0.3:@top@]
set xlabel 'fields'
set lmargin 20
set grid noytics
set arrow from 0,@between@ to graph 1,first @between@ nohead dt (4,4) lc rgb '#777777'
@plot@
