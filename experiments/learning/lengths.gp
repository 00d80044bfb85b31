# Lengths of plans against executions, in panels beside each other.
#
# Before this is loaded: as for mazes.gp.
#
# NAME-plans.dat and NAME-ends.dat have a block for each agent of each panel:
# execution, actions.

W = 1270.0
stats NAME."-plans.dat" using 1:2 nooutput
right = STATS_max_x; top = STATS_max_y
stats NAME."-ends.dat" using 1:2 nooutput
top = (STATS_max_y > top ? STATS_max_y : top)
set multiplot
set label 1 "{/:Bold=15 ".TITLE."}" at screen 0.055,(1-26.0/HEIGHT)
set label 2 "{/*0.9 seed ".SEED."; a circle is the final way}" at screen 0.055,(1-52.0/HEIGHT) tc rgb "#555555"
set border 3 lc rgb "#888888"
set tics nomirror out scale 0.6 tc rgb "#333333"
set grid ytics lc rgb "#e4e4e4" lt 1 lw 1
set xrange [0:right*1.02]; set yrange [0:top*1.04]
set xlabel "executions of an agent"
unset key
do for [p=1:panels] {
    left = (70 + 625.0*(p-1))/W
    set lmargin at screen left; set rmargin at screen (left + 560/W)
    set tmargin at screen (1 - 105.0/HEIGHT)
    set bmargin at screen (80.0/HEIGHT)
    set label 3 Panel[p] at screen left,(1 - 90.0/HEIGHT)
    if (p == 1) { set ylabel "actions" offset 1.5,0 } else { unset ylabel }
    plot for [a=1:agents] NAME."-plans.dat" index ((p-1)*agents + a-1) using 1:2 \
             with lines lw 1.6 lc rgb Colour[a], \
         for [a=1:agents] NAME."-ends.dat" index ((p-1)*agents + a-1) using 1:2 \
             with points pt 6 ps 1.6 lw 2 lc rgb Colour[a]
    unset label
}
unset multiplot
