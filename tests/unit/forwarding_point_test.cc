// A point that wraps another one lets every call of the seam through.

#include "fem/materials/linear_elasticity.h"
#include "fem/materials/plane_strain.h"

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace feldspar::fem
{
namespace
{
using Calls = std::set<std::string>;

/// Notes which of its functions were called, and responds with numbers that tell its components apart.
template <int dim>
class NotingPoint final : public MaterialPoint<dim>
{
public:
  explicit NotingPoint(Calls& its_calls)
    : calls(its_calls)
  {
  }

  MaterialResponse<dim> trial(const StrainVector<dim>& strain) const override
  {
    note("trial");
    return {stiffness() * strain, stiffness()};
  }
  std::size_t relax(const StrainVector<dim>&) override { return note("relax"), 3; }
  PointEvents<dim> relax_once(const StrainVector<dim>& strain) override
  {
    note("relax_once");
    return {1, stiffness() * strain};
  }
  void accept(const StrainVector<dim>&) override { note("accept"); }
  void reject() override { note("reject"); }
  std::string stored() const override { return note("stored"), "bytes"; }
  void restore(const std::string& stored) override
  {
    note("restore");
    EXPECT_EQ(stored, "bytes");
  }
  std::vector<double> fields() const override { return note("fields"), std::vector<double>{1.0, 2.0}; }
  std::optional<PointEnergies> energies() const override { return note("energies"), PointEnergies{1.0, 2.0, 3.0, 4.0}; }
  std::vector<PointCrack<dim>> cracks_of_last_step() const override
  {
    note("cracks_of_last_step");
    PointCrack<dim> crack{true, 7, {}, 0.5, 0.25, 0.125};
    for (int c = 0; c < dim; ++c)
      crack.normal[c] = c + 1.0;
    return {crack};
  }
  bool is_damaged() const override { return note("is_damaged"), true; }
  std::any structure() const override { return note("structure"), std::string("grains"); }

  static StiffnessMatrix<dim> stiffness() { return isotropic_stiffness<dim>(1e9, 0.2); }

private:
  void note(const char* const call) const { calls.insert(call); }

  Calls& calls;
};

/// The names of the virtual functions in the source of the seam.
Calls functions_of_the_seam()
{
  std::ostringstream text;
  text << std::ifstream(FELDSPAR_SOURCE_DIR "/fem/materials/material.h").rdbuf();
  const std::string source = text.str();
  const std::regex declaration(R"(virtual [^~;{]*?([a-z_]+)\()");
  Calls names;
  for (auto found = std::sregex_iterator(source.begin(), source.end(), declaration); found != std::sregex_iterator();
       ++found)
    names.insert((*found)[1]);
  return names;
}

template <int dim>
void call_everything(MaterialPoint<dim>& point)
{
  const StrainVector<dim> strain = StrainVector<dim>::Constant(1e-3);
  point.trial(strain);
  EXPECT_EQ(point.relax(strain), 3u);
  EXPECT_EQ(point.relax_once(strain).n, 1u);
  point.accept(strain);
  point.reject();
  point.restore(point.stored());
  EXPECT_EQ(point.fields(), (std::vector<double>{1.0, 2.0}));
  EXPECT_EQ(point.energies().value().settled, 4.0);
  const auto cracks = point.cracks_of_last_step();
  ASSERT_EQ(cracks.size(), 1u);
  EXPECT_TRUE(cracks[0].in_tension);
  EXPECT_EQ(cracks[0].segment, 7u);
  EXPECT_EQ(cracks[0].size, 0.5);
  EXPECT_EQ(cracks[0].released_energy, 0.25);
  EXPECT_EQ(cracks[0].released_density, 0.125);
  EXPECT_TRUE(point.is_damaged());
  EXPECT_EQ(std::any_cast<std::string>(point.structure()), "grains");
}

// A function that the seam gains and a forwarding point does not know is found here: it is in the source and was not called.
TEST(ForwardingPoint, LetsEveryCallThrough)
{
  Calls calls;
  ForwardingPoint<2> point(std::make_unique<NotingPoint<2>>(calls));
  call_everything(point);
  EXPECT_EQ(calls, functions_of_the_seam());
}

TEST(ForwardingPoint, OfPlaneStrainLetsEveryCallThroughInItsAxes)
{
  Calls calls;
  const Material<2> material =
    plane_strain({[&](const PointPlace&) { return std::make_unique<NotingPoint<3>>(calls); }, {}});
  const auto point = material.make_point({"0_0:", 0, 0, {0.0, 0.0}, 1.0});
  call_everything(*point);
  EXPECT_EQ(calls, functions_of_the_seam());

  // x and y of the plane are x and z of the material.
  const StrainVector<2> strain(1e-3, 2e-3, 3e-3);
  const StrainVector<2> expected = isotropic_stiffness<2>(1e9, 0.2) * strain;
  EXPECT_LT((point->trial(strain).stress - expected).norm(), 1e-9 * expected.norm());
  EXPECT_LT((point->relax_once(strain).stress - expected).norm(), 1e-9 * expected.norm());
  EXPECT_LT((point->trial(strain).tangent - isotropic_stiffness<2>(1e9, 0.2)).norm(), 1.0);
  EXPECT_EQ(point->cracks_of_last_step()[0].normal, Eigen::Vector2d(1.0, 3.0));
}
} // namespace
} // namespace feldspar::fem
