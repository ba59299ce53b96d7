#pragma once

#include "report/chart/chart.h"
#include "results/runs/run.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

/// The way from the mesh of a sample to the plane of a picture [m].
namespace feldspar
{
using PlanePoint = std::array<double, 2>;

/// A cell of the picture's plane, or the polygon that the plane cuts out of one: its corners around.
struct SamplePiece
{
  std::size_t cell;
  std::vector<PlanePoint> rest;
  std::vector<PlanePoint> moved; ///< displacements drawn larger
};

/// A sample in the plane as it is, a half section in r and z with its mirror image, a body in space cut through its axis.
/// The fields outlive it.
class SampleView
{
public:
  /// Displacements are drawn `scale` times larger.
  SampleView(const SampleFields& fields, double scale);

  std::vector<SamplePiece> pieces() const;

  /// Place at which an RVE is drawn: displaced with its cell.
  PlanePoint place(const PointRve& rve) const;

private:
  PlanePoint in_picture(const std::array<double, 3>& at) const;
  std::array<double, 3> moved(std::uint32_t node) const;
  SamplePiece flat(std::size_t cell) const;
  SamplePiece section(std::size_t cell) const; ///< where the plane meets the edges of a hexahedron

  const SampleFields& fields;
  double scale;
  double cut = 0.0; ///< y of the section of a body in space
};

/// Edges of the pieces for which `inside` holds [mm], a gap after each, unless pieces on both sides are inside.
std::vector<ChartPoint> outline(const std::vector<SamplePiece>& pieces,
                                const std::vector<PlanePoint> SamplePiece::*drawn,
                                const std::function<bool(const SamplePiece&)>& inside);

PlanePoint middle_of(const std::vector<PlanePoint>& corners);
double area_of(const std::vector<PlanePoint>& corners);

/// A round number by which displacements can be multiplied to be seen: at most 6 % of the height.
double visible_scale(const SampleFields& fields);

/// The cells of a sample in the plane of its picture, at rest and at each time displaced `scale` times, with every field of
/// them and the places of the RVEs: JSON for the page (report/page/sample.js). Empty of more than 20 000 cells.
std::string sample_data(const FinishedTest& test, const SampleView& view, const std::vector<SamplePiece>& pieces,
                        double scale);
} // namespace feldspar
