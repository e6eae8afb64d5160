# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot route-gates.gp: a gap that is a gate, and one that is none.
set terminal pngcairo size 1080,470 font 'DejaVu Sans,12'
set output 'route-gates.png'
set multiplot layout 1,2
set size ratio -1
set parametric
set trange [0:2*pi]
set samples 361
set xrange [-2.6:2.6]; set yrange [-1.9:1.9]
unset xtics; unset ytics; unset border
set key off
do for [k = 1:2] {
  unset object; unset label; unset arrow
  set title k == 1 ? '(a) A gate: no third site in the disc' : '(b) No gate: two shorter ones, at w, stand for it'
  set object 1 polygon from -2.5,-1.7 to -1,0 to -2.5,1.5 to -2.5,-1.7 fs solid 0.6 border lc rgb '#3f444d' fc rgb '#c9ccd2'
  set object 2 polygon from 1,-1.8 to 2.5,-1.8 to 2.5,1.8 to 1,1.8 to 1,-1.8 fs solid 0.6 border lc rgb '#3f444d' fc rgb '#c9ccd2'
  wy = k == 1 ? 1.35 : 0.55
  set object 3 polygon from 0.1,wy to 0.5,wy+0.5 to -0.4,wy+0.5 to 0.1,wy fs solid 0.6 border lc rgb '#3f444d' fc rgb '#c9ccd2'
  if (k == 1) {
    set arrow 1 from -1,0 to 1,0 nohead lw 3 lc rgb '#D55E00' front
  } else {
    set arrow 1 from -1,0 to 1,0 nohead lw 1.5 dt 2 lc rgb '#D55E00' front
    set arrow 2 from -1,0 to 0.1,wy nohead lw 3 lc rgb '#D55E00' front
    set arrow 3 from 0.1,wy to 1,wy nohead lw 3 lc rgb '#D55E00' front
  }
  set label 1 'p' at -1.25,-0.05 front
  set label 2 'q' at 1.12,-0.05 front
  set label 3 'w' at 0.1,wy+0.22 center front
  plot cos(t), sin(t) with lines lw 1.5 lc rgb '#0072B2'
}
unset multiplot
