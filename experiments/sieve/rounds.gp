# Values round by round, in panels one below the other: medians with bars to
# the least and the greatest run, a dot for each run.
#
# Before this is loaded: TITLE, HEIGHT, panels, rounds, and arrays Panel
# (titles), Size (series of each panel) and Series (labels, panel by panel).
# medians.dat and dots.dat have a block for each series of each panel.

array Colour[6] = [0x4477aa, 0xee6677, 0x228833, 0xccbb44, 0x66ccee, 0xaa3377]
array First[panels]
First[1] = 0
do for [p=2:panels] { First[p] = First[p-1] + Size[p-1] }

set multiplot
set label 1 "{/:Bold=15 ".TITLE."}" at screen 0.07,(1-26.0/HEIGHT)
set xrange [0.5:rounds+0.5]; set xtics 1; set format x ""
set border 3 lc rgb "#888888"
set tics nomirror out scale 0.6 tc rgb "#333333"
set grid ytics lc rgb "#e4e4e4" lt 1 lw 1
set lmargin at screen 0.07; set rmargin at screen 0.975
set key right top horizontal samplen 1.5 width 1
each = (HEIGHT - 120.0)/panels
do for [p=1:panels] {
    top = 1 - (50 + each*(p-1) + 30)/HEIGHT
    set tmargin at screen top
    set bmargin at screen (top - (each - 45)/HEIGHT)
    set label 2 Panel[p] at screen 0.07,(top + 16.0/HEIGHT)
    set yrange [0:1<*]; set offsets 0,0,graph (Size[p] > 3 ? 0.3 : 0.15),0
    if (p == panels) { set format x "%g"; set xlabel "round of attacks" tc rgb "#333333" }
    plot for [s=1:Size[p]] "dots.dat" index First[p]+s-1 using 1:2 \
             with points pt 7 ps 0.4 lc rgb (0xa0000000 + Colour[s]) notitle, \
         for [s=1:Size[p]] "medians.dat" index First[p]+s-1 using 1:2:3:4 \
             with yerrorbars pt 7 ps 0.9 lw 1.2 lc rgb Colour[s] notitle, \
         for [s=1:Size[p]] "medians.dat" index First[p]+s-1 using 1:2 \
             with lines lw 2 lc rgb Colour[s] title Series[First[p]+s]
    unset label
}
unset multiplot
