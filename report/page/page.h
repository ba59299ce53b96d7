#pragma once

#include "report/page/table.h"
#include "report/pictures/picture.h"

#include <filesystem>
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

/// A piece of a section; what is empty is left out.
struct PageBlock
{
  std::string folded; ///< heading of a block that is to be opened first
  std::string subheading;
  std::string chip; ///< colour beside the subheading
  std::string headline;
  std::vector<std::string> paragraphs;
  std::vector<std::string> points;
  std::vector<std::string> warnings;
  std::vector<Table> tables;
  std::vector<Table> tables_as_files; ///< beside the page alone
  std::vector<PagePicture> pictures;
  std::vector<PagePicture>
    lead; ///< the first left of the words above, where the screen is wide enough; others below them
};

struct PageSection
{
  std::string id;
  std::string short_title; ///< for the list of sections
  std::string heading;
  std::vector<PageBlock> blocks;
};

struct Page
{
  std::string title;
  std::string subtitle;
  std::vector<PageSection> sections;
};

/// Writes the page as one file that needs no other and no network. Pictures stand in it as data, as far as the text leaves
/// room for them in 10 MB; the others are named instead. A script shows curves and specimens so that they respond to
/// the pointer. `figures` is where they were drawn, beside the page.
void write_page(const Page& page, const std::filesystem::path& file, const std::filesystem::path& figures);
} // namespace feldspar
