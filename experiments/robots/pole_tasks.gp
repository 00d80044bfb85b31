# Tasks of four robots in step: how many were switched on in each second, what
# each robot required and executed, and how many distinct tasks were required.
#
# Before this is loaded: TITLE, SUBTITLE, END.  Of the data files the first
# block counts: hosts.dat, starts.dat, tau.dat, tasks.dat.

array Full[4] = [0x4477aa, 0xee6677, 0x228833, 0xccbb44]
array Pale[4] = [0xd1dde9, 0xfad9dd, 0xc8e1cc, 0xf2eed0]
shade(task, done) = done > 0 ? Full[int(task)] : Pale[int(task)]

set multiplot
set label 1 "{/:Bold=16 ".TITLE."}" at screen 0.075,0.972
set label 2 SUBTITLE at screen 0.075,0.943 tc rgb "#555555"
set xrange [0:1.01*END]
unset key
set border 3 lc rgb "#888888"
set tics nomirror out scale 0.6 tc rgb "#333333"
set lmargin at screen 0.075; set rmargin at screen 0.985
set style fill solid noborder
set format x ""

set tmargin at screen 0.865; set bmargin at screen 0.645
set yrange [0:5]; set ytics 1; set ylabel "robots" offset 0.5,0 tc rgb "#333333"
set label 3 "Executions switched on in each second ({/:Italic grey: idle time between two tasks, in seconds})" at screen 0.075,0.890
plot "tasks.dat" index 0 using ($3+$4/2):(2.5):3:($3+$4):(0):(4.6) with boxxyerror lc rgb "#ececec", \
     "tasks.dat" index 0 using ($3+$4/2):(4.4):($4 > 0 ? sprintf("{/*0.8 %.1f}", $4) : "") with labels tc rgb "#666666", \
     "tasks.dat" index 0 using 2:(4.8):(sprintf("{/:Bold T%d}", $1)):(Full[int($1)]) with labels left tc rgb variable, \
     "starts.dat" index 0 using ($1+0.5):($3+0.5):1:($1+1):3:($3+1):(Full[int($2)]) with boxxyerror lc rgb variable
unset label

set tmargin at screen 0.590; set bmargin at screen 0.185
set yrange [4.5:0.5]; set ylabel "robot"
set label 3 "Task required by each robot (light), and executed (full colour)" at screen 0.075,0.610
plot "hosts.dat" index 0 using (($3+$4)/2):1:3:4:($1-0.5):($1+0.5):(shade($2,$5)) with boxxyerror lc rgb variable
unset label

set tmargin at screen 0.135; set bmargin at screen 0.065
set yrange [0:3.4]; set ylabel "{/:Italic τ}"
set format x "%g"; set xlabel "time (host seconds)" offset 0,0.4
set label 3 "Distinct tasks required in the network" at screen 0.075,0.155
plot 2 with lines lc rgb "#cccccc", \
     "tau.dat" index 0 with steps lw 1.5 lc rgb "#333333"
unset multiplot
