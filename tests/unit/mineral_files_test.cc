#include "app/input/input.h"
#include "app/input/maps/mineral_files.h"
#include "tests/content.h"
#include "tests/temporary_folder.h"
#include "tests/words.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cstdint>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

/// Tables and pictures of minerals, as they are read and refused.
namespace feldspar
{
namespace
{
using tests::has;

void expect_words(const std::function<void()>& read, const std::string& words)
{
  EXPECT_TRUE(has(tests::refusal(read), words));
}

/// A PNG of one colour.
template <typename Channel>
std::filesystem::path png(const std::filesystem::path& file, const unsigned int format, const std::size_t n_channels,
                          const std::vector<Channel>& pixel, const unsigned int width = 4,
                          const unsigned int height = 3)
{
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.format = format;
  image.width = width;
  image.height = height;
  std::vector<Channel> pixels;
  for (std::size_t k = 0; k < std::size_t(width) * height; ++k)
    pixels.insert(pixels.end(), pixel.begin(), pixel.begin() + std::ptrdiff_t(n_channels));
  EXPECT_NE(png_image_write_to_file(&image, file.c_str(), 0, pixels.data(), 0, nullptr), 0) << image.message;
  return file;
}

TEST(MineralFiles, TablesAreReadInAnyUnit)
{
  const tests::TemporaryFolder folder;
  const auto minerals = read_minerals(
    folder.write("m.csv", "mineral,share [%],size [mm],aspect_ratio,angle [deg],colour,density [g/cm3],stiffness_ratio,"
                          "friction_ratio\n"
                          "quartz,35,3,,,#c0c0c0,2.65,1.2,\n"
                          "mica,65,2,4,90,,,0.5,0.4\n"));
  ASSERT_EQ(minerals.size(), 2u);
  EXPECT_EQ(minerals[0].name, "quartz");
  EXPECT_DOUBLE_EQ(*minerals[0].share, 0.35);
  EXPECT_DOUBLE_EQ(minerals[0].size, 3e-3);
  EXPECT_EQ(minerals[0].aspect_ratio, 1.0);
  EXPECT_FALSE(minerals[0].angle);
  EXPECT_EQ(minerals[0].colour, 0xc0c0c0u);
  EXPECT_NEAR(*minerals[0].density, 2650.0, 1e-9);
  EXPECT_EQ(minerals[0].within, (JointRatios{1.2, 1.0, 1.0, 1.0}));
  EXPECT_DOUBLE_EQ(*minerals[1].angle, std::numbers::pi / 2);
  EXPECT_FALSE(minerals[1].density);
  EXPECT_EQ(minerals[1].within, (JointRatios{0.5, 1.0, 1.0, 0.4}));
  const auto boundaries =
    read_mineral_boundaries(folder.write("b.csv", "mineral_1;mineral_2;tensile_strength_ratio\nmica;quartz;0,3\n"));
  ASSERT_EQ(boundaries.size(), 1u);
  EXPECT_EQ(boundaries[0].one + boundaries[0].two, "micaquartz");
  EXPECT_DOUBLE_EQ(*boundaries[0].tensile_strength, 0.3);
  EXPECT_FALSE(boundaries[0].cohesion);
}

TEST(MineralFiles, TablesWithMistakesAreRefused)
{
  const tests::TemporaryFolder folder;
  const auto table = [&](const std::string& text) { return [&, text] { read_minerals(folder.write("m.csv", text)); }; };
  expect_words(table("mineral,share [%]\n"), "there is no mineral below the header");
  expect_words(table("mineral,share [%]\nmica,20\nmica,80\n"), "m.csv:3: mica is in the table twice");
  expect_words(table("mineral,share [%]\nmica,120\n"), "share [%] = 120 must lie in 0 to 100 %");
  expect_words(table("mineral,size\nmica,2\n"), "has no unit; write it as in \"size [m]\"");
  expect_words(table("mineral,hardness\nmica,2\n"), "\"hardness\" is no column of this table; they are mineral, share");
  expect_words(table("mineral,colour\nmica,red\n"), "\"red\" is no colour; write red, green and blue as #rrggbb");
  expect_words(table("mineral\nmica/biotite\n"), "is no name of a mineral");
  expect_words(table("mineral,stiffness_ratio\nmica,0\n"), "stiffness_ratio = 0 must lie in");
  expect_words(table("share [%]\n2\n"), "mineral");
  expect_words([&] { read_mineral_boundaries(folder.write("b.csv", "mineral_1,mineral_2\na,b\nb,a\n")); },
               "b.csv:3: the boundary of b and a is in the table twice");
  expect_words([&] { read_mineral_map(folder.write("p.jpg", "x")); }, "p.jpg: is neither a picture in PNG (.png)");
  expect_words([&] { read_mineral_map(folder.write("p.csv", "x [mm],mineral\n1,mica\n")); }, "a point needs x and y");
}

TEST(MineralFiles, PicturesAreReadFromAbove)
{
  const tests::TemporaryFolder folder;
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.format = PNG_FORMAT_RGB;
  image.width = 1;
  image.height = 2;
  const std::uint8_t pixels[] = {255, 0, 0, 1, 2, 3};
  const auto file = folder.path() / "a.png";
  ASSERT_NE(png_image_write_to_file(&image, file.c_str(), 0, pixels, 0, nullptr), 0);
  const auto map = read_mineral_map(file);
  EXPECT_EQ(map->width, 1u);
  EXPECT_EQ(map->colour, (std::vector<std::uint32_t>{0xff0000, 0x010203}));
}

TEST(MineralFiles, PicturesOfOtherKindsAreRefused)
{
  const tests::TemporaryFolder folder;
  const auto picture = [](const std::filesystem::path& file) { return [file] { read_mineral_map(file); }; };
  expect_words(picture(folder.write("no.png", "GIF89a")), "no.png: is no PNG, or damaged");
  expect_words(picture(png<std::uint16_t>(folder.path() / "deep.png", PNG_FORMAT_LINEAR_RGB, 3, {9, 9, 9})),
               "has 16 bits a colour; save it with 8");
  expect_words(picture(png<std::uint8_t>(folder.path() / "alpha.png", PNG_FORMAT_RGBA, 4, {9, 9, 9, 9})),
               "has transparent pixels; save it without transparency");
  const auto whole = png<std::uint8_t>(folder.path() / "a.png", PNG_FORMAT_RGB, 3, {200, 100, 50}, 300, 300);
  const std::string bytes = tests::content(whole);
  expect_words(picture(folder.write("cut.png", bytes.substr(0, bytes.size() / 2))), "is no PNG, or damaged");
  // 10⁹ pixels by the header alone, whose checksum no longer fits or fits: refused before memory is asked for.
  const auto large = png<std::uint8_t>(folder.path() / "large.png", PNG_FORMAT_GRAY, 1, {7}, 10000, 6000);
  expect_words(picture(large), "has 10000 × 6000 pixels; at most 5e+07 are read");
}

class MineralInput : public testing::Test
{
protected:
  void refuses(const std::string& entries, const std::string& words)
  {
    expect_words([&] { read(entries); }, words);
  }

