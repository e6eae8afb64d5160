set multiplot layout @rows@,@columns@ title @title@
unset key
@panels@
unset multiplot
