#pragma once

namespace feldspar
{
/// The sample of a multiscale run: a mesh, and how its points get their volumes.
struct SampleParameters
{
  double width = 0.050;  ///< [m]
  double height = 0.100; ///< along the axis of the test [m]
  unsigned int elements_across = 2;
  unsigned int elements_along = 4;
  unsigned int order = 1;
  bool rough_platens = false;
  unsigned int n_realisations = 4;       ///< volumes packed, dealt to the points
  bool random_orientation = true;        ///< each turned by an angle of its own
  double compression_step = 4e-5;        ///< axial strain between two rows of the curve
  double tension_step = 2e-6;            ///< the same
  double most_broken_share = 0.01;       ///< of all segments in one step; beyond it the step is cut
  double smallest_step_share = 1.0 / 16; ///< of a step, before there is said to be no equilibrium
  double newton_tolerance = 1e-5;        ///< unbalanced over internal force
};
} // namespace feldspar
