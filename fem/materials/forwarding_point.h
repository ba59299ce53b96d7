#pragma once

#include "fem/materials/material.h"

#include <any>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace feldspar::fem
{
/// A wrapped point that sees the same axes as its wrapper.
template <int dim>
struct SameAxes
{
  static constexpr int inner_dim = dim;
  static const StrainVector<dim>& strain_within(const StrainVector<dim>& strain) { return strain; }
  static const StressVector<dim>& stress_without(const StressVector<dim>& stress) { return stress; }
  static const StiffnessMatrix<dim>& tangent_without(const StiffnessMatrix<dim>& tangent) { return tangent; }
  static const Eigen::Matrix<double, dim, 1>& direction_without(const Eigen::Matrix<double, dim, 1>& direction)
  {
    return direction;
  }
};

/// A point that wraps another one. Every call of the seam goes through to it, so that a wrapper overrides what it changes
/// and nothing else. Axes: how strains go in, and stresses, tangents and directions come out.
template <int dim, typename Axes = SameAxes<dim>>
class ForwardingPoint : public MaterialPoint<dim>
{
public:
  using Inner = MaterialPoint<Axes::inner_dim>;

  explicit ForwardingPoint(std::unique_ptr<Inner> wrapped)
    : inner(std::move(wrapped))
  {
  }

  MaterialResponse<dim> trial(const StrainVector<dim>& strain) const override
  {
    const auto response = inner->trial(Axes::strain_within(strain));
    return {Axes::stress_without(response.stress), Axes::tangent_without(response.tangent)};
  }
  std::size_t relax(const StrainVector<dim>& strain) override { return inner->relax(Axes::strain_within(strain)); }
  PointEvents<dim> relax_once(const StrainVector<dim>& strain) override
  {
    const auto events = inner->relax_once(Axes::strain_within(strain));
    return {events.n, Axes::stress_without(events.stress)};
  }
  void accept(const StrainVector<dim>& strain) override { inner->accept(Axes::strain_within(strain)); }
  void reject() override { inner->reject(); }
  std::string stored() const override { return inner->stored(); }
  void restore(const std::string& stored) override { inner->restore(stored); }
  std::vector<double> fields() const override { return inner->fields(); }
  std::optional<PointEnergies> energies() const override { return inner->energies(); }
  std::vector<PointCrack<dim>> cracks_of_last_step() const override
  {
    std::vector<PointCrack<dim>> cracks;
    for (const auto& crack : inner->cracks_of_last_step())
      cracks.push_back({crack.in_tension, crack.segment, Axes::direction_without(crack.normal), crack.size,
                        crack.released_energy, crack.released_density});
    return cracks;
  }
  bool is_damaged() const override { return inner->is_damaged(); }
  std::any structure() const override { return inner->structure(); }

protected:
  std::unique_ptr<Inner> inner;
};
} // namespace feldspar::fem
