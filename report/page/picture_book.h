#pragma once

#include "report/page/page.h"

#include <filesystem>
#include <string>
#include <vector>

namespace feldspar
{
/// Pictures of a page and of its folder, drawn together when all are known.
class PictureBook
{
public:
  /// Pictures for the page, in their places there; whether they could be drawn is filled in by draw_into(). A name that
  /// is taken is changed.
  std::vector<PagePicture> keep(std::vector<Picture> pictures);

  /// Pictures that go to files only; those whose names are taken are on the page already.
  void keep_as_files(std::vector<Picture> pictures);

  /// Draws all into a folder that exists, until watch.is_over() says that it is enough, and tells the page which are not there.
  /// Returns why the first of these is not; empty if all are.
  std::string draw_into(const std::filesystem::path& folder, Page& page, const DrawingWatch& watch) const;

private:
  /// Draws bodies in space by a browser. Returns the names of the pictures that are missing.
  std::vector<std::string> draw_bodies_into(const std::filesystem::path& folder, const DrawingWatch& watch) const;

  bool is_taken(const std::string& name) const;

  std::vector<Picture> all;
};
} // namespace feldspar
