set title @title@
set size ratio -1
set clip two
set style textbox opaque noborder fillcolor rgb 'white' margins 0.3,0.3
@ranges@
set xlabel '{/:Italic v}_x [m/s]'
set ylabel '{/:Italic v}_y [m/s]'
@plot@
