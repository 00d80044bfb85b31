# A pole that is carried in two ways: how many executions were switched on in
# each second, which robot required and executed what, how the pole tilted, and
# how many distinct tasks were required, all over the same time.
#
# Before this is loaded: TITLE, SUBTITLE, END, LIMIT.  In the data files
# starts.dat, hosts.dat, tasks.dat, tilt.dat, tau.dat the first block is of the
# robots in step, the second of each by itself.

array Full[4] = [0x4477aa, 0xee6677, 0x228833, 0xccbb44]
array Pale[4] = [0xd1dde9, 0xfad9dd, 0xc8e1cc, 0xf2eed0]
shade(task, done) = done > 0 ? Full[int(task)] : Pale[int(task)]
array Way[2] = ["in step", "each by itself"]

set multiplot
set label 1 "{/:Bold=16 ".TITLE."}" at screen 0.075,0.978
set label 2 SUBTITLE at screen 0.075,0.956 tc rgb "#555555"
set xrange [0:1.01*END]; unset key
set border 3 lc rgb "#888888"
set tics nomirror out scale 0.6 tc rgb "#333333"
set lmargin at screen 0.075; set rmargin at screen 0.985
set style fill solid noborder
set format x ""; set ytics 1,1,4

set tmargin at screen 0.900; set bmargin at screen 0.770
set yrange [0:5]; set ylabel "robots" offset 0.5,0 tc rgb "#333333"
set label 3 "Executions switched on in each second, in step ({/:Italic grey: idle time between two tasks, in seconds})" at screen 0.075,0.920
plot "tasks.dat" index 0 using ($3+$4/2):(2.5):3:($3+$4):(0):(4.6) with boxxyerror lc rgb "#ececec", \
     "tasks.dat" index 0 using ($3+$4/2):(4.2):(sprintf("{/*0.8 %.1f}", $4)) with labels tc rgb "#666666", \
     "starts.dat" index 0 using ($1+0.5):($3+0.5):1:($1+1):3:($3+1):(Full[int($2)]) with boxxyerror lc rgb variable
unset label

set yrange [4.5:0]; set ylabel "robot"
do for [i=1:2] {
    top = 0.705 - 0.195*(i-1)
    set tmargin at screen top; set bmargin at screen top-0.140
    set label 3 "Tasks, ".Way[i].": required (light), executed (full colour)" at screen 0.075,(top+0.018)
    plot "hosts.dat" index i-1 using (($3+$4)/2):1:3:4:($1-0.5):($1+0.5):(shade($2,$5)) with boxxyerror lc rgb variable, \
         "tasks.dat" index i-1 using 2:(0.2):(sprintf("{/:Bold T%d}", $1)):(Full[int($1)]) with labels left tc rgb variable
    unset label
}

set tmargin at screen 0.320; set bmargin at screen 0.180
set key at screen 0.985,0.338 right center horizontal samplen 1.5
set label 3 "Tilt of the pole" at screen 0.075,0.338
set yrange [0:*]; set ytics auto; set ylabel "degrees"
plot LIMIT lw 1.5 dt 2 lc rgb "#333333" title "limit", \
     for [i=1:2] "tilt.dat" index i-1 with lines lw 2 lc rgb Full[i] title Way[i]
unset label; unset key

set tmargin at screen 0.120; set bmargin at screen 0.055
set label 3 "Distinct tasks required in the network" at screen 0.075,0.138
set yrange [0:4.4]; set ytics 1,1,4; set ylabel "{/:Italic τ}"
set format x "%g"; set xlabel "time (host seconds)" offset 0,0.4
plot 2 with lines lc rgb "#cccccc", \
     for [i=1:2] "tau.dat" index i-1 with steps lw 1.5 lc rgb Full[i]
unset multiplot
