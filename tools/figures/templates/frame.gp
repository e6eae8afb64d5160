# @shows@
# Draw again with: gnuplot '@name@.gp'
set encoding utf8
data = '@name@.dat'
if (!exists('formats')) formats = 'svg png pdf'
do for [format in formats] {
  if (format eq 'svg') {
    set terminal svg enhanced rounded size @width@,@height@ font 'DejaVu Sans,13' background rgb 'white'
  }
  if (format eq 'png') {
    set terminal pngcairo enhanced rounded size 1.4 * @width@,1.4 * @height@ font 'DejaVu Sans,13' fontscale 1.05 \
      linewidth 1.4 pointscale 1.4
  }
  if (format eq 'pdf') {
    set terminal pdfcairo enhanced rounded size @width@ / 96.0,@height@ / 96.0 font 'DejaVu Sans,13' fontscale 0.5625 \
      linewidth 1.5 pointscale 0.75
  }
  reset
  set output '@name@.' . format
  set border lw 0.8
  set tics nomirror
  set format '%h'
  set grid lt 1 lw 0.5 lc rgb '#dddddd'
  set key outside right top reverse Left samplen 3
@body@
  set output
}
