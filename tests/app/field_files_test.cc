// The files for ParaView, opened by the XDMF library.

#include "dem/lab/protocols/protocols.h"
#include "results/folder/result_folder.h"
#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <XdmfAttribute.hpp>
#include <XdmfDomain.hpp>
#include <XdmfGeometry.hpp>
#include <XdmfGridCollection.hpp>
#include <XdmfGridCollectionType.hpp>
#include <XdmfReader.hpp>
#include <XdmfTime.hpp>
#include <XdmfTopology.hpp>
#include <XdmfUnstructuredGrid.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace feldspar::tests
{
namespace
{
namespace fs = std::filesystem;

/// Points and what is known of each, at one time.
struct Points
{
  double time;
  std::size_t n_points;
  std::vector<double> centre; ///< [3 n_points]
  std::map<std::string, std::vector<double>> attributes;

  std::set<std::string> names() const
  {
    std::set<std::string> all;
    for (const auto& [name, values] : attributes)
      all.insert(name);
    return all;
  }
};

std::vector<double> values(const shared_ptr<XdmfArray>& array)
{
  array->read();
  std::vector<double> all(array->getSize());
  array->getValues(0, all.data(), unsigned(all.size()));
  return all;
}

std::vector<Points> read_time_series(const fs::path& file)
{
  const auto domain = shared_dynamic_cast<XdmfDomain>(XdmfReader::New()->read(file.string()));
  const auto collection = domain->getGridCollection(0u);
  EXPECT_EQ(collection->getType(), XdmfGridCollectionType::Temporal());
  std::vector<Points> series;
  for (unsigned int k = 0; k < collection->getNumberUnstructuredGrids(); ++k)
    {
      const auto grid = collection->getUnstructuredGrid(k);
      Points points{grid->getTime()->getValue(), 0, values(grid->getGeometry()), {}};
      points.n_points = grid->getGeometry()->getNumberPoints(); // known now that it has been read
      for (unsigned int a = 0; a < grid->getNumberAttributes(); ++a)
        points.attributes[grid->getAttribute(a)->getName()] = values(grid->getAttribute(a));
      series.push_back(points);
    }
  return series;
}

/// Both tables of the result folder and these files hold what the test left behind, to the last digit.
void expect_grains(const std::vector<Points>& series, const TestAppearance& appearance, const bool ends_at_the_last_row)
{
  const auto& grains = appearance.grains_at_end;
  ASSERT_GE(series.size(), 2u);
  EXPECT_EQ(series.front().time, 0.0);
  for (std::size_t k = 0; k < series.size(); ++k)
    {
      const Points& at_time = series[k];
      ASSERT_EQ(at_time.n_points, grains.size());
      EXPECT_EQ(at_time.names(),
                (std::set<std::string>{"broken elements", "displacement", "fragment", "radius", "stress"}));
      EXPECT_TRUE(k == 0 || at_time.time > series[k - 1].time);
      for (std::size_t i = 0; i < at_time.n_points; ++i)
        {
          const auto& grain = grains[i];
          EXPECT_EQ(at_time.attributes.at("radius")[i], grain.radius);
          for (std::size_t c = 0; c < 3; ++c)
            // x - x_0 is rounded once, x_0 + (x - x_0) again: twice half a unit of the last place.
            EXPECT_NEAR(at_time.centre[3 * i + c] - at_time.attributes.at("displacement")[3 * i + c], grain.start[c],
                        2e-16 * std::abs(grain.start[c]) + 1e-19);
        }
    }
  for (std::size_t i = 0; ends_at_the_last_row && i < grains.size(); ++i)
    EXPECT_EQ(series.back().attributes.at("fragment")[i], grains[i].fragment);
  EXPECT_GT(*std::max_element(series.back().attributes.at("broken elements").begin(),
                              series.back().attributes.at("broken elements").end()),
            0.0);
}

/// The cracks of a test at each time are those up to the row of the curve with that strain.
void expect_cracks(const std::vector<Points>& series, const TestRecord& record)
{
  ASSERT_GE(series.size(), 2u);
  // Else a reader that takes all cracks at all times would pass.
  EXPECT_LT(series.front().n_points, series.back().n_points);
  for (const Points& at_time : series)
    {
      EXPECT_EQ(at_time.names(), (std::set<std::string>{"is shear", "normal", "released energy", "size", "step"}));
      const auto row = std::find_if(record.curve.begin(), record.curve.end(), [&](const CurveSample& sample) {
        return std::abs(100.0 * record.kind.sign * sample.axial_strain - at_time.time) < 1e-12 * at_time.time;
      });
      ASSERT_NE(row, record.curve.end()) << at_time.time;
      const auto n = std::size_t(std::count_if(record.cracks.begin(), record.cracks.end(),
                                               [&](const Crack& crack) { return crack.step <= row->step; }));
      ASSERT_EQ(at_time.n_points, n);
      for (std::size_t i = 0; i < n; ++i)
        {
          const Crack& crack = record.cracks[i];
          EXPECT_EQ(at_time.attributes.at("size")[i], crack.size);
          EXPECT_EQ(at_time.attributes.at("released energy")[i], crack.released_energy);
          EXPECT_EQ(at_time.attributes.at("is shear")[i], double(crack.kind == CrackKind::shear));
          EXPECT_EQ(at_time.attributes.at("step")[i], double(crack.step));
          for (std::size_t c = 0; c < 3; ++c)
            {
              EXPECT_EQ(at_time.centre[3 * i + c], crack.centroid[c]);
              EXPECT_EQ(at_time.attributes.at("normal")[3 * i + c], crack.normal[c]);
            }
        }
    }
}

/// Snapshots are some rows apart, so that the last may come before the end.
void expect_fields(const TemporaryFolder& folder, const bool ends_at_the_last_row)
{
  const auto outcome = run_feldspar(folder.path(), "lab rock.prm --output out --quiet");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.error;
  const fs::path out = folder.path() / "out";
  const auto series = read_result_folder(out, test_kinds());
  ASSERT_FALSE(series.front().tests.empty());
  for (const auto& test : series.front().tests)
    {
      SCOPED_TRACE(test.name);
      expect_grains(read_time_series(out / "fields" / (test.name + "_grains.xdmf")), test.appearance,
                    ends_at_the_last_row);
      expect_cracks(read_time_series(out / "fields" / (test.name + "_cracks.xdmf")), test.record);
    }
}

TEST(FieldFiles, OfAPlaneTestAreReadByTheXdmfLibrary)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", R"(subsection Specimen
  set Width = 14 mm
  set Height = 28 mm
end
subsection Tests
  set List = uniaxial_compression
  set Stop stress over peak = 0.7
end
)");
  expect_fields(folder, false);
}

TEST(FieldFiles, OfATestInSpaceAreReadByTheXdmfLibrary)
{
  const TemporaryFolder folder;
  folder.write("rock.prm", R"(subsection Specimen
  set Dimension = 3
  set Shape = cylinder
  set Width = 6 mm
  set Height = 8 mm
  set Porosity = 0.42
end
subsection Tests
  set List = triaxial_compression
  set Confinements = 10 MPa
  set Compression strain rate = 8 1/s
  set Compression sampling strain = 1e-4
  set Stop strain over peak strain = 1.1
end
)");
  expect_fields(folder, true);
}
} // namespace
} // namespace feldspar::tests
