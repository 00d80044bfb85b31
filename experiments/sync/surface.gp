# Response surface of the time for all tasks over the initial potential and the
# penalty bias: a panel for each topology and size.
#
# Before this is loaded: TITLE.  points.dat has a block for each panel: topology
# (1 to 4), hosts, delta, potential, visits, time, overlaps.

array Shape[4] = ["Star-bus", "Ring", "Tree", "Grid"]
array Hosts[2] = [30, 60]
stats "points.dat" using 6 nooutput
CMIN = STATS_min; CMAX = STATS_max
set multiplot
set label 1 "{/:Bold=15 ".TITLE."}" at screen 0.05,0.965
set label 2 "{/*0.9 Colour: seconds until all tasks are done; circles: runs, filled where executions overlapped}" at screen 0.05,0.93 tc rgb "#555555"
set border lc rgb "#888888"
set tics nomirror out scale 0.5 tc rgb "#333333"
set logscale xy
set xrange [0.05:1]; set yrange [25:200]
set xtics (0.05, 0.1, 0.2, 0.5, 1); set ytics (25, 50, 100, 200)
set palette defined (0 "#2166ac", 0.5 "#f7f7f7", 1 "#b2182b")
set cbtics (20, 50, 100, 200, 400)
unset key
do for [p=1:4] {
    do for [h=1:2] {
        set lmargin at screen (0.05 + 0.225*(p-1)); set rmargin at screen (0.235 + 0.225*(p-1))
        set tmargin at screen (0.88 - 0.42*(h-1)); set bmargin at screen (0.55 - 0.42*(h-1))
        set label 3 sprintf("%s, %d hosts", Shape[p], Hosts[h]) at graph 0,1.05
        if (h == 2) { set xlabel "δ" tc rgb "#333333" } else { unset xlabel }
        if (p == 1) { set ylabel "P(0)" tc rgb "#333333" } else { unset ylabel }
        if (p == 4) { set colorbox } else { unset colorbox }
        set table $Grid
        set dgrid3d 40,40 qnorm 4
        unset logscale
        set xrange [log(0.05):0]; set yrange [log(25):log(200)]
        splot "points.dat" index (2*p+h-3) using (log($3)):(log($4)):(log($6))
        unset dgrid3d
        unset table
        set xrange [0.05:1]; set yrange [25:200]
        set logscale xy; set logscale cb
        set cbrange [CMIN:CMAX]
        plot $Grid using (exp($1)):(exp($2)):(exp($3)) with points pt 5 ps 1.2 lc palette, \
             "points.dat" index (2*p+h-3) using ($7 == 0 ? $3 : 1/0):4 with points pt 6 ps 0.8 lc rgb "#222222", \
             "points.dat" index (2*p+h-3) using ($7 > 0 ? $3 : 1/0):4 with points pt 7 ps 0.8 lc rgb "#222222"
        unset label 1; unset label 2
    }
}
unset multiplot
