#pragma once

#include "laboratory/appearance.h"
#include "laboratory/column.h"
#include "laboratory/record.h"
#include "results/emission.h"

#include <array>
#include <string_view>

namespace feldspar
{
/// The columns of cracks.csv but for the name of the test and the kind.
inline constexpr Column<Crack> crack_columns[] = {
  column<Crack, &Crack::joint>("joint"),
  column<Crack, &Crack::segment>("segment"),
  column<Crack, &Crack::step>("step"),
  column<Crack, &Crack::axial_strain>("axial_strain", "", positive_in_test),
  column<Crack, &Crack::centroid, 0>("x_m"),
  column<Crack, &Crack::centroid, 1>("y_m"),
  column<Crack, &Crack::centroid, 2>("z_m"),
  column<Crack, &Crack::normal, 0>("normal_x"),
  column<Crack, &Crack::normal, 1>("normal_y"),
  column<Crack, &Crack::normal, 2>("normal_z"),
  column<Crack, &Crack::size>("size_m"),
  column<Crack, &Crack::released_energy>("released_energy_J"),
  column<Crack, &Crack::on_smooth_joint>("on_smooth_joint", "", added_later),
  column<Crack, &Crack::event>("event", "", added_later),
  column<Crack, &Crack::mineral_1>("mineral_1", "", added_later),
  column<Crack, &Crack::mineral_2>("mineral_2", "", added_later),
  column<Crack, &Crack::on_boundary>("on_boundary", "", added_later)};

/// A row of emission.csv: an event and what follows from it.
struct EmissionRow
{
  EmissionEvent event;
  std::uint64_t n_breaks;
  SourceMechanism source;
  double energy_magnitude;
};

inline EmissionRow emission_row(const EmissionEvent& event, const int dimension)
{
  return {event, event.n_breaks(), mechanism(event, dimension), energy_magnitude(event.released_energy)};
}

/// The columns of emission.csv but for the name of the test and the kind.
inline constexpr Column<EmissionRow> emission_columns[] = {
  column<EmissionRow, &EmissionRow::event, &EmissionEvent::number>("event"),
  column<EmissionRow, &EmissionRow::event, &EmissionEvent::step>("step"),
  column<EmissionRow, &EmissionRow::event, &EmissionEvent::axial_strain>("axial_strain", "", positive_in_test),
  column<EmissionRow, &EmissionRow::event, &EmissionEvent::centroid, 0>("x_m"),
  column<EmissionRow, &EmissionRow::event, &EmissionEvent::centroid, 1>("y_m"),
  column<EmissionRow, &EmissionRow::event, &EmissionEvent::centroid, 2>("z_m"),
  column<EmissionRow, &EmissionRow::n_breaks>("n_breaks"),
  column<EmissionRow, &EmissionRow::event, &EmissionEvent::released_energy>("energy_J"),
  column<EmissionRow, &EmissionRow::source, &SourceMechanism::scalar_moment>("moment_Nm"),
  column<EmissionRow, &EmissionRow::source, &SourceMechanism::magnitude>("magnitude", "", perhaps_nan),
  column<EmissionRow, &EmissionRow::source, &SourceMechanism::isotropic>("isotropic_share"),
  column<EmissionRow, &EmissionRow::source, &SourceMechanism::double_couple>("double_couple_share"),
  column<EmissionRow, &EmissionRow::source, &SourceMechanism::clvd>("clvd_share"),
  column<EmissionRow, &EmissionRow::event, &EmissionEvent::time>("time_s", "", perhaps_nan),
  column<EmissionRow, &EmissionRow::event, &EmissionEvent::extent>("extent_m"),
  column<EmissionRow, &EmissionRow::event, &EmissionEvent::n_tension>("n_tension"),
  column<EmissionRow, &EmissionRow::event, &EmissionEvent::n_shear>("n_shear"),
  column<EmissionRow, &EmissionRow::energy_magnitude>("energy_magnitude", "", perhaps_nan),
  column<EmissionRow, &EmissionRow::event, &EmissionEvent::moment, 0>("moment_xx_Nm"),
  column<EmissionRow, &EmissionRow::event, &EmissionEvent::moment, 1>("moment_xy_Nm"),
  column<EmissionRow, &EmissionRow::event, &EmissionEvent::moment, 2>("moment_xz_Nm"),
  column<EmissionRow, &EmissionRow::event, &EmissionEvent::moment, 3>("moment_yy_Nm"),
  column<EmissionRow, &EmissionRow::event, &EmissionEvent::moment, 4>("moment_yz_Nm"),
  column<EmissionRow, &EmissionRow::event, &EmissionEvent::moment, 5>("moment_zz_Nm")};

/// The columns of grains/NAME.csv. `group`: the name of the column of the groups, which outlives the columns.
inline std::array<Column<GrainPicture>, 11> grain_columns(const std::string_view group)
{
  return {column<GrainPicture, &GrainPicture::start, 0>("start_x_m"),
          column<GrainPicture, &GrainPicture::start, 1>("start_y_m"),
          column<GrainPicture, &GrainPicture::start, 2>("start_z_m"),
          column<GrainPicture, &GrainPicture::position, 0>("x_m"),
          column<GrainPicture, &GrainPicture::position, 1>("y_m"),
          column<GrainPicture, &GrainPicture::position, 2>("z_m"),
          column<GrainPicture, &GrainPicture::radius>("radius_m"),
          column<GrainPicture, &GrainPicture::fragment>("fragment"),
          column<GrainPicture, &GrainPicture::group>(group, "", added_later),
          column<GrainPicture, &GrainPicture::mean_stress>("mean_stress_Pa", "", added_later),
          column<GrainPicture, &GrainPicture::mineral>("mineral", "", added_later)};
}
} // namespace feldspar
