# Draws results/rank-queue.csv; in this folder: gnuplot rank_queue.gp
set datafile separator ","
set terminal svg size 1100,440 font "sans,12" background "white"
set output "results/rank-queue.svg"
set multiplot layout 1,2
set logscale xy
set xlabel "cores"
set ylabel "times faster than one core"
set xrange [1:12000]
set yrange [1:4000]
set key top left reverse Left
set style line 1 lc rgb "#888888" lw 1.5 dt 2
set style line 2 lc rgb "#c03020" pt 6 ps 0.5 lw 1.5
set style line 3 lc rgb "#0050c8" pt 7 ps 0.5 lw 1.5
set style line 4 lc rgb "#208040" pt 4 ps 0.5 lw 1.5
set style line 5 lc rgb "#b07000" pt 8 ps 0.5 lw 1.5
do for [n in "1024 16384"] {
  set title sprintf("%d volumes, a tenth of them in the band", 4 * n)
  plot "results/rank-queue.csv" using 2:($1 == n ? $10 : NaN) with lines ls 1 title "bound", \
       "" using 2:($1 == n ? $7 : NaN) with linespoints ls 4 title "measured, 16 cores a rank", \
       "" using 2:($1 == n ? $9 : NaN) with linespoints ls 5 title "one queue", \
       "" using 2:($1 == n ? $4 : NaN) with linespoints ls 3 title "measured, 1 core a rank", \
       "" using 2:($1 == n ? $3 : NaN) with linespoints ls 2 title "equal, 1 core a rank"
}
