set title @title@
set xlabel 'x [m]'
set ylabel 'y [m]'
@ranges@
set xtics @tics@
@plot@
