# A measure against the density of agents: networks beside each other.
#
# Before this is loaded: NAME, TITLE, HEIGHT, LABEL, RUNS, sets, and arrays
# Set (names), Colour.
#
# NAME-medians.dat, NAME-runs.dat and NAME-printed.dat have a block for each
# network: x, median, least, most; x, value.  x is 10*D, and 6 more for each
# network.

set label 1 "{/:Bold=15 ".TITLE."}" at screen 0.06,(1-24.0/HEIGHT)
set label 2 "{/*0.9 ".LABEL."; ".RUNS.(RUNS == 1 ? " run" : " runs")." of each: median, least and greatest}" at screen 0.06,(1-50.0/HEIGHT) tc rgb "#555555"
set lmargin at screen 0.06; set rmargin at screen 0.985
set tmargin at screen (1-92.0/HEIGHT); set bmargin at screen (82.0/HEIGHT)
set border 3 lc rgb "#888888"
set tics nomirror out scale 0.6 tc rgb "#333333"
set grid ytics lc rgb "#e4e4e4" lt 1 lw 1
set xrange [0:6*sets]
set xtics ()
do for [s=0:sets-1] {
    do for [d=1:5] { set xtics add (sprintf("%.1f", d/10.0) 6*s+d) }
    set label 10+s Set[s+1] at first (6*s+3),graph 1.03 center tc rgb Colour[s+1]
    if (s > 0) { set arrow 10+s from first 6*s,graph 0 to first 6*s,graph 1 nohead lc rgb "#dddddd" }
}
set xlabel "agents by hosts, D" tc rgb "#333333"
set offsets 0,0,graph 0.05,graph 0.05
set key top right inside samplen 1
plot for [s=1:sets] NAME."-runs.dat" index (s-1) using 1:2 \
         with points pt 7 ps 0.45 lc rgb (0xa0000000 + Colour[s]) notitle, \
     for [s=1:sets] NAME."-medians.dat" index (s-1) using 1:2:3:4 \
         with yerrorbars pt 7 ps 1.1 lw 1.4 lc rgb Colour[s] notitle, \
     for [s=1:sets] NAME."-medians.dat" index (s-1) using 1:2 \
         with lines lw 2 lc rgb Colour[s] notitle, \
     for [s=1:sets] NAME."-printed.dat" index (s-1) using 1:2 \
         with points pt 8 ps 1.8 lw 1.8 lc rgb "#222222" \
         title (s == 1 && LABEL[1:10] eq "Executions" ? "printed in the thesis" : "")
