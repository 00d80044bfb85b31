# A line for each robot: pale while it is allocated to a sequence, dark while
# it executes a task of it, a colour for each task.
#
# Before this is loaded: TITLE, robots, END.  Data: held.dat and executed.dat,
# rows of robot, from, till, task.

array Colour[6] = [0x4477aa, 0xee6677, 0x228833, 0xccbb44, 0x66ccee, 0xaa3377]
set label 1 "{/:Bold=15 ".TITLE."}" at screen 0.085,0.955
set label 2 "{/*0.9 pale: allocated; dark: executing, a colour for each task}" \
    at screen 0.085,0.91 tc rgb "#555555"
set xrange [0:1.01*END]; set yrange [0:robots+1]
set border 3 lc rgb "#888888"
set tics nomirror out scale 0.6 tc rgb "#333333"
set ytics 1; set style fill solid 1.0 noborder; unset key
set lmargin at screen 0.085; set rmargin at screen 0.975
set tmargin at screen 0.87
set xlabel "seconds" tc rgb "#333333"
set ylabel "robot" tc rgb "#333333"
plot "held.dat" using (($2+$3)/2):1:2:3:($1-0.4):($1+0.4) \
         with boxxyerror lc rgb 0xdddddd, \
     "executed.dat" using (($2+$3)/2):1:2:3:($1-0.4):($1+0.4):(Colour[(int($4)-1)%6+1]) \
         with boxxyerror lc rgb variable
