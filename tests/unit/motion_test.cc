// The longest way that a body has gone in a step: of all bodies, whoever moves them.

#include "dem/dynamics/sweeps/motion.h"

#include "base/parallel.h"
#include "dem/dynamics/dynamics.h"
#include "tests/unit/small_specimen.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace feldspar
{
namespace
{
template <int dim>
void expect_the_longest_way_of(const std::size_t fastest, const bool is_held)
{
  const std::size_t n = block_size + 11; // more than a block, and no pack's multiple
  Components<dim> positions;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t c = 0; c < dim; ++c)
      positions[c].push_back(c == 0 ? 3e-3 * double(i) : 0.0);
  auto body = placed_specimen<dim>(std::vector<double>(n, 1e-3), positions);
  auto& grains = body.grains;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t c = 0; c < dim; ++c)
      {
        grains.velocity[c][i] = i == fastest ? -2.0 : std::sin(double(i + c));
        grains.force[c][i] = i == fastest ? 0.0 : 1e-3 * std::cos(double(i));
      }
  LargeVector<double> freedom(n, 1.0), damping_work(n, 0.0);
  freedom[fastest] = is_held ? 0.0 : 1.0;
  const double way = move_bodies<dim>(grains, {0, std::uint32_t(n)}, InverseInertia(grains),
                                      {1e-6, 1e-6, 0.7, Vector<dim>::Zero()}, freedom, damping_work);

  double expected = 0.0;
  for (std::size_t i = 0; i < n; ++i)
    {
      double squared = 0.0;
      for (std::size_t c = 0; c < dim; ++c)
        squared += std::pow(grains.position[c][i] - positions[c][i], 2);
      expected = std::max(expected, std::sqrt(squared));
    }
  EXPECT_NEAR(expected, 2e-6 * std::sqrt(double(dim)), 1e-14);
  EXPECT_NEAR(way, expected, 1e-14); // positions round
}

TEST(Motion, TellsTheLongestWayWhereverItsBodyStands)
{
  for (const std::size_t fastest : {std::size_t(0), std::size_t(5), block_size, block_size + 10})
    for (const bool is_held : {false, true})
      {
        expect_the_longest_way_of<2>(fastest, is_held);
        expect_the_longest_way_of<3>(fastest, is_held);
      }
}

// Grains at rest in a cell that shrinks: only an image moves.
TEST(Motion, OfAnImageWithItsCellIsSeen)
{
  const double radius = 1e-3;
  auto body = placed_specimen<2>({radius}, {{{0.5 * radius}, {0.5 * radius}}});
  body.shape = BodyShape::periodic;
  body.size = {2.05 * radius, 10.0 * radius};
  Dynamics<2> dynamics(std::move(body), {0.0, 0.2}, ZeroForce::at_touch);
  Tensor<2> rate = Tensor<2>::Zero();
  rate(0, 0) = -1e3;
  dynamics.deform_cell(rate);
  for (int n = 0; n < 10000 && dynamics.faceless_coordination_number() == 0.0; ++n)
    dynamics.step();
  EXPECT_GT(dynamics.faceless_coordination_number(), 0.0);
}
} // namespace
} // namespace feldspar
