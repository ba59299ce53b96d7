#include "report/csv_tables.h"

#include "report/text_file.h"

#include <fmt/format.h>

#include <iterator>

namespace feldspar
{
void write_curve(const FinishedTest& test, const std::filesystem::path& file)
{
  std::string text =
    "step,time_s,axial_strain,axial_stress_Pa,end_stress_difference_Pa,lateral_stress_Pa,mid_stress_Pa,"
    "gauge_axial_strain,gauge_lateral_strain,gauge_volumetric_strain,n_tension_cracks,n_shear_cracks,"
    "unbalanced_force_ratio,boundary_work_J,kinetic_energy_J,strain_energy_J,slip_energy_J,"
    "released_energy_J,damping_energy_J,kinetic_energy_at_start_J\n";
  const double sign = laboratory_sign(test.record.kind); // lab curves: positive in the sense of the test
  for (const auto& row : test.record.curve)
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", row.step,
                   row.time, sign * row.axial_strain, sign * row.axial_stress, sign * row.end_stress_difference,
                   sign * row.lateral_stress, sign * row.mid_stress, sign * row.gauge_axial_strain,
                   sign * row.gauge_lateral_strain, sign * row.gauge_volumetric_strain, row.n_tension_cracks,
                   row.n_shear_cracks, row.unbalanced_force_ratio, row.energies.boundary_work, row.energies.kinetic,
                   row.energies.strain, row.energies.slip, row.energies.released, row.energies.damping,
                   row.energies.kinetic_at_start);
  write_text_file(file, text);
}

void write_cracks(const std::vector<FinishedTest>& tests, const std::filesystem::path& file)
{
  std::string text =
    "test,kind,joint,segment,step,axial_strain,x_m,y_m,z_m,normal_x,normal_y,normal_z,size_m,released_energy_J\n";
  for (const auto& test : tests)
    for (const auto& crack : test.record.cracks)
      fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", test.name,
                     crack.kind == CrackKind::tension ? "tension" : "shear", crack.joint, crack.segment, crack.step,
                     laboratory_sign(test.record.kind) * crack.axial_strain, crack.centroid[0], crack.centroid[1],
                     crack.centroid[2], crack.normal[0], crack.normal[1], crack.normal[2], crack.size,
                     crack.released_energy);
  write_text_file(file, text);
}
} // namespace feldspar
