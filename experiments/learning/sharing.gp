# Sharing events as time passes, and their linear trend.
#
# Before this is loaded: TITLE, HEIGHT, SEED, END (of the run).
#
# times.dat: middle of a part of the run, events in it; trend.dat: two points.

set label 1 "{/:Bold=15 ".TITLE."}" at screen 0.085,(1-26.0/HEIGHT)
set label 2 sprintf("{/*0.9 seed %d; events in %.0f s each, and their linear trend}", SEED, END/30) at screen 0.085,(1-54.0/HEIGHT) tc rgb "#555555"
set lmargin at screen 0.085; set rmargin at screen 0.98
set tmargin at screen (1-80.0/HEIGHT)
set border 3 lc rgb "#888888"
set tics nomirror out scale 0.6 tc rgb "#333333"
set grid ytics lc rgb "#e4e4e4" lt 1 lw 1
set xrange [0:END]; set yrange [0:*]
set xlabel "host seconds"; set ylabel "sharing events" offset 1,0
set boxwidth 0.85*END/30
unset key
plot "times.dat" using 1:2 with boxes fill solid 0.6 noborder lc rgb "#4477aa", \
     "trend.dat" using 1:2 with lines lw 2.5 lc rgb "#ee6677"
