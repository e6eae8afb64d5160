set multiplot layout @rows@,2
set size ratio -1
unset key
set tics font ',10'
@panels@
unset multiplot
