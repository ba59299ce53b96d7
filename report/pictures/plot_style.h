#pragma once

#include "base/prefixes.h"
#include "results/runs/series.h"

#include <cstddef>
#include <string>
#include <string_view>

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

// Colours of energies: the muted scheme of Tol, none of which is a series or a kind of crack.
inline constexpr const char* indigo = "#332288";
inline constexpr const char* teal = "#44AA99";
inline constexpr const char* olive = "#999933";
inline constexpr const char* wine = "#882255";
inline constexpr const char* sand = "#DDCC77";
inline constexpr const char* rose = "#CC6677";

/// The colour of the n-th series; a measured curve is black.
std::string colour(const Series& series, std::size_t n);

/// The mark for points of a series: by what its tests were made on.
int point_type(const Series& series);

/// Dashes tell series apart where colours repeat.
int dashes(std::size_t n);

/// The largest number not above a positive one that is 1, 2 or 5 times a power of ten.
double round_number(double most);

/// Words with a capital letter of ASCII at their beginning.
std::string with_capital(std::string_view words);

/// A part of the names of files out of a label: letters, digits, `-` and `.` of it, at most 60, a
/// letter or a digit first; empty if there is none.
std::string file_name(const std::string& label);
} // namespace feldspar::plot
