set arrow 1 from @time@, graph 0 to @time@, graph 1 nohead dt (2,3) lc rgb '#777777'
set label 1 'at rest from here to @end@ s' at @time@, graph 0.97 right rotate by 90 offset -0.7,0 font ',9' \
  textcolor rgb '#555555'
