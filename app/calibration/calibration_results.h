#pragma once

#include "app/input/input.h"
#include "app/run/run.h"
#include "calibration/calibration_file.h"
#include "results/runs/run.h"

#include <vector>

namespace feldspar::calibration
{
/// The files of a calibration and its words on the screen: the input found, the statistics of the calibration, and the
/// result folder with report of the tests of its answer, if there are any.
void finish(const Run& run, const ResponseModel& model, const CalibrationOutcome& outcome,
            const std::vector<TestedPoint>& tested, const Input& best_input,
            const std::vector<FinishedTest>& finished_tests);
} // namespace feldspar::calibration
