# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot plain-is-unsafe.gp: by how many ulps 800 cut-offs clear their velocity obstacle, plain and certified.
# The data: audit_half_planes ulps 800 > plain-is-unsafe.dat
set terminal pngcairo size 1000,520 font 'DejaVu Sans,12'
set output 'plain-is-unsafe.png'
set xlabel 'half-plane'
set ylabel 'offset minus its exact bound [ulps]'
set logscale y 10
set nonlinear y via asinh(y*2) inverse sinh(y)/2
unset logscale
set yrange [-12:300]
set ytics (-10, -3, -1, 0, 1, 3, 10, 30, 100, 300)
set grid ytics lc rgb '#e4e4e4'
set key outside right top reverse Left samplen 1
set object 1 rectangle from graph 0, first -12 to graph 1, first 0 fc rgb '#fbe3d6' fs solid noborder behind
set label 1 'cuts into the velocity obstacle: unsafe' at 12,-7 tc rgb '#8a3a00' front
plot 'plain-is-unsafe.dat' using 1:($2 < 0 ? $2 : NaN) with points pt 7 ps 0.35 lc rgb '#D55E00' title 'plain, unsafe', \
     '' using 1:($2 >= 0 ? $2 : NaN) with points pt 7 ps 0.35 lc rgb '#999999' title 'plain, safe', \
     '' using 1:3 with points pt 7 ps 0.35 lc rgb '#009E73' title 'certified'
