# Draws results/sizes.csv; in this folder: gnuplot sizes.gp
set datafile separator ","
set terminal pngcairo size 1600,420 font "sans,11"
set output "results/sizes.png"
set multiplot layout 1,4
set logscale x 2
set xtics (54, 96, 199, 408, 822)
set xrange [40:1100]
set xlabel "discs in the cell"
set style line 1 lc rgb "#0050c8" pt 7 lw 1.5
unset key
set title "Young's modulus [GPa]"
set yrange [55:80]
plot "results/sizes.csv" using 2:3:4 every ::1 with yerrorbars ls 1, "" using 2:3 every ::1 with lines ls 1
set title "tensile strength [MPa]"
set yrange [0:15]
plot "results/sizes.csv" using 2:5:6 every ::1 with yerrorbars ls 1, "" using 2:5 every ::1 with lines ls 1
set title "work after the peak × edge [J/m²]"
set yrange [0:10]
plot "results/sizes.csv" using 2:7:8 every ::1 with yerrorbars ls 1, "" using 2:7 every ::1 with lines ls 1
set title "uniaxial compressive strength [MPa]"
set yrange [0:400]
plot "results/sizes.csv" using 2:9:10 every ::1 with yerrorbars ls 1, "" using 2:9 every ::1 with lines ls 1
