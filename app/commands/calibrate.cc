#include "app/calibration/calibration_run.h"
#include "app/calibration/input_check.h"
#include "app/commands/commands.h"
#include "app/run/run.h"

namespace feldspar
{
int run_calibrate(const CommonOptions& options)
{
  const RunCommand command{"calibrate", calibration::check_input, [](const Run& run) {
                             return run.input.specimen.dimension == 2 ? calibration::calibrate<2>(run)
                                                                      : calibration::calibrate<3>(run);
                           }};
  return run_command(command, options);
}
} // namespace feldspar
