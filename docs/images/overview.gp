# The picture of the README: mode shapes of a beam, a record and its reproduction.
# The README runs it after the two commands that write shapes/ and results/:  gnuplot overview.gp
# It writes overview.png.
reset
set encoding utf8
set datafile separator comma
blue = '#0072b2'; vermillion = '#d55e00'; green = '#009e73'; black = '#000000'; sky = '#56b4e9'
set border 3 linewidth 0.8 linecolor rgb '#404040'
set tics out nomirror scale 0.7,0.4
set grid back linetype 1 linewidth 0.5 linecolor rgb '#dcdcdc'
set key Left reverse samplen 2.4 spacing 1.15
set terminal pngcairo size 1600,640 enhanced font 'DejaVu Sans,10' fontscale 2 linewidth 2
set title font ',11'
set output 'overview.png'
set multiplot layout 1,2
set title "Computed: mode shapes"
set xlabel "x [m]"; set ylabel "deflection (largest 1)"
set yrange [-1.15:1.55]; set ytics 0.5; set xrange [0:1.1]; set xtics 0.2
set key top left horizontal maxcols 3 width -1 samplen 1.6 font ',9.5'
shapes = 'shapes/mode_shapes.csv'
plot shapes skip 1 using 5:6 with lines linecolor rgb blue linewidth 1.6 title "3.46 Hz", \
     shapes skip 1 using 11:12 with lines linecolor rgb vermillion linewidth 1.6 dashtype 2 title "22.8 Hz", \
     shapes skip 1 using 17:18 with lines linecolor rgb green linewidth 1.6 dashtype 4 title "65.7 Hz"
set title "Identified: record and its reproduction"
set xlabel "time [s]"; set ylabel "acceleration [m/s²]"
set xrange [2:3.74]; set xtics 0.4; set yrange [-6:8]; set ytics 3
set key top left horizontal maxcols 2 width 1
record = 'results/reproduction.csv'
plot record skip 1 using 1:2 with lines linecolor rgb sky linewidth 3 title "reproduced", \
     record skip 1 every 4 using 3:4 with points linecolor rgb black pointtype 7 pointsize 0.5 title "measured"
unset multiplot
