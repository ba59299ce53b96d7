#pragma once

#include "base/prefixes.h"
#include "results/evaluation.h"
#include "results/runs/series.h"

#include <array>
#include <cstddef>
#include <string>

/// The common style of all pictures: colours that the colour-blind tell apart (Okabe and Ito), and the looks of a plot.
namespace feldspar::plot
{
inline constexpr double percent = 1e-2;

inline constexpr const char* black = "#000000"; ///< measured on rock
inline constexpr const char* grey = "#8c8c8c";  ///< the model of another
inline constexpr const char* light_grey = "#d8d8d8";
inline constexpr const char* blue = "#0072B2";
inline constexpr const char* vermillion = "#D55E00";
inline constexpr const char* green = "#009E73";
inline constexpr const char* purple = "#CC79A7";
inline constexpr const char* sky = "#56B4E9";
inline constexpr const char* orange = "#E69F00";
inline constexpr const char* brown = "#8C564B"; // this and the next are not of that scheme
inline constexpr const char* lime = "#9ACD32";

// A colour has one meaning on a page: these two are kinds of cracks and no series.
inline constexpr const char* tension_colour = vermillion;
inline constexpr const char* shear_colour = blue;
inline constexpr const char* single_grain_colour = "#f0e0b8";

// Of energies: the muted scheme of Tol, none of which is a series or a kind of crack.
inline constexpr const char* indigo = "#332288";
inline constexpr const char* teal = "#44AA99";
inline constexpr const char* olive = "#999933";
inline constexpr const char* wine = "#882255";
inline constexpr const char* sand = "#DDCC77";
inline constexpr const char* rose = "#CC6677";

/// The colour of the n-th series; a measured curve is black.
std::string colour(const Series& series, std::size_t n);

/// gnuplot's number of the mark for points of a series: by what its tests were made on.
int point_type(const Series& series);

/// Dashes tell series apart where colours repeat.
int dashes(std::size_t n);

/// Axis labels, grid, and the key under the plot, where it hides nothing.
std::string frame(const std::string& x_label, const std::string& y_label);

/// `title` for the key of a plot, or none.
std::string title(const std::string& text);

/// The key under a plot in columns of five rows. Where labels are too long for so many columns side by side there are fewer,
/// with more rows: gnuplot would draw what does not fit beyond the edge of the picture.
class ColumnKey
{
public:
  /// `title` of an entry, as above.
  std::string entry(const std::string& label);
  /// gnuplot's setting, for a picture of this width [px].
  std::string set_up(int picture_width) const;
  /// What a picture of this width must be higher, so that the key takes no room from the axes [px].
  int further_height(int picture_width) const;

private:
  int n_rows(int picture_width) const;

  int n_entries = 0;
  int longest = 0; ///< [characters]
};

/// gnuplot's name for data of an owner, such as a test: letters that it takes, a `_` for each other.
std::string data_block(const std::string& what, const std::string& owner);

/// A row `x y dx dy` [mm] for add_cracks(): the trace of a crack's face in the plane of the picture, whose vertical axis is
/// this one of the crack's; origin [m].
std::string trace_of(const Crack& crack, std::size_t axis, const std::array<double, 2>& origin = {});

/// Adds the cracks of one kind to the n-th of several plots, their rows `x y dx dy` to its data; none, nothing.
void add_cracks(std::string& data, std::string& plots, std::size_t n, CrackKind kind, const std::string& rows,
                double line_width);

/// A part of the names of files out of a label: letters, digits, `-` and `.` of it, at most 60, a
/// letter or a digit first; empty if there is none.
std::string file_name(const std::string& label);
} // namespace feldspar::plot
