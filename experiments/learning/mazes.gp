# Mazes beside each other, with the ways of robots.
#
# Before this is loaded: NAME, TITLE, HEIGHT, SEED, SIZE, panels, agents, and
# arrays Panel (titles), Colour (of agents).
#
# NAME-final.dat and NAME-moves.dat have a block for each agent of each panel:
# x, y; and x, y, dx, dy.  NAME-walls.dat has one for each panel.

W = 1270.0
set multiplot
set label 1 "{/:Bold=15 ".TITLE."}" at screen 0.055,(1-26.0/HEIGHT)
set label 2 "{/*0.9 seed ".SEED."}" at screen 0.055,(1-52.0/HEIGHT) tc rgb "#555555"
set border 15 lc rgb "#888888"
step = int(SIZE/5 > 1 ? SIZE/5 : 1)
set tics nomirror out scale 0.6 tc rgb "#333333"
set xtics step; set ytics step
set grid xtics ytics lc rgb "#eeeeee" lt 1 lw 0.6
set xrange [-1:SIZE+1]; set yrange [-1:SIZE+1]
unset key
do for [p=1:panels] {
    left = (70 + 625.0*(p-1))/W
    set lmargin at screen left; set rmargin at screen (left + 560/W)
    set tmargin at screen (1 - 105.0/HEIGHT)
    set bmargin at screen (1 - 665.0/HEIGHT)
    set label 3 Panel[p] at screen left,(1 - 90.0/HEIGHT)
    plot NAME."-walls.dat" index (p-1) using 1:2:($1-0.55):($1+0.55):($2-0.55):($2+0.55) \
             with boxxyerror fill solid noborder lc rgb "#777777", \
         for [a=1:agents] NAME."-moves.dat" index ((p-1)*agents + a-1) using 1:2:3:4 \
             with vectors nohead lw 0.8 lc rgb (0x90000000 + Colour[a]), \
         for [a=1:agents] NAME."-final.dat" index ((p-1)*agents + a-1) using 1:2 \
             with lines lw 3 lc rgb Colour[a], \
         "+" using (SIZE):(0) every ::0::0 with points pt 7 ps 1.6 lc rgb "#222222", \
         "+" using (0):(SIZE) every ::0::0 with points pt 3 ps 2.2 lw 2.5 lc rgb "#222222"
    unset label
}
unset multiplot
