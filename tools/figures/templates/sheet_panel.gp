set lmargin at screen @left@
set rmargin at screen @right@
set bmargin at screen @bottom@
set tmargin at screen @top@
set title @title@ font ',10' offset 0,-0.7
set xlabel @x_label@ font ',10' offset 0,0.6
set label 1 @y_label@ at screen @label@, graph 0.5 center rotate by 90 font ',10'
@settings@
@plot@
