#pragma once

#include "fem/materials/material.h"

#include <array>
#include <memory>
#include <utility>

namespace feldspar::fem
{
/// A material in space as one in the plane, where nothing strains across. x and y of the plane are x and z of the
/// material, as in kinematics.h.
class PlaneStrainPoint final : public MaterialPoint<2>
{
public:
  explicit PlaneStrainPoint(std::unique_ptr<MaterialPoint<3>> point)
    : in_space(std::move(point))
  {
  }

  MaterialAnswer<2> trial(const StrainVector<2>& strain) const override
  {
    const MaterialAnswer<3> answer = in_space->trial(spread(strain));
    MaterialAnswer<2> result;
    for (int i = 0; i < 3; ++i)
      {
        result.stress[i] = answer.stress[place[i]];
        for (int j = 0; j < 3; ++j)
          result.tangent(i, j) = answer.tangent(place[i], place[j]);
      }
    return result;
  }
  std::size_t relax(const StrainVector<2>& strain) override { return in_space->relax(spread(strain)); }
  void accept(const StrainVector<2>& strain) override { in_space->accept(spread(strain)); }
  void reject() override { in_space->reject(); }
  std::string stored() const override { return in_space->stored(); }
  void restore(const std::string& stored) override { in_space->restore(stored); }
  std::vector<double> fields() const override { return in_space->fields(); }

private:
  static constexpr std::array place{0, 2, 4}; // xx, zz, xz of xx, yy, zz, yz, xz, xy

  static StrainVector<3> spread(const StrainVector<2>& strain)
  {
    StrainVector<3> result = StrainVector<3>::Zero();
    for (int i = 0; i < 3; ++i)
      result[place[i]] = strain[i];
    return result;
  }

  std::unique_ptr<MaterialPoint<3>> in_space;
};

inline Material<2> plane_strain(const Material<3>& in_space)
{
  return {[make = in_space.make_point](const PointPlace& at) { return std::make_unique<PlaneStrainPoint>(make(at)); },
          in_space.field_names};
}
} // namespace feldspar::fem
