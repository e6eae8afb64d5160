set title @title@
set size ratio -1
set clip two
set style textbox opaque noborder fillcolor rgb 'white' margins 0.3,0.3
set xrange [@x_low@:@x_high@]
set yrange [@y_low@:@y_high@]
set xlabel '{/:Italic v}_x [m/s]'
set ylabel '{/:Italic v}_y [m/s]'
@plot@
