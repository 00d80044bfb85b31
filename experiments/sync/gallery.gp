# Runs, one below the other: on the left on how many hosts each task was
# switched on, second by second; on the right what each host required (light)
# and when it executed it (full colour).  All have the same time axis, and the
# panels on the left the same scale.
#
# Before this is loaded: TITLE, SUBTITLE, HEIGHT, rows, end, most, hosts, and
# arrays Row (titles), Failed (when something was lost, or -1).  Each run is
# a block of starts.dat, hosts.dat and names.dat.

set multiplot
set label 1 "{/:Bold=15 ".TITLE."}" at screen 0.045,(1-26.0/HEIGHT)
set label 2 "{/*0.9 ".SUBTITLE."}" at screen 0.045,(1-54.0/HEIGHT) tc rgb "#555555"
set xrange [0:end*1.01]
unset key
set border 3 lc rgb "#888888"
set tics nomirror out scale 0.6 tc rgb "#333333"
set style fill solid noborder
do for [r=1:rows] {
    top = 1 - (70 + 290.0*(r-1) + 52)/HEIGHT
    set tmargin at screen top
    set bmargin at screen (1 - (70 + 290.0*r - 30)/HEIGHT)
    if (r == rows) { set xlabel "time (host seconds)" offset 0,0.4 }
    unset arrow
    if (Failed[r] >= 0) {
        set arrow 1 from first Failed[r],graph 0 to first Failed[r],graph 1 nohead dt 2 lw 1.2 lc rgb "#333333" front
    }
    set label 3 Row[r] at screen 0.045,(top + 30.0/HEIGHT)
    set lmargin at screen 0.045; set rmargin at screen 0.49
    set yrange [0:most*1.2]; set ylabel "hosts" offset 1.2,0 tc rgb "#333333"
    plot "starts.dat" index (r-1) using 1:2:3:4:5:6:7 with boxxyerror lc rgb variable, \
         "names.dat" index (r-1) using 1:($2*most):3:4 with labels left tc rgb variable font ":Bold"
    unset label 3
    set lmargin at screen 0.545; set rmargin at screen 0.99
    set yrange [hosts+0.5:0.5]; set ylabel "host"
    plot "hosts.dat" index (r-1) using 1:2:3:4:5:6:7 with boxxyerror lc rgb variable
    unset label
}
unset multiplot
