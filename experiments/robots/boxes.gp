# Which robot did what when: a row for each robot, pale while it is reserved, in full
# colour while it executes the job of that colour.  Below it a row for each
# box: from when its allocator is released until the box has been pushed and
# its robots are back, grey while the allocator rests.
#
# Before this is loaded: TITLE, SUBTITLE, END, and how many robots and jobs.
# Data: robots.dat, reservations.dat, jobs.dat, rests.dat.

array Full[6] = [0x4477aa, 0xee6677, 0x228833, 0xccbb44, 0x66ccee, 0xaa3377]
array Pale[6] = [0xd1dde9, 0xfad9dd, 0xc8e1cc, 0xf2eed0, 0xd9f2fa, 0xeaccdd]
full(i) = Full[(int(i)-1) % 6 + 1]
pale(i) = Pale[(int(i)-1) % 6 + 1]
till(c) = valid(c) ? column(c) : END     # `none`: it never came

set multiplot
set label 1 "{/:Bold=16 ".TITLE."}" at screen 0.085,0.962
set label 2 SUBTITLE at screen 0.085,0.922 tc rgb "#555555"
set xrange [0:1.01*END]; unset key
set border 3 lc rgb "#888888"
set tics nomirror out scale 0.6 tc rgb "#333333"
set lmargin at screen 0.085; set rmargin at screen 0.985
set style fill solid noborder
set format x ""

set tmargin at screen 0.84; set bmargin at screen 0.45
set label 3 "Robots: reserved (pale), executing (full colour)" at screen 0.085,0.865
set yrange [robots+0.6:0.4]
plot "robots.dat" using (($3+END)/2):1:3:(END):($1-0.08):($1+0.08):ytic(2) with boxxyerror lc rgb "#bbbbbb", \
     "reservations.dat" using ($3):1:3:(till(5)):($1-0.4):($1+0.4):(pale($2)) with boxxyerror lc rgb variable, \
     "reservations.dat" using ($3):1:(valid(4) ? $4 : till(5)):(till(5)):($1-0.4):($1+0.4):(full($2)) with boxxyerror lc rgb variable
unset label

set tmargin at screen 0.36; set bmargin at screen 0.09
set label 3 "Allocators: searching (pale), resting (grey), robots executing (full colour)" at screen 0.085,0.385
set format x "%g"; set xlabel "time (host seconds)" offset 0,0.4
set yrange [jobs+0.6:0.4]; set ytics ()
plot "jobs.dat" using 4:1:4:(till(5)):($1-0.4):($1+0.4):(pale($1)):ytic(sprintf("%s (%d)", strcol(2), $3)) with boxxyerror lc rgb variable, \
     "jobs.dat" using 4:1:(till(5)):(till(6)):($1-0.4):($1+0.4):(full($1)) with boxxyerror lc rgb variable, \
     "rests.dat" using 2:1:2:($2+$3):($1-0.25):($1+0.25) with boxxyerror lc rgb "#999999"
unset multiplot
