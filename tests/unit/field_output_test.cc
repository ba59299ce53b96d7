#include "fem/materials/linear_elasticity.h"
#include "fem/output.h"
#include "fem/solid/platens.h"
#include "tests/fem_samples.h"
#include "tests/temporary_folder.h"
#include "tests/words.h"

#include <H5Cpp.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace feldspar::fem
{
namespace
{
using tests::has;

/// An elastic point that has something to tell: its height.
class TellingPoint : public LinearElasticPoint<2>
{
public:
  TellingPoint(const StiffnessMatrix<2>& its_stiffness, const double its_height)
    : LinearElasticPoint<2>(its_stiffness)
    , height(its_height)
  {
  }
  std::vector<double> fields() const override { return {height}; }

private:
  double height;
};

std::vector<double> read(const std::string& file, const std::string& name)
{
  const H5::DataSet set = H5::H5File(file, H5F_ACC_RDONLY).openDataSet(name);
  std::vector<double> values(std::size_t(set.getSpace().getSimpleExtentNpoints()));
  set.read(values.data(), H5::PredType::NATIVE_DOUBLE);
  return values;
}
} // namespace

TEST(FieldOutput, IsATimeSeriesOfWhatTheSolidHolds)
{
  const tests::TemporaryFolder folder;
  const auto mesh = plane_sample(MPI_COMM_WORLD, 0.05, 0.1, {2, 4}, 0);
  const Material<2> material{[](const PointPlace& place) {
                               return std::make_unique<TellingPoint>(isotropic_stiffness<2>(50e9, 0.0),
                                                                     place.position[1]);
                             },
                             {"height_m"}};
  Solid<2> solid(mesh, {}, material);
  FieldOutput output(folder.path(), "fields");
  for (const double strain : {-1e-4, -2e-4})
    {
      solve_and_accept(solid, PlatenTest<2>{.platens = Platens::rough}.pressing(strain * 0.1));
      output.write(solid, -strain);
    }

  std::ifstream file(folder.path() / "fields.xdmf");
  const std::string index{std::istreambuf_iterator<char>(file), {}};
  EXPECT_TRUE(has(index, "fields.h5:/nodes", "fields-0000.h5:/stress_yy_Pa", "fields-0001.h5:/strain_xy",
                  "fields-0001.h5:/height_m", "fields-0001.h5:/displacement", "Time Value=\"0.0001\"",
                  "Time Value=\"0.0002\""));

  // A value for each corner of each cell; ν = 0: σ_yy = E ε_yy.
  for (int step = 0; step < 2; ++step)
    {
      const auto stress =
        read((folder.path() / ("fields-000" + std::to_string(step) + ".h5")).string(), "stress_yy_Pa");
      EXPECT_EQ(stress.size(), 8u * 4u);
      for (const double value : stress)
        EXPECT_NEAR(value, 50e9 * -1e-4 * (step + 1), 1.0);
    }
  // Cells are 25 mm high: the mean heights of their points are those of their middles, in deal.II's single precision.
  for (const double height : read((folder.path() / "fields-0001.h5").string(), "height_m"))
    EXPECT_NEAR(std::fmod(height, 0.025), 0.0125, 1e-8);
}
} // namespace feldspar::fem
