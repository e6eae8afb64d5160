set title @title@
set logscale x
set format x '10^{%T}'
set yrange [0.3:@top@]
set xlabel 'jitter {/:Italic J} [m/s²]'
set lmargin 20
@plot@
