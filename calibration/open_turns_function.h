#pragma once

#include <openturns/EvaluationImplementation.hxx>
#include <openturns/Function.hxx>

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

/// Conversion between our types and those of OpenTURNS. For the sources of this room alone: its headers are long.
namespace feldspar::calibration
{
inline OT::Point as_point(const std::vector<double>& values)
{
  OT::Point point(values.size());
  std::copy(values.begin(), values.end(), point.begin());
  return point;
}

/// A function of ours as OpenTURNS calls it.
class OpenTurnsFunction : public OT::EvaluationImplementation
{
public:
  OpenTurnsFunction(std::function<double(const std::vector<double>&)> function, const std::size_t n)
    : f(std::move(function))
    , dimension(n)
  {
  }

  OpenTurnsFunction* clone() const override { return new OpenTurnsFunction(*this); } // owned by its smart pointer

  using OT::EvaluationImplementation::operator();

  OT::Point operator()(const OT::Point& point) const override
  {
    return OT::Point(1, f(std::vector<double>(point.begin(), point.end())));
  }

  OT::UnsignedInteger getInputDimension() const override { return dimension; }
  OT::UnsignedInteger getOutputDimension() const override { return 1; }

private:
  std::function<double(const std::vector<double>&)> f;
  std::size_t dimension;
};
} // namespace feldspar::calibration
