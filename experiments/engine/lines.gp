# Measures against a parameter, in panels one below the other.
#
# Before this is loaded: NAME, TITLE, SUBTITLE, XLABEL, XTICS, LEFT, RIGHT,
# HEIGHT, HEAD and FOOT (pixels above the first panel, below each),
# BAND, JOINED, ROTATED (0 or 1), KEYROWS, SUBLINE (where the subtitle is),
# panels, series, PRINTED, and arrays Panel (titles), Log (0 or 1), Rules
# (values as words), Series (labels), Colour.
#
# NAME.dat has a block for each series of each panel: x, median, least, most;
# NAME-runs.dat likewise x, value for each run; NAME-printed.dat what is
# printed elsewhere.  With BAND there is a band from the least to the greatest
# in place of bars and dots; medians are JOINED by lines; long labels of x are
# ROTATED.  A line without length at 1 keeps ranges of zeros from a warning.

set multiplot
set label 1 "{/:Bold=15 ".TITLE."}" at screen 0.095,(1-26.0/HEIGHT)
set label 2 "{/*0.9 ".SUBTITLE."}" at screen 0.095,(1-SUBLINE/HEIGHT) tc rgb "#555555"
set xrange [LEFT:RIGHT]
eval "set xtics (".XTICS.")"
if (ROTATED) { set xtics rotate by 25 right }
PANEL = 285.0 + FOOT
set border 3 lc rgb "#888888"
set tics nomirror out scale 0.6 tc rgb "#333333" noenhanced
set grid ytics lc rgb "#e4e4e4" lt 1 lw 1
set lmargin at screen 0.095; set rmargin at screen 0.975
block(p, s) = (p-1)*series + s-1
do for [p=1:panels] {
    top = 1 - (HEAD + PANEL*(p-1) + 32)/HEIGHT
    set tmargin at screen top
    set bmargin at screen (1 - (HEAD + PANEL*p - FOOT)/HEIGHT)
    set label 3 Panel[p] at screen 0.095,(top + 20.0/HEIGHT) noenhanced
    if (p == 1) {
        set key at screen 0.975,(1-(HEAD - 8 - 9.5*(KEYROWS-1))/HEIGHT) right center horizontal samplen 1.5 width 1 noenhanced
    } else {
        unset key
    }
    if (Log[p]) {
        set logscale y; set yrange [*:*]; set format y "10^{%T}"; set ytics enhanced
    } else {
        unset logscale y; set yrange [0:1<*]; set format y "%g"; set ytics noenhanced
    }
    if (Log[p]) { unset offsets } else { set offsets 0,0,graph 0.06,0 }
    if (p == panels) { set xlabel XLABEL noenhanced tc rgb "#333333" }
    unset arrow
    do for [r in Rules[p]] {
        set arrow from graph 0,first (r+0) to graph 1,first (r+0) nohead dt 2 lc rgb "#999999"
    }
    if (BAND) {
    plot for [s=1:series] NAME.".dat" index block(p,s) using 1:3:4 \
             with filledcurves lc rgb (0xc0000000 + Colour[s]) notitle, \
         for [s=1:series] NAME.".dat" index block(p,s) using 1:2 \
             with lines lw 2 lc rgb Colour[s] title Series[s]
    } else {
    plot for [s=1:series] NAME."-runs.dat" index block(p,s) using 1:2 \
             with points pt 7 ps 0.45 lc rgb (0xa0000000 + Colour[s]) notitle, \
         for [s=1:series] NAME.".dat" index block(p,s) using 1:2:3:4 \
             with yerrorbars pt 7 ps 1.1 lw 1.4 lc rgb Colour[s] notitle, \
         for [s=1:series] NAME.".dat" index block(p,s) using 1:(JOINED ? $2 : NaN) \
             with lines lw 2 lc rgb Colour[s] title Series[s], \
         for [s=1:series] NAME."-printed.dat" index block(p,s) using 1:2 \
             with points pt 8 ps 1.6 lw 1.6 lc rgb Colour[s] notitle, \
         [LEFT:LEFT] (Log[p] ? NaN : 1) with lines lc bgnd notitle, \
         (p == 1 && PRINTED ? NaN : 1/0) with points pt 8 ps 1.6 lc rgb "#555555" \
             title (p == 1 && PRINTED ? "printed" : "")
    }
    unset label
}
unset multiplot