  Input read(const std::string& entries)
  {
    return read_input(folder.write("input.prm", "subsection Minerals\n" + entries + "\nend\n"));
  }

  tests::TemporaryFolder folder;
};

TEST_F(MineralInput, NeedsWhatBelongsTogether)
{
  folder.write("m.csv", "mineral,share [%],size [mm],colour\nquartz,40,5,#ff0000\nmica,60,5,#00ff00\n");
  folder.write("colours.csv", "mineral,colour\nquartz,#ff0000\nmica,#00ff00\n");
  folder.write("short.csv", "mineral,share [%],size [mm]\nquartz,40,5\n");
  folder.write("b.csv", "mineral_1,mineral_2,cohesion_ratio\nquartz,biotite,0.5\n");
  folder.write("p.csv", "x [mm],y [mm],mineral\n1,1,biotite\n");
  png<std::uint8_t>(folder.path() / "red.png", PNG_FORMAT_RGB, 3, {255, 0, 0}, 100, 200);
  png<std::uint8_t>(folder.path() / "grey.png", PNG_FORMAT_RGB, 3, {9, 9, 9}, 100, 200);
  EXPECT_EQ(read("set Table = m.csv").minerals.minerals.size(), 2u);
  EXPECT_EQ(read("set Table = colours.csv\n set Map = red.png\n set Pixel size = 0.5 mm").minerals.map->width, 100u);
  const MineralParameters all =
    read(
      "set Table = colours.csv\n set Map = red.png\n set Pixel size = 1 mm\n set Slices = 2\n set Slice distance = 30 mm\n"
      "set Boundary strength = 0.7\nend\nsubsection Specimen\n set Dimension = 3")
      .minerals;
  EXPECT_EQ(all.n_slices, 2u);
  EXPECT_DOUBLE_EQ(*all.pixel_size, 1e-3);
  EXPECT_DOUBLE_EQ(*all.slice_distance, 30e-3);
  EXPECT_EQ(all.boundary_strength, 0.7);
  EXPECT_EQ(read("set Table = m.csv\n set Grains = rigid").minerals.form, MineralGrainForm::rigid);
  const Input sought = read("set Table = m.csv\nend\nsubsection Calibration\n set Boundary strength = 0.2, 1");
  EXPECT_EQ(sought.calibration.boundary_strength->lower, 0.2);
  refuses("set Table = short.csv", "the shares add up to 40 %; they must be 100 % together");
  refuses("set Table = colours.csv", "quartz needs a share above 0 and a size above 0, for there is no Map");
  refuses("set Table = m.csv\n set Map = red.png\n set Pixel size = 0.5 mm",
          "has shares or sizes, which the map gives; leave these columns out, or the map");
  refuses("set Table = m.csv\n set Boundaries = b.csv", "\"biotite\" is not in the table of minerals");
  refuses("set Table = m.csv\n set Pixel size = 0.5 mm",
          "has no effect: Minerals/Table is none, or it is of a picture");
  refuses("end\nsubsection Calibration\n set Boundary strength = 0.2, 1", "needs minerals; set Minerals/Table");
  refuses("set Boundary strength = 0.5", "has no effect: Minerals/Table is none");
  refuses("set Table = colours.csv\n set Map = red.png", "a picture needs the size of its pixels");
  refuses("set Table = colours.csv\n set Map = red.png\n set Pixel size = 0.1 mm", "shows 10 mm of the width");
  refuses("set Table = colours.csv\n set Map = grey.png\n set Pixel size = 0.5 mm",
          "the pixel in row 1, column 1 has the colour #090909, which no mineral has; the table has #ff0000 quartz, "
          "#00ff00 mica");
  folder.write("micrometres.csv", "x [um],y [um],mineral\n1,1,quartz\n12,24,mica\n");
  refuses("set Table = colours.csv\n set Map = micrometres.csv",
          "span 0.011 mm of 50 mm of the specimen along x; give points over all of it, with their unit");
  refuses("set Table = colours.csv\n set Map = p.csv", "names \"biotite\", which is not in the table of minerals");
  refuses("set Table = m.csv\n set Grains = smooth boundaries", "says nothing of the bonds at the boundaries");
  refuses("set Table = m.csv\n set Grains = rigid\nend\nsubsection Specimen\n set Dimension = 3",
          "rigid mineral grains are in the plane");
  refuses(
    "set Table = colours.csv\n set Map = red.png\n set Pixel size = 0.5 mm\n set Grains = smooth boundaries\nend\n"
    "subsection Smooth joint\n set Tensile strength = 1 MPa\n set Cohesion = 1 MPa",
    "smooth boundaries are planes between Voronoi cells");
  refuses("set Table = m.csv\nend\nsubsection Clumps\n set Diameter = 5 mm", "excludes Clumps/Diameter");
}
} // namespace
} // namespace feldspar
