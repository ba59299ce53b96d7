#pragma once

#include "app/calibration/problem.h"
#include "calibration/response_model.h"

#include <cstddef>
#include <string>

/// Sentences on how well the packings of an answer can tell its means, said before they are tested.
namespace feldspar::calibration
{
/// Precision of compressive strengths, by the scatter that specimens of so many grains usually have.
std::string usual_precision(const CalibrationParameters& wanted, unsigned int dimension, std::size_t n_grains);

/// Precision of each target, by the scatter of the design's packings, which the model has learnt.
std::string precision_by_design(const CalibrationParameters& wanted, const Problem& problem,
                                const ResponseModel& model);
} // namespace feldspar::calibration
