# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot trap.gp: an ellipse, its evolute, and two goals behind it. The robot comes from below.
set terminal pngcairo size 1080,560 font 'DejaVu Sans,12'
set output 'trap.png'
set multiplot layout 1,2
set size ratio -1
set parametric
set trange [0:2*pi]
set samples 721
a = 2.0; b = 1.2; r = 0.4
set xrange [-2.9:2.9]; set yrange [-2.4:3.4]
set xlabel 'x [m]'; set ylabel 'y [m]'
set grid lc rgb '#eeeeee'
set key off
# the boundary of the ellipse grown by the robot, and its normal there
nx(t) = b*cos(t)/sqrt((b*cos(t))**2 + (a*sin(t))**2)
ny(t) = a*sin(t)/sqrt((b*cos(t))**2 + (a*sin(t))**2)
ex(t) = (a*a - b*b)/a*cos(t)**3
ey(t) = (a*a - b*b)/b*sin(t)**3
arrow_style = 'filled head'
do for [k = 1:2] {
  g = k == 1 ? 1.85 : 2.6
  unset label; unset arrow
  set title k == 1 ? '(a) Goal inside the evolute: a stable trap' : '(b) Goal outside the evolute: every stop is unstable'
  set label 1 'goal' at 0.15, g front
  set label 2 'ellipse' at 1.15, 0.45 tc rgb '#3f444d' front
  set label 3 'evolute' at 0.6, -0.7 tc rgb '#0072B2' front
  set label 4 k == 1 ? 'rests here' : 'slides off' at 0.25, -(b + r) - 0.45 front
  do for [i = -2:2] {
    if (i != 0) {
      t0 = -pi/2 + 0.30*i
      px = a*cos(t0) + r*nx(t0); py = b*sin(t0) + r*ny(t0)
      s = ((0 - px)*(-ny(t0)) + (g - py)*nx(t0)) > 0 ? 1 : -1
      set arrow 10+i from px, py rto -s*ny(t0)*0.42, s*nx(t0)*0.42 lw 2.5 lc rgb '#D55E00' front
    }
  }
  plot a*cos(t) + r*nx(t), b*sin(t) + r*ny(t) with lines lw 1.5 dt (4,3) lc rgb '#3f444d', \
       a*cos(t), b*sin(t) with filledcurves closed fc rgb '#c9ccd2' fs transparent solid 0.6 border lc rgb '#3f444d', \
       ex(t), ey(t) with lines lw 2 lc rgb '#0072B2', \
       '+' using (0):(g) every ::0::0 with points pt 7 ps 1.6 lc rgb '#1030ff', \
       '+' using (0):(-(b + r)) every ::0::0 with points pt (k == 1 ? 7 : 6) ps 1.6 lc rgb '#D55E00'
}
unset multiplot
