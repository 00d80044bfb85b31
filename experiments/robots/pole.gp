# A pole that is carried in two ways: its tilt over time, and below it, over
# the same time, which robot executed what.
#
# Before this is loaded: TITLE, SUBTITLE, END, LIMIT.  In the data files
# hosts.dat, tilt.dat, tasks.dat the first block is of the robots in step, the
# second of each by itself.

array Full[4] = [0x4477aa, 0xee6677, 0x228833, 0xccbb44]
array Pale[4] = [0xd1dde9, 0xfad9dd, 0xc8e1cc, 0xf2eed0]
shade(task, done) = done > 0 ? Full[int(task)] : Pale[int(task)]
array Way[2] = ["in step", "each by itself"]

set multiplot
set label 1 "{/:Bold=16 ".TITLE."}" at screen 0.075,0.970
set label 2 SUBTITLE at screen 0.075,0.938 tc rgb "#555555"
set xrange [0:1.01*END]
set border 3 lc rgb "#888888"
set tics nomirror out scale 0.6 tc rgb "#333333"
set lmargin at screen 0.075; set rmargin at screen 0.985
set style fill solid noborder
set format x ""

set tmargin at screen 0.86; set bmargin at screen 0.545
set label 3 "Tilt of the pole" at screen 0.075,0.885
set key at screen 0.985,0.885 right center horizontal samplen 1.5
set yrange [0:*]; set ylabel "degrees" offset 0.5,0 tc rgb "#333333"
plot LIMIT lw 1.5 dt 2 lc rgb "#333333" title "limit", \
     for [i=1:2] "tilt.dat" index i-1 with lines lw 2 lc rgb Full[i] title Way[i]
unset label; unset key

set yrange [4.5:0]; set ytics 1,1,4; set ylabel "robot"
do for [i=1:2] {
    top = 0.455 - 0.225*(i-1)
    set tmargin at screen top; set bmargin at screen top-0.165
    set label 3 "Tasks, ".Way[i].": required (light), executed (full colour)" at screen 0.075,(top+0.021)
    if (i == 2) {
        set format x "%g"; set xlabel "time (host seconds)" offset 0,0.4
    }
    plot "hosts.dat" index i-1 using (($3+$4)/2):1:3:4:($1-0.5):($1+0.5):(shade($2,$5)) with boxxyerror lc rgb variable, \
         "tasks.dat" index i-1 using 2:(0.2):(sprintf("{/:Bold T%d}", $1)):(Full[int($1)]) with labels left tc rgb variable
    unset label
}
unset multiplot
