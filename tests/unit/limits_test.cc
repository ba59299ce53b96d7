#include "app/input/input.h"
#include "app/input/input_entries.h"
#include "dem/lab/protocols/protocols.h"
#include "results/folder/calibration_record.h"
#include "results/folder/reference.h"
#include "results/folder/result_folder.h"
#include "results/sample_fields.h"
#include "tests/temporary_folder.h"
#include "tests/words.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <ctime>
#include <functional>
#include <string>

/// Depth and size of files from outside: each reader says its limit in a line, long before it lacks stack, time or memory.
namespace feldspar
{
namespace
{
using tests::has;
using tests::TemporaryFolder;

std::string refusal(const std::function<void()>& read)
{
  // Limit of processor time; readers that take the square of these sizes need more.
  constexpr double most_seconds = 10.0;
  const std::clock_t begin = std::clock();
  const std::string words = tests::refusal(read);
  EXPECT_LT(double(std::clock() - begin) / CLOCKS_PER_SEC, most_seconds);
  EXPECT_FALSE(has(words, "\n"));
  return words;
}

std::string repeated(const std::string_view text, const std::size_t n)
{
  std::string all;
  for (std::size_t k = 0; k < n; ++k)
    all += text;
  return all;
}

TEST(Limits, OfJsonAreThoseOfAllItsReaders)
{
  const TemporaryFolder folder;
  const auto readers = [&](const std::string& text) {
    std::vector<std::string> words;
    const auto input = folder.write("input.json", text);
    words.push_back(refusal([&] { read_input(input); }));
    words.push_back(refusal([&] { read_reference(input, test_kinds()); }));
    folder.write("summary.json", text);
    words.push_back(refusal([&] { read_result_folder(folder.path(), test_kinds()); }));
    folder.write("calibration.json", text);
    words.push_back(refusal([&] { read_calibration(folder.path()); }));
    return words;
  };
  constexpr std::size_t deep = 60000;
  constexpr std::size_t many = 80000;
  std::string names = "{";
  for (std::size_t k = 0; k < many; ++k)
    names += fmt::format("{}\"name {}\": 1", k > 0 ? "," : "", k);
  names += "}";
  for (const std::string& text :
       {repeated("[", deep) + repeated("]", deep), repeated("{\"a\":", deep) + "1" + repeated("}", deep),
        repeated("[{\"a\":", deep) + "1" + repeated("}]", deep), repeated("[", deep)})
    for (const std::string& refused : readers(text))
      EXPECT_TRUE(has(refused, ".json: is nested more than 100 levels deep"));
  const std::string words = refusal([&] { read_input(folder.write("input.json", names)); });
  EXPECT_TRUE(has(words, ".json: an object has more than 20000 names"));
}

TEST(Limits, OfXdmfAreItsDepth)
{
  const TemporaryFolder folder;
  const auto read = [&](const std::string& text) {
    folder.write("a.xdmf", text);
    return refusal([&] { read_sample_fields(folder.path(), "a"); });
  };
  constexpr std::size_t deep = 50000;
  for (const std::string& text : {repeated("<Grid>", deep) + repeated("</Grid>", deep), repeated("<Grid>", deep),
                                  "<Xdmf><!--" + repeated("</Xdmf>", deep) + "-->" + repeated("<Grid a=\"b\">", deep)})
    EXPECT_TRUE(has(read(text), "a.xdmf: is nested more than 100 levels deep"));
  // Many elements side by side are no depth; these name no time.
  EXPECT_TRUE(has(read("<Xdmf>" + repeated("<Grid/>", deep) + "</Xdmf>"), "not XDMF"));
  EXPECT_TRUE(has(read(""), "not XDMF"));
}

TEST(Limits, OfOutlinesAreTheirCorners)
{
  constexpr std::size_t many = 60000;
  std::string corners;
  for (std::size_t k = 0; k < many; ++k)
    corners += fmt::format("{}{}, {}", k > 0 ? ", " : "", k % 40, 0.001 * double(k));
  EXPECT_TRUE(has(refusal([&] { parse_shapes("hole corners " + corners + " mm"); }),
                  "has 60000 points; there must be at most 10000"));
  EXPECT_TRUE(has(refusal([&] { parse_shapes("closed flaw points " + corners + " mm"); }),
                  "has 60000 points; there must be at most 10000"));
}
} // namespace
} // namespace feldspar
