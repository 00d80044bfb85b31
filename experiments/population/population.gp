# Tasks and populations, one column for each number of hosts.
#
# Before this is loaded: TITLE, columns, an array Hosts of their numbers,
# seeds, how many runs there are, and crashed (0 or 1).  Tables have a block
# for each column, see pictures.pl.

array Colour[6] = [0x4477aa, 0xee6677, 0x228833, 0xccbb44, 0x66ccee, 0xaa3377]
do for [i=1:6] { set linetype i lc rgb Colour[i] }

set multiplot
set label 1 "{/:Bold=16 ".TITLE."}" at screen 0.04,0.975
set border 3 lc rgb "#888888"
set tics nomirror out scale 0.6 tc rgb "#333333"
set style fill solid 1.0 noborder
do for [c=0:columns-1] {
    left = 0.04 + c*0.98/columns
    set lmargin at screen left; set rmargin at screen (left + 0.95/columns - 0.02)
    set xrange [*:*]; set yrange [*:*]
    stats "kinds.dat" index c using 1 name "E" nooutput
    stats "spans.dat" index c using 2 name "P" nooutput
    if (crashed) { stats "crash.dat" index c using 1 name "C" nooutput }
    set xrange [0:1.01*E_max]
    unset xlabel; set format x ""; unset ytics; set ytics nomirror; unset arrow
    if (crashed) {
        set arrow 1 from C_min,graph 0 to C_min,graph 1 nohead dt 2 lc rgb "#222222"
        set label 4 " T2 lost" at C_min,graph 0.95
    }
    set grid ytics lc rgb "#e4e4e4" lt 1 lw 1

    set tmargin at screen 0.89; set bmargin at screen 0.66
    set label 3 sprintf("%d hosts: at how many a task was switched on, in each second", Hosts[c+1]) at screen left,0.905
    set yrange [0:*]
    unset key
    plot "starts.dat" index c using 1:5:2:3:4:5:6 with boxxyerror lc variable notitle
    unset label

    set tmargin at screen 0.59; set bmargin at screen 0.28
    set label 3 "Agents" at screen left,0.62
    set key at screen (left + 0.95/columns - 0.02),0.605 right center horizontal samplen 0.8 width 0 font ",9" maxrows 1
    plot for [i=2:(seeds > 1 ? 2 : 1)] "others.dat" index c using 1:7 \
             with steps lw 1 lc rgb "#c4c4c4" title "others", \
         "kinds.dat" index c using 1:7 with steps lw 1.6 lc rgb "#333333" title "all", \
         for [k=1:5] "kinds.dat" index c using 1:(column(k+1)) \
             with steps lw 2 lt k title sprintf("Agent-%d", k)
    unset label

    set tmargin at screen 0.21; set bmargin at screen 0.075
    set label 3 "Execution of the tasks, run by run" at screen left,0.225
    unset key; unset arrow; unset grid
    set yrange [0.5:P_max+0.5]; set format x "%g"; set xlabel "seconds" tc rgb "#333333"
    plot "spans.dat" index c using 1:2:3:4:5:6:7:ytic(8) with boxxyerror lc variable notitle
    unset label
}
unset multiplot
