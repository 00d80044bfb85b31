# How the potential of one task falls, and the size of the rewards and
# penalties that it was changed by.
#
# Before this is loaded: TITLE, curves, and arrays Delta, Visits.  A block of
# curves.dat is a curve: visit, potential, theta.  rewards.dat has the visits
# that were rewarded.

set multiplot
set label 1 "{/:Bold=15 ".TITLE."}" at screen 0.085,0.968
set label 2 "{/*0.9 Calculated: θ(0) = 15, ω = 15, P_{max} = 100; grey: visits with a reward, all others are penalised}" at screen 0.085,0.935 tc rgb "#555555"
set border 3 lc rgb "#888888"
set tics nomirror out scale 0.6 tc rgb "#333333"
set grid ytics lc rgb "#e4e4e4" lt 1 lw 1
set lmargin at screen 0.085; set rmargin at screen 0.975
set xrange [0:*]
array Colour[6] = [0x4477aa, 0xee6677, 0x228833, 0xccbb44, 0x66ccee, 0xaa3377]

set tmargin at screen 0.865; set bmargin at screen 0.535
set label 3 "a  Potential of a task" at screen 0.085,0.890
set ylabel "potential" offset 0.5,0 tc rgb "#333333"
set yrange [0:110]
plot "rewards.dat" using 1:(110) with impulses lw 3 lc rgb "#dddddd" notitle, \
     for [c=1:curves] "curves.dat" index (c-1) using 1:2 with lines lw 2 lc rgb Colour[c] \
         title sprintf("δ = %g (0 after %d)", Delta[c], Visits[c])
unset label
unset key

set tmargin at screen 0.440; set bmargin at screen 0.085
set label 3 "b  Size of the reward or penalty" at screen 0.085,0.465
set ylabel "θ"; set xlabel "visits" tc rgb "#333333"
set yrange [0:*]
plot "rewards.dat" using 1:(16) with impulses lw 3 lc rgb "#dddddd", \
     for [c=1:curves] "curves.dat" index (c-1) using 1:3 with lines lw 2 lc rgb Colour[c]
unset multiplot
