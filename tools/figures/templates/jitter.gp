set title @title@
set logscale y
set format y '10^{%T}'
set yrange [100:2e6]
set xrange [-0.6:3.6]
set xlabel 'scenario'
set ylabel 'jitter {/:Italic J} [m/s²]'
set grid noxtics
@plot@
