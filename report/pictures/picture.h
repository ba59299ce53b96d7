#pragma once

#include "report/chart/chart.h"

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace feldspar
{
/// A picture to be drawn.
struct Picture
{
  std::string name;        ///< of its files, without ending: plain (base/quoted.h)
  std::string caption;     ///< what it shows
  std::string alternative; ///< the same in words, for who cannot see it
  int width = 0;           ///< [px]
  int height = 0;
  bool raster = false; ///< thousands of shapes: shown as PNG; else as SVG
  bool vector = true;  ///< drawn as SVG and PDF
  std::vector<Chart> panels = {};
  int columns = 1;               ///< of panels
  std::string body = {};         ///< in the place of panels a body in space, which the viewer draws: JSON; PNG only
  std::string story = {};        ///< what the page's script shows in its place, JSON; empty: the chart, if it can
  std::string live_caption = {}; ///< of what is shown in its place; empty: the same caption

  /// The file that is shown.
  std::string shown_file() const { return name + (raster ? ".png" : ".svg"); }

  /// Script for gnuplot with the data and the commands that draw them.
  std::string script() const;

  /// Returns the JSON that the page's script shows in place of the picture; empty: only the picture.
  std::string live() const;
};

/// The picture of one chart, of this size [px] and higher where its key needs more rows, so that the key takes no room from
/// the axes. None of an empty chart.
std::vector<Picture> picture_of(Chart chart, int width, int height, const std::string& name, const std::string& caption,
                                const std::string& alternative);

/// Observer that waits for pictures.
struct DrawingWatch
{
  /// Asked again and again: whether no more are to be drawn.
  std::function<bool()> is_over = [] { return false; };
  /// Told after each, one at a time, how many of how many are done.
  std::function<void(std::size_t n_done, std::size_t n)> hear = [](std::size_t, std::size_t) {};
};

/// Draws pictures into a folder that exists, several at a time; the script of each stays beside it, for whoever wants
/// it drawn otherwise: run there, it draws into the folder it is run in. A program that takes longer than `longest` for a
/// picture is ended, and draws no other. Bodies in space are left to PictureBook (report/page/picture_book.h). Once watch.is_over() says so no other is begun and those that are being drawn are
/// ended. Returns for each why it could not be drawn, or nothing.
std::vector<std::string> draw(const std::vector<Picture>& pictures, const std::filesystem::path& folder,
                              std::chrono::milliseconds longest = std::chrono::minutes(5),
                              const DrawingWatch& watch = {});
} // namespace feldspar
