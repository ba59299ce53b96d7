// Texts of others as gnuplot reads them: tested by gnuplot itself, because a rule of ours about it could be wrong.

#include "base/quoted.h"
#include "report/chart/gnuplot_writer.h"
#include "report/pictures/picture.h"
#include "report/pictures/plot_style.h"
#include "tests/content.h"
#include "tests/temporary_folder.h"
#include "tests/words.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

namespace feldspar::tests
{
namespace
{
using namespace std::string_view_literals;
namespace fs = std::filesystem;

/// Texts that mean something to gnuplot, to its enhanced text, to a shell, to SVG or to none of them. Where a program
/// can be started it leaves a file.
std::vector<std::string> hostile_texts()
{
  std::vector<std::string> texts;
  for (const auto text : {
         "a\nsystem \"touch marker\"\n"sv,
         "a\r\nsystem \"touch marker\"\r\n"sv,
         "'; system \"touch marker\"; print '"sv,
         "'''; system \"touch marker\" #"sv,
         "''; system \"touch marker\""sv,
         "\"; system(\"touch marker\")"sv,
         "\\'; system \"touch marker\" #"sv,
         "`touch marker`"sv,
         "$(touch marker)"sv,
         "@run"sv,
         "!touch marker"sv,
         "|touch marker"sv,
         "ends with a backslash\\"sv,
         "\\n \\x0a \\140touch marker\\140"sv,
         "# no comment, 100 % %d %s $1 ${run}"sv,
         "{/Bold a} a_b^c ~d{e} &{f} @g"sv,
         "EOD\nEOD\n"sv,
         "<text>&amp;</text>]]><!-- -->"sv,
         "]]]>>"sv,
         "\x01\x07\x1b[31m\x7f"sv,
         "nul \0 in it"sv,
         "gr\xfcn \xff\xfe \xc3"sv,
         "\xc2\x85 \xc2\x9b"sv,
         "\xef\xbf\xbf"sv,
         "σ₃ – 5 °C \U0001F600"sv,
         ""sv,
         "'"sv,
       })
    texts.emplace_back(text);
  texts.push_back(std::string(6000, '\'') + "\nsystem \"touch marker\"\n");
  return texts;
}

/// Text as it is to be read in the picture.
std::string shown(const std::string& text)
{
  std::string result = printable(text);
  for (std::size_t at = 0; (at = result.find("]]>", at)) != std::string::npos;)
    result.insert(at + 2, 1, ' ');
  for (std::size_t at = 0; (at = result.find('\'', at)) != std::string::npos;)
    result.replace(at, 1, "’");
  return result;
}

TEST(GnuplotText, IsReadByGnuplotAsThatTextAlone)
{
  const TemporaryFolder folder;
  // Text that a macro would stand for, were it expanded.
  std::string script = "set encoding utf8\nrun = 'system \"touch marker\"'\nset print 'printed'\n";
  std::string expected;
  for (const std::string& text : hostile_texts())
    {
      script += fmt::format("print {}\n", gnuplot_text(text));
      expected += shown(text) + "\n";
    }
  folder.write("print.gp", script);
  ASSERT_EQ(std::system(fmt::format("cd '{}' && gnuplot -d print.gp 2>errors", folder.path().string()).c_str()), 0);
  EXPECT_EQ(content(folder.path() / "errors"), "");
  EXPECT_EQ(content(folder.path() / "printed"), expected);
  EXPECT_FALSE(fs::exists(folder.path() / "marker"));

  // The check can fail: the same words outside of quotes do start a program.
  folder.write("open.gp", "print 'a\nsystem \"touch marker\"\n");
  std::system(fmt::format("cd '{}' && gnuplot -d open.gp 2>errors", folder.path().string()).c_str());
  folder.write("backquotes.gp", "print \"`touch marker`\"\n");
  std::system(fmt::format("cd '{}' && gnuplot -d backquotes.gp 2>errors", folder.path().string()).c_str());
  EXPECT_TRUE(fs::exists(folder.path() / "marker"));
}

/// Two lines in a frame, with a text wherever a chart has one.
Picture picture(const std::string& name, const std::string& text = "")
{
  const ChartSeries line{.label = text, .colour = plot::blue, .points = {{0.0, 0.0}, {1.0, 1.0}}};
  const ChartSeries words{.kind = ChartSeries::Kind::texts,
                          .colour = plot::blue,
                          .size = 14.0,
                          .points = {{0.5, 0.5}},
                          .texts = {text}};
  Picture result;
  result.name = name;
  result.width = 900;
  result.height = 400;
  result.panels = {{.title = text,
                    .x = {.label = text},
                    .y = {.label = text},
                    .right = {.label = text},
                    .key_columns = 1,
                    .series = {line, line, words}}};
  return result;
}

/// Words of an SVG.
std::string unescaped(std::string svg)
{
  for (const auto& [escape, character] : {std::pair("&lt;", "<"), {"&gt;", ">"}, {"&quot;", "\""}, {"&amp;", "&"}})
    for (std::size_t at = 0; (at = svg.find(escape, at)) != std::string::npos; ++at)
      svg.replace(at, std::string(escape).size(), character);
  return svg;
}

TEST(GnuplotText, IsWrittenIntoPicturesAsItIsShown)
{
  const TemporaryFolder folder;
  std::vector<Picture> pictures;
  const auto texts = hostile_texts();
  for (const std::string& text : texts)
    if (text.size() < 1000) // longer ones leave no room for a plot
      pictures.push_back(picture(fmt::format("picture_{}", pictures.size()), text));
  std::vector<std::pair<std::size_t, std::size_t>> heard;
  DrawingWatch watch;
  watch.hear = [&](const std::size_t n_done, const std::size_t n) { heard.emplace_back(n_done, n); };
  const auto problems = draw(pictures, folder.path(), std::chrono::minutes(5), watch);
  ASSERT_EQ(heard.size(), pictures.size());
  for (std::size_t k = 0; k < heard.size(); ++k)
    EXPECT_EQ(heard[k], std::pair(k + 1, pictures.size()));
  for (std::size_t k = 0; k < pictures.size(); ++k)
    {
      EXPECT_EQ(problems[k], "") << printable(texts[k]);
      const std::string svg = content(folder.path() / (pictures[k].name + ".svg"));
      EXPECT_EQ(svg.find("]]>", svg.find("<desc>")), std::string::npos);
      const std::string words = shown(texts[k]);
      if (words.empty())
        continue;
      EXPECT_GE(times(unescaped(svg), words), 7u)
        << words; // three axes, the title of all, those of two lines and a text beside them
    }
  for (const auto& entry : fs::recursive_directory_iterator(folder.path()))
    EXPECT_NE(entry.path().filename(), "marker");
}

TEST(Draw, WorksInAFolderOfAnyNameAndTakesPlainNamesAlone)
{
  const TemporaryFolder folder;
  const fs::path odd = folder.path() / "|touch marker; `touch marker`\n' \xff -x";
  fs::create_directory(odd);
  EXPECT_EQ(draw({picture("line")}, odd).front(), "");
  EXPECT_GT(fs::file_size(odd / "line.svg"), 1000u);
  EXPECT_THROW(draw({picture("../line")}, odd), std::logic_error);
  for (const auto& entry : fs::recursive_directory_iterator(folder.path()))
    EXPECT_NE(entry.path().filename(), "marker");
}
TEST(Gnuplot, ThatHangsIsEndedAndNotAskedAgain)
{
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "bin");
  // A process that the program starts would outlive it: this process must end too.
  fs::permissions(folder.write("bin/gnuplot", "#!/bin/sh\nsleep 600 &\necho $! > sleeper\nwait\n"),
                  fs::perms::owner_all);
  const std::string path = std::getenv("PATH");
  setenv("PATH", ((folder.path() / "bin").string() + ":" + path).c_str(), 1);
  std::vector<Picture> pictures; // drawn side by side, so that each needs its own name
  for (const char* const name : {"a", "b", "c", "d", "e", "f", "g", "h", "i", "j"})
    pictures.push_back(picture(name));
  const auto begin = std::chrono::steady_clock::now();
  const auto problems = draw(pictures, folder.path(), std::chrono::milliseconds(300));
  setenv("PATH", path.c_str(), 1);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
  for (const std::string& problem : problems)
    EXPECT_EQ(problem.find(" was not drawn: gnuplot did not end "), 1u) << problem;
  std::ifstream file(folder.path() / "sleeper");
  int sleeper = 0;
  ASSERT_TRUE(file >> sleeper);
  // Gone, or dead and not yet fetched by who inherited it; one that is killed takes a moment to die on a busy machine.
  const auto state_of_sleeper = [&] {
    std::ifstream status("/proc/" + std::to_string(sleeper) + "/stat");
    std::string number;
    std::string name;
    std::string state = "Z";
    status >> number >> name >> state;
    return state;
  };
  for (int k = 0; k < 100 && state_of_sleeper() != "Z"; ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(state_of_sleeper(), "Z"); // alone it would sleep for ten minutes
}
} // namespace
} // namespace feldspar::tests
