// Grains that cannot have come into contact are not computed; no contact is missed by it.

#include "dem/dynamics/touches.h"

#include "base/random.h"
#include "tests/unit/small_specimen.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace feldspar
{
namespace
{
/// A contact that is computed in each step is the reference.
template <int dim>
void expect_that_no_touch_is_missed(const std::size_t n_across)
{
  constexpr double radius = 1e-3, spacing = 2.05 * radius, skin = 0.3 * radius, friction = 0.5, dt = 1e-3;
  const auto n = std::size_t(std::lround(std::pow(double(n_across), dim)));
  Random random(1, RandomStream::positions);
  Components<dim> positions;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t c = 0, rest = i; c < dim; ++c, rest /= n_across)
      positions[c].push_back(double(rest % n_across) * spacing);
  auto body = placed_specimen<dim>(std::vector<double>(n, radius), positions);
  for (auto& spins : body.grains.spin)
    for (double& spin : spins)
      spin = random.uniform(-1.0, 1.0);
  body.particle_contact.friction = friction;
  Images<dim> images(body);
  const Incidence no_joints = incidence(
    n, 0, [](std::size_t) { return GrainPair(); }, [](const std::uint32_t grain) { return grain; });
  EnergyLedger ledger(n);
  Touches<dim> looked_at, left_out, told_wrongly;
  for (auto* touches : {&looked_at, &left_out, &told_wrongly})
    touches->search(body, images, BodyShare<dim>(n), no_joints, skin, ZeroForce::at_touch, ledger, [] {});

  std::size_t n_came = 0, n_missed = 0;
  for (int step = 0; step < 400; ++step)
    {
      // To and fro about their places, by up to a tenth of a radius and in steps of all sizes.
      const double share = std::pow(10.0, random.uniform(-5.0, 0.0));
      double farthest = 0.0;
      for (std::size_t i = 0; i < n; ++i)
        {
          double squared_way = 0.0;
          for (int c = 0; c < dim; ++c)
            {
              const double to = positions[c][i] + random.uniform(-0.1, 0.1) * radius;
              const double way = share * (to - body.grains.position[c][i]);
              body.grains.position[c][i] += way;
              squared_way += way * way;
            }
          farthest = std::max(farthest, std::sqrt(squared_way));
        }
      const bool came = looked_at.update(body, dt, std::numeric_limits<double>::infinity());
      EXPECT_EQ(left_out.update(body, dt, farthest), came) << "step " << step;
      told_wrongly.update(body, dt, 0.0);
      n_missed += !std::ranges::equal(told_wrongly.touching(), looked_at.touching());
      n_came += came;
      ASSERT_TRUE(std::ranges::equal(left_out.touching(), looked_at.touching())) << "step " << step;
      for (const std::uint32_t k : looked_at.touching())
        {
          EXPECT_EQ(left_out.touch(k).on_grains.force, looked_at.touch(k).on_grains.force) << "step " << step;
          EXPECT_EQ(left_out.touch(k).slip_energy, looked_at.touch(k).slip_energy) << "step " << step;
        }
    }
  EXPECT_GT(n_came, 50u);    // they do come and go
  EXPECT_GT(n_missed, 100u); // and the ways decide which pairs are computed
}

TEST(Touches, AreNotMissedWhereGrainsAreNotLookedAt)
{
  expect_that_no_touch_is_missed<2>(12);
  expect_that_no_touch_is_missed<3>(6);
}
} // namespace
} // namespace feldspar
