# When the first agent of each task is excited, and active: all runs.
#
# Before this is loaded: TITLE.  states.dat has hosts, kind, time, and 1 for
# excited or 2 for active.

array Colour[2] = [0xccbb44, 0x228833]
array Word[2] = ["EXCITED", "ACTIVE"]
stats "states.dat" using 3 nooutput
set multiplot layout 2,1
set label 1 "{/:Bold=15 ".TITLE."}" at screen 0.085,0.955
set border 3 lc rgb "#888888"
set tics nomirror out scale 0.6 tc rgb "#333333"
set grid ytics lc rgb "#e4e4e4" lt 1 lw 1
set lmargin at screen 0.085; set rmargin at screen 0.975
set yrange [5.6:0.4]; set ytics ("AT1" 1, "AT2" 2, "AT3" 3, "AT4" 4, "AT5" 5)
set xrange [0:STATS_max*1.03]
array Hosts[2] = [50, 100]
do for [p=1:2] {
    set tmargin at screen (p == 1 ? 0.85 : 0.45)
    set bmargin at screen (p == 1 ? 0.55 : 0.15)
    set label 2 sprintf("%d hosts", Hosts[p]) at screen 0.085,(p == 1 ? 0.88 : 0.48)
    if (p == 1) { set key at screen 0.975,0.88 right center horizontal samplen 1 } else { unset key }
    if (p == 1) { set format x "" } else { set format x; set xlabel "seconds" tc rgb "#333333" }
    plot for [m=1:2] "states.dat" using ($1 == Hosts[p] && $4 == m ? $3 : 1/0):2 \
        with points pt 7 ps 0.8 lc rgb Colour[m] title Word[m]
    unset label
}
unset multiplot
