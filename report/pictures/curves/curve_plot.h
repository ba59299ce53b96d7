#pragma once

#include "report/live/chart.h"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace feldspar
{
/// Data blocks and plot entries in the making, and the same for the script of the page.
class CurvePlot
{
public:
  using Kind = ChartLine::Kind;
  using Points = std::vector<std::array<double, 2>>;
  static constexpr int width = 580; ///< [px]

  /// Layers are drawn from 0 to 2. Of its points the picture and the page show the same.
  void add(std::size_t layer, ChartLine line);

  /// A mean in layer 2 and, where there is one, the band around it in layer 0: there on one side, back on the other.
  struct Mean
  {
    std::string label;
    std::string colour;
    int dashes;
    Points points;
    Points above;
    Points below;
  };
  void add(Mean mean, bool has_band);

  std::string script(const Chart& axes, const std::string& set_up) const;
  std::string json(Chart axes) const;
  bool empty() const;

  /// Of a picture whose key has at most so many columns, fewer where labels are long: it takes no room from the axes.
  int height(int columns) const;

private:
  std::string data;
  std::array<std::vector<std::string>, 3> layers;
  std::array<std::vector<ChartLine>, 3> of_page;
  int n_blocks = 0;
  int n_keys = 0;
  int longest_key = 0; ///< [bytes]
};
} // namespace feldspar
