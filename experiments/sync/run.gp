# One run, in three panels over one time axis: on how many hosts each task was
# switched on, second by second; what every host required (light), and when it
# executed it (full colour); how many distinct tasks were required.
#
# Before this is loaded: TITLE, SUBTITLE, HEIGHT, end, most, hosts.  Of
# starts.dat, hosts.dat, names.dat, bands.dat and tau.dat the first block is
# drawn.

stats "tau.dat" index 0 using 2 nooutput
set multiplot
set label 1 "{/:Bold=16 ".TITLE."}" at screen 0.075,0.972
set label 2 SUBTITLE at screen 0.075,0.943 tc rgb "#555555"
set xrange [0:end*1.01]
unset key
set border 3 lc rgb "#888888"
set tics nomirror out scale 0.6 tc rgb "#333333"
set lmargin at screen 0.075; set rmargin at screen 0.985
set style fill solid noborder
set format x ""

set tmargin at screen 0.865; set bmargin at screen 0.645
set yrange [0:most*1.2]; set ylabel "hosts" offset 0.5,0 tc rgb "#333333"
set label 3 "Executions switched on in each second ({/:Italic grey: idle time between two tasks, in seconds})" at screen 0.075,0.900
plot "bands.dat" index 0 using (($1+$2)/2):(0):1:2:(0):(most*1.2) with boxxyerror lc rgb "#ececec", \
     "bands.dat" index 0 using (($1+$2)/2):($3 > 0 ? most*1.05 : NaN):(sprintf("%.1f", $3)) with labels center tc rgb "#666666" font ",9", \
     "starts.dat" index 0 using 1:2:3:4:5:6:7 with boxxyerror lc rgb variable, \
     "names.dat" index 0 using 1:($2*most):3:4 with labels left tc rgb variable font ":Bold"
unset label

set tmargin at screen 0.590; set bmargin at screen 0.185
set yrange [hosts+0.5:0.5]; set ylabel "host"
set label 3 "Task required by each host (light), and executed (full colour)" at screen 0.075,0.610
plot "hosts.dat" index 0 using 1:2:3:4:5:6:7 with boxxyerror lc rgb variable
unset label

set tmargin at screen 0.135; set bmargin at screen 0.065
set yrange [0:(STATS_max > 3 ? STATS_max : 3) + 0.4]; set ytics 1
set ylabel "{/:Italic τ}"
set format x "%g"; set xlabel "time (host seconds)" offset 0,0.4
set label 3 "Distinct tasks required in the network" at screen 0.075,0.155
plot 2 with lines lc rgb "#cccccc", \
     "tau.dat" index 0 with steps lw 1.5 lc rgb "#333333"
unset multiplot
