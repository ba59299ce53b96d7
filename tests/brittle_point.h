#pragma once

#include "fem/materials/linear_elasticity.h"

namespace feldspar::fem
{
/// Breaks for good where the strain along y passes a limit, and then carries a share of the stress. With ν = 0 a sample of it is
/// springs in rows.
class BrittlePoint : public MaterialPoint<2>
{
public:
  BrittlePoint(const StiffnessMatrix<2>& its_stiffness, const double its_limit, const double its_share)
    : stiffness(its_stiffness)
    , limit(its_limit)
    , share(its_share)
  {
  }

  MaterialResponse<2> trial(const StrainVector<2>& strain) const override
  {
    const StiffnessMatrix<2> now = (broken ? share : 1.0) * stiffness;
    return {now * strain, now};
  }
  std::size_t relax(const StrainVector<2>& strain) override
  {
    if (broken || strain[1] <= limit)
      return 0;
    broken = true;
    return 1;
  }
  void accept(const StrainVector<2>&) override { accepted = broken; }
  void reject() override { broken = accepted; }
  std::string stored() const override { return accepted ? "broken" : "whole"; }
  void restore(const std::string& stored) override { accepted = broken = stored == "broken"; }
  std::vector<double> fields() const override { return {accepted ? 1.0 : 0.0}; }

private:
  StiffnessMatrix<2> stiffness;
  double limit;
  double share;
  bool broken = false;
  bool accepted = false;
};
} // namespace feldspar::fem
