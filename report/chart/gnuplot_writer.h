#pragma once

#include "report/chart/chart.h"

#include <string>
#include <string_view>
#include <vector>

namespace feldspar
{
/// Commands that draw the panels of a picture, row by row in so many columns. The place of a panel without series and
/// title stays empty. The width of the picture [px] tells what has room in a key.
std::string gnuplot_script(const std::vector<Chart>& panels, int columns, int width);

/// Height to add to a picture of this width, so that its key takes no room from the axes [px].
int further_height(const Chart& chart, int width);

/// Text as gnuplot's single-quoted string, on one line whatever is in it; ’ stands for a quote. Every text that is not
/// written in our sources enters a script through this: gnuplot has no switch that forbids a script to start programs
/// (`system`, backquotes, `!`, an output that begins with `|`), and its commands end with their line.
std::string gnuplot_text(std::string_view text);
} // namespace feldspar
