#pragma once

#include "report/page/table.h"
#include "report/pictures/picture.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace feldspar
{
/// A picture on the page, or why it is not there.
struct PagePicture
{
  Picture picture;
  std::string problem;
};

/// Judgement of a tile, by which it is marked and coloured.
enum class TileMark
{
  none,
  good,
  bad,
  not_decided
};

/// A property as a tile, its mean and deviation on a bar with the range of the experiments.
struct Tile
{
  std::string property = {};
  std::string value = {}; ///< with its unit
  std::string notes = {}; ///< of the experiment, and how sure the place in its range is
  std::size_t n = 0;      ///< specimens
  double mean = 0.0;
  double deviation = 0.0;
  std::optional<double> low = {}; ///< of the range; none without an experiment
  std::optional<double> high = {};
  TileMark mark = TileMark::none;
};

/// A piece of a section; what is empty is left out.
struct PageBlock
{
  std::string folded = {}; ///< heading of a block that is to be opened first
  std::string subheading = {};
  std::string chip = {}; ///< colour beside the subheading
  std::string headline = {};
  std::vector<std::string> paragraphs = {};
  std::vector<Tile> tiles = {};
  std::vector<std::string> points = {};
  std::vector<std::string> warnings = {};
  std::vector<Table> tables = {};
  std::vector<Table> tables_as_files = {}; ///< beside the page alone
  std::vector<PagePicture> pictures = {};
  /// The first left of headline and paragraphs, where the screen is wide enough; others below them.
  std::vector<PagePicture> lead = {};
};

struct PageSection
{
  std::string id;
  std::string short_title; ///< for the list of sections
  std::string heading;
  std::vector<PageBlock> blocks = {};
  std::string folded = {}; ///< heading of all its blocks where they are to be opened first
};

struct Page
{
  std::string title = {};
  std::string subtitle = {};
  std::string labels = {};     ///< client, specimen, author and date, or empty
  std::string paper_head = {}; ///< top of each printed page; empty: none
  std::vector<PageSection> sections = {};
  bool prints_folded = true; ///< parts that are to be opened stand on paper, too
};

/// Writes the page as one file that needs no other and no network. Pictures stand in it as data, as far as the text leaves
/// room for them in `most_bytes`, 10 MB with what stands in their place; the others are named instead. A script shows curves and specimens so that they respond to
/// the pointer. `figures` is where they were drawn, beside the page.
void write_page(const Page& page, const std::filesystem::path& file, const std::filesystem::path& figures,
                std::size_t most_bytes = 9'900'000);
} // namespace feldspar
