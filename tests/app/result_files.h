#pragma once

#include "tests/content.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <vector>

/// Inputs of small runs, and the files that runs write.
namespace feldspar::tests
{
using Json = nlohmann::json;

/// A section of an input with its entries.
template <typename... Entries>
std::string section(const std::string& name, const Entries&... entries)
{
  std::string text = "subsection " + name + "\n";
  ((text += "  set " + std::string(entries) + "\n"), ...);
  return text + "end\n";
}

inline std::string replaced(std::string text, const std::string& what, const std::string& by)
{
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

inline Json read_json(const std::filesystem::path& file) { return Json::parse(content(file)); }

inline Json summary_of(const std::filesystem::path& folder) { return read_json(folder / "summary.json"); }

/// Columns of a table of numbers by their names; a cell that is no number is 0.
inline std::map<std::string, std::vector<double>> read_columns(const std::filesystem::path& file)
{
  std::istringstream lines(content(file));
  std::string line;
  std::getline(lines, line);
  std::vector<std::string> names;
  std::istringstream header(line);
  for (std::string name; std::getline(header, name, ',');)
    names.push_back(name);
  std::map<std::string, std::vector<double>> columns;
  for (const std::string& name : names)
    columns[name];
  while (std::getline(lines, line))
    {
      std::istringstream cells(line);
      std::string cell;
      for (std::size_t k = 0; std::getline(cells, cell, ','); ++k)
        columns[names.at(k)].push_back(std::strtod(cell.c_str(), nullptr));
    }
  return columns;
}

inline std::vector<double> column(const std::filesystem::path& file, const std::string& name)
{
  return read_columns(file).at(name);
}

/// These files of two folders have the same bytes.
inline void expect_same_files(const std::filesystem::path& one, const std::filesystem::path& other,
                              const std::vector<std::string>& files)
{
  for (const std::string& file : files)
    {
      EXPECT_TRUE(std::filesystem::exists(one / file)) << one / file;
      EXPECT_TRUE(content(one / file) == content(other / file)) << file << " of " << one << " and " << other;
    }
}
} // namespace feldspar::tests
