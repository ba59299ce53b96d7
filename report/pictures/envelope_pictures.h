#pragma once

#include "report/pictures/gnuplot.h"
#include "results/fits/strength_envelopes.h"
#include "results/folder/reference.h"
#include "results/runs/series.h"

#include <optional>
#include <vector>

namespace feldspar
{
/// Strengths in the plane of sigma_3 and sigma_1: points of every series with their standard deviations, the envelopes
/// of a series, the reference. Compression positive.
///
/// Two pictures, the whole range and the part near the uniaxial test.
std::vector<Picture> envelope_pictures(const std::vector<Series>& all, std::size_t which,
                                       const StrengthEnvelopes& envelopes, const std::optional<Reference>& reference);

/// All series in one, each with the envelope of intact rock. Nothing where there is only one.
std::vector<Picture> combined_envelope_picture(const std::vector<Series>& all,
                                               const std::vector<StrengthEnvelopes>& envelopes,
                                               const std::optional<Reference>& reference);

/// The residual of each envelope of the series, which is this one of all, at each point.
std::vector<Picture> residual_picture(const Series& series, std::size_t which, const StrengthEnvelopes& envelopes);

/// Share of shear cracks at the peak against confinement.
std::vector<Picture> shear_share_picture(const std::vector<Series>& all);
} // namespace feldspar
