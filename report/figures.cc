#include "report/figures.h"

#include "report/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <string>
#include <utility>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace feldspar
{
namespace
{
constexpr double mega = 1e6;
constexpr double milli = 1e-3;
constexpr const char* tension_colour = "#c00000";
constexpr const char* shear_colour = "#0050c8";
constexpr const char* grain_colour = "#d4d4d4";
constexpr const char* loose_grain_colour = "#f0e0b8";

std::string title(const FinishedTest& test)
{
  switch (test.record.kind)
    {
    case TestKind::direct_tension:
      return "Direct tension";
    case TestKind::uniaxial_compression:
      return "Uniaxial compression";
    case TestKind::triaxial_compression:
      return fmt::format("Triaxial, {:g} MPa", test.record.confining_pressure / mega);
    case TestKind::brazilian:
      return "Brazilian";
    }
  return "";
}

/// A name for the data of a test that gnuplot accepts.
std::string block(const char* what, const FinishedTest& test)
{
  std::string name = fmt::format("${}_{}", what, test.name);
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

std::string curve_data(const FinishedTest& test)
{
  const double sign = laboratory_sign(test.record.kind);
  std::string text = fmt::format("{} << EOD\n", block("curve", test));
  for (const auto& row : test.record.curve)
    fmt::format_to(std::back_inserter(text), "{} {} {} {}\n", sign * row.axial_strain * 100.0,
                   sign * row.axial_stress / mega, row.n_tension_cracks, row.n_shear_cracks);
  return text + "EOD\n";
}

/// Grains of the largest fragment and the others; cracks as the faces that broke.
std::string map_data(const FinishedTest& test)
{
  std::string text;
  for (const bool loose : {false, true})
    {
      text += fmt::format("{} << EOD\n", block(loose ? "loose" : "grains", test));
      for (const auto& grain : test.record.grains_at_end)
        if ((grain.fragment > 0) == loose)
          fmt::format_to(std::back_inserter(text), "{} {} {}\n", grain.position[0] / milli, grain.position[1] / milli,
                         grain.radius / milli);
      text += "EOD\n";
    }
  for (const CrackKind kind : {CrackKind::tension, CrackKind::shear})
    {
      text += fmt::format("{} << EOD\n", block(kind == CrackKind::tension ? "tension" : "shear", test));
      for (const auto& crack : test.record.cracks)
        if (crack.kind == kind)
          {
            const double dx = -crack.normal[1] * crack.size;
            const double dy = crack.normal[0] * crack.size;
            fmt::format_to(std::back_inserter(text), "{} {} {} {}\n", (crack.centroid[0] - 0.5 * dx) / milli,
                           (crack.centroid[1] - 0.5 * dy) / milli, dx / milli, dy / milli);
          }
      text += "EOD\n";
    }
  return text;
}

std::string curve_plot(const FinishedTest& test)
{
  const auto& last = test.record.curve.back();
  std::string text = fmt::format("set title '{}, seed {}' noenhanced\n"
                                 "set size noratio\n"
                                 "set xlabel 'axial strain [%]'\n"
                                 "set ylabel 'axial stress [MPa]'\n"
                                 "set y2label 'broken segments'\n"
                                 "set xtics autofreq; set ytics nomirror autofreq; set y2tics autofreq\n"
                                 "set xrange [0:*]; set yrange [0:*]; set y2range [0:*]\n"
                                 "set border 11; set lmargin 10; set rmargin 10\n"
                                 "set bmargin 6\n"
                                 "set key outside bottom center horizontal Left reverse samplen 2 width 1\n",
                                 title(test), test.record.seed);
  const std::string data = block("curve", test);
  text += fmt::format("plot {0} using 1:2 with lines lw 2.5 lc rgb 'black' title 'stress', "
                      "{0} using 1:3 axes x1y2 with lines lw 2 dt 2 lc rgb '{1}' title 'tension cracks'",
                      data, tension_colour);
  if (last.n_shear_cracks > 0)
    text +=
      fmt::format(", {} using 1:4 axes x1y2 with lines lw 2 dt 4 lc rgb '{}' title 'shear cracks'", data, shear_colour);
  return text + "\nunset y2tics; unset y2label\n";
}

std::string map_plot(const FinishedTest& test)
{
  const auto& size = test.record.size;
  std::string text =
    fmt::format("set title '{}, seed {}: cracks at the end' noenhanced\n"
                "set size ratio -1\n"
                "set xlabel 'x [mm]'; set ylabel 'y [mm]'\n"
                "set xtics 10 nomirror; set ytics 10 nomirror; set border 3; set lmargin 10; set rmargin 10\n"
                "set xrange [{}:{}]; set yrange [{}:{}]\n"
                "set bmargin 7\n"
                "set key outside bottom center horizontal maxcols 2 Left reverse samplen 1 width -1\n",
                title(test), test.record.seed, -0.08 * size[0] / milli, 1.08 * size[0] / milli, -0.02 * size[1] / milli,
                1.02 * size[1] / milli);
  const auto n_loose = std::count_if(test.record.grains_at_end.begin(), test.record.grains_at_end.end(),
                                     [](const GrainPicture& grain) { return grain.fragment > 0; });
  text += fmt::format("plot {} with circles fill solid noborder lc rgb '{}' title 'main body'", block("grains", test),
                      grain_colour);
  if (n_loose > 0)
    text += fmt::format(", {} with circles fill solid noborder lc rgb '{}' title 'fragments'", block("loose", test),
                        loose_grain_colour);
  const auto cracks = [&](const char* what, const char* colour, const std::uint64_t n) {
    if (n > 0)
      text +=
        fmt::format(", {} with vectors nohead lw 2 lc rgb '{}' title '{}: {}'", block(what, test), colour, what, n);
  };
  cracks("tension", tension_colour, test.results.n_tension_cracks);
  cracks("shear", shear_colour, test.results.n_shear_cracks);
  return text + "\n";
}

/// Runs gnuplot on a script; false if there is no gnuplot or it failed.
bool run_gnuplot(const std::filesystem::path& script)
{
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_RDWR, 0);
  std::string program = "gnuplot";
  std::string file = script.string();
  char* const arguments[] = {program.data(), file.data(), nullptr};
  pid_t child = 0;
  const bool started = posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments, environ) == 0;
  posix_spawn_file_actions_destroy(&actions);
  int status = -1;
  return started && waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// A path as gnuplot's single-quoted string.
std::string quoted(const std::filesystem::path& path)
{
  std::string text = "'";
  for (const char c : path.string())
    text += c == '\'' ? std::string("''") : std::string(1, c);
  return text + "'";
}

/// One picture in one or more formats.
struct Picture
{
  std::string name;
  std::vector<std::pair<const char*, std::string>> terminals; ///< file ending and gnuplot terminal
};
} // namespace

DrawnFigures draw_figures(const std::vector<FinishedTest>& tests, const std::filesystem::path& folder)
{
  DrawnFigures drawn;
  // The script stays beside the picture, for whoever wants it drawn otherwise.
  const auto draw = [&](const Picture& picture, const std::string& data, const std::string& plots) {
    std::string script = "set encoding utf8\n" + data;
    for (const auto& [ending, terminal] : picture.terminals)
      script += fmt::format("set terminal {} font 'DejaVu Sans,11'\nset output {}\n{}unset output\n", terminal,
                            quoted(folder / (picture.name + ending)), plots);
    const std::filesystem::path file = folder / (picture.name + ".gp");
    write_text_file(file, script);
    const bool done = run_gnuplot(file);
    for (const auto& terminal : picture.terminals)
      {
        const std::filesystem::path figure = folder / (picture.name + terminal.first);
        if (done && std::filesystem::exists(figure))
          drawn.files.push_back(figure);
        else if (drawn.problem.empty())
          drawn.problem =
            fmt::format("{} was not drawn: is gnuplot (package gnuplot-nox) installed?", figure.filename().string());
      }
  };

  for (const auto& test : tests)
    {
      if (test.record.curve.empty())
        continue; // it could not be made
      draw({test.name + "_stress_strain",
            {{".png", "pngcairo size 900,650"}, {".svg", "svg size 900,650"}, {".pdf", "pdfcairo size 16cm,11.5cm"}}},
           curve_data(test), curve_plot(test));
      draw({test.name + "_cracks", {{".png", "pngcairo size 900,1600"}}}, map_data(test), map_plot(test));
    }

  // Curves above, maps below, of the first specimen; of the confinements the lowest and the highest.
  double lowest = std::numeric_limits<double>::infinity();
  double highest = 0.0;
  for (const auto& test : tests)
    if (test.record.kind == TestKind::triaxial_compression)
      {
        lowest = std::min(lowest, test.record.confining_pressure);
        highest = std::max(highest, test.record.confining_pressure);
      }
  const auto shown = [&](const FinishedTest& test) {
    const double pressure = test.record.confining_pressure;
    return !test.record.curve.empty() && test.record.seed == tests.front().record.seed &&
           test.variant == tests.front().variant &&
           (test.record.kind != TestKind::triaxial_compression || pressure == lowest || pressure == highest);
  };
  std::string data;
  std::string curves;
  std::string maps;
  int n_columns = 0;
  for (const auto& test : tests)
    if (shown(test))
      {
        data += curve_data(test) + map_data(test);
        curves += curve_plot(test);
        maps += map_plot(test);
        ++n_columns;
      }
  draw({"overview", {{".png", fmt::format("pngcairo size {},1250", 620 * n_columns)}}}, data,
       fmt::format("set multiplot layout 2,{}\n{}{}unset multiplot\n", n_columns, curves, maps));
  return drawn;
}
} // namespace feldspar
