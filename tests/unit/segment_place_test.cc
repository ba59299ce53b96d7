#include "dem/storage/segment_place.h"

#include <gtest/gtest.h>

#include <numbers>

namespace feldspar
{
namespace
{
constexpr double radius = 2e-3;

TEST(SegmentPlace, InThePlaneSegmentsCoverTheFaceOnBothSidesOfItsMiddle)
{
  // n points along y, so that t = (-1, 0); segments go from +R̄ to -R̄ along t, a quarter of the face each.
  Tensor<2> axes;
  axes << 0.0, 1.0, -1.0, 0.0;
  const Vector<2> centre(0.01, 0.02);
  const auto elements = face_elements<2>(4u);
  for (std::size_t i = 0; i < 4; ++i)
    {
      const auto place = segment_place<2>(centre, 3e-3, axes, radius, elements[i]);
      EXPECT_NEAR(place.centroid[0], 0.01 - radius * (0.75 - 0.5 * double(i)), 1e-15);
      EXPECT_NEAR(place.centroid[1], 0.023, 1e-15);
      EXPECT_EQ(place.normal, Vector<2>(0.0, 1.0));
      EXPECT_NEAR(place.size, 0.5 * radius, 1e-15);
    }
}

TEST(SegmentPlace, InSpaceElementsCoverTheDiscAboutItsMiddle)
{
  Tensor<3> axes;
  axes << 0.0, 0.6, 0.8, 1.0, 0.0, 0.0, 0.0, 0.8, -0.6;
  const Vector<3> centre(0.01, 0.02, 0.03);
  const Vector<3> middle = centre + 3e-3 * axes.row(0).transpose();
  double area = 0.0;
  Vector<3> moment = Vector<3>::Zero();
  for (const auto& element : face_elements<3>(2u, 6u))
    {
      const auto place = segment_place<3>(centre, 3e-3, axes, radius, element);
      EXPECT_NEAR((place.centroid - middle).dot(place.normal), 0.0, 1e-17);
      EXPECT_LT((place.centroid - middle).norm(), radius);
      area += place.size * place.size;
      moment += place.size * place.size * (place.centroid - middle);
    }
  EXPECT_NEAR(area, std::numbers::pi * radius * radius, 1e-12 * radius * radius);
  EXPECT_LT(moment.norm(), 1e-12 * radius * radius * radius);
}

TEST(SegmentPlace, OfAJointIsThatOfItsFace)
{
  // Grains of 1 mm and 2 mm whose centres are 3.2 mm apart: the middle of the gap lies 1.1 mm from the first.
  Grains<2> grains;
  grains.place({1e-3, 2e-3}, {{{0.0, 3.2e-3}, {0.0, 0.0}}});
  Joints<2> joints;
  joints.divide({2}, 0);
  joints.resize_all(1);
  joints.grain_1[0] = 0;
  joints.grain_2[0] = 1;
  joints.normal[0][0] = 1.0;
  joints.half_length[0] = 1e-3;
  joints.half_radius_difference[0] = -0.5e-3;
  joints.rest_distance[0] = 3e-3;
  joints.opening[0] = 0.2e-3;
  const auto place = segment_place<2>(grains, joints, 0, 0);
  EXPECT_NEAR(place.centroid[0], 1.1e-3, 1e-17);
  EXPECT_NEAR(place.centroid[1], 0.5e-3, 1e-17);
  EXPECT_EQ(place.size, 1e-3);
}
} // namespace
} // namespace feldspar
