#pragma once

namespace feldspar
{
/// The splitting of a disc.
struct BrazilianParameters
{
  double strain_rate = 0.164; ///< of the diameter, magnitude [1/s]
  double sampling_strain = 2e-6;
  double length_ratio = 0.5; ///< length of the disc, or half disc, over its diameter, in space
};
} // namespace feldspar
