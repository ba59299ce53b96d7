#include "dem/dynamics/force_sum.h"

#include "base/parallel.h"
#include "base/random.h"
#include "tests/unit/small_specimen.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace feldspar
{
namespace
{
/// Discs or spheres on a lattice that is pressed together and repeats itself; they turn, so that friction acts.
template <int dim>
void expect_touches_by_their_numbers(const std::size_t n_across)
{
  constexpr double radius = 1e-3, spacing = 1.98 * radius, skin = 0.1 * radius, friction = 0.5;
  const auto n_own = std::size_t(std::lround(std::pow(double(n_across), dim)));
  Random random(1, RandomStream::positions);
  Components<dim> positions;
  for (std::size_t i = 0; i < n_own; ++i)
    for (std::size_t c = 0, rest = i; c < dim; ++c, rest /= n_across)
      positions[c].push_back((double(rest % n_across) + 0.5) * spacing + random.uniform(-0.03, 0.03) * radius);
  auto body = placed_specimen<dim>(std::vector<double>(n_own, radius), positions);
  body.periodic = true;
  body.size.setConstant(double(n_across) * spacing);

  Images<dim> images(body);
  images.add_within(skin, body.grains);
  for (auto& spins : body.grains.spin)
    for (std::size_t i = 0; i < n_own; ++i)
      spins[i] = random.uniform(-1.0, 1.0);
  images.move(0.0, body.grains);
  const Incidence no_joints = incidence(
    n_own, 0, [](std::size_t) { return GrainPair(); }, [](const std::uint32_t grain) { return grain; });
  Touches<dim> touches;
  EnergyLedger ledger(n_own);
  touches.search(body, images, no_joints, skin, ZeroForce::at_touch, ledger, [] {});
  touches.update(body.grains, friction, 0.0, 0.0);
  touches.update(body.grains, friction, 1e-3, 0.0);
  sum_forces(body, SumOrder(no_joints, 0), touches);

  Components<dim> force;
  Components<n_rotations<dim>> couple;
  for (auto& values : force)
    values.assign(n_own, 0.0);
  for (auto& values : couple)
    values.assign(n_own, 0.0);
  std::size_t n_across_the_side = 0;
  for (std::size_t k = 0; k < touches.list().size(); ++k)
    {
      if (!touches.is_touching(k))
        continue;
      const Touch<dim>& touch = touches.list()[k];
      const std::uint32_t second = images.owner(touch.grain_2);
      n_across_the_side += second != touch.grain_2;
      for (int c = 0; c < dim; ++c)
        {
          force[c][touch.grain_1] -= touch.on_grains.force[c];
          force[c][second] += touch.on_grains.force[c];
        }
      for (int c = 0; c < n_rotations<dim>; ++c)
        {
          couple[c][touch.grain_1] += touch.on_grains.couple_1[c];
          couple[c][second] += touch.on_grains.couple_2[c];
        }
    }
  // A few of them would be gone through touch by touch however large the body is.
  EXPECT_GT(8 * touches.touching().size(), n_own);
  EXPECT_GT(n_across_the_side, 10u);
  for (int c = 0; c < dim; ++c)
    for (std::size_t i = 0; i < n_own; ++i)
      ASSERT_EQ(body.grains.force[c][i], force[c][i]) << "grain " << i;
  double largest_couple = 0.0;
  for (int c = 0; c < n_rotations<dim>; ++c)
    for (std::size_t i = 0; i < n_own; ++i)
      {
        ASSERT_EQ(body.grains.couple[c][i], couple[c][i]) << "grain " << i;
        largest_couple = std::max(largest_couple, std::abs(couple[c][i]));
      }
  EXPECT_GT(largest_couple, 0.0);
}

// Small bodies are gone through touch by touch, large ones grain by grain: each grain gets the same sum, to the last bit.
TEST(ForceSum, OfTouchesGoesByTheirNumbersInSmallBodiesAndInLarge)
{
  ASSERT_TRUE(stays_on_this_thread(400) && stays_on_this_thread(343));
  expect_touches_by_their_numbers<2>(20);
  expect_touches_by_their_numbers<3>(7);
  ASSERT_FALSE(stays_on_this_thread(10000));
  expect_touches_by_their_numbers<2>(100);
  expect_touches_by_their_numbers<3>(22);
}
} // namespace
} // namespace feldspar
