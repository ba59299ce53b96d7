#pragma once

#include "laboratory/appearance.h"
#include "laboratory/column.h"
#include "laboratory/record.h"

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
  column<Crack, &Crack::event>("event", "", added_later)};

/// The columns of emission.csv but for the name of the test and what follows from the others.
inline constexpr Column<EmissionEvent> event_columns[] = {
  column<EmissionEvent, &EmissionEvent::number>("event"),
  column<EmissionEvent, &EmissionEvent::time>("time_s"),
  column<EmissionEvent, &EmissionEvent::axial_strain>("axial_strain", "", positive_in_test),
  column<EmissionEvent, &EmissionEvent::n_tension>("n_tension"),
  column<EmissionEvent, &EmissionEvent::n_shear>("n_shear"),
  column<EmissionEvent, &EmissionEvent::released_energy>("released_energy_J"),
  column<EmissionEvent, &EmissionEvent::centroid, 0>("x_m"),
  column<EmissionEvent, &EmissionEvent::centroid, 1>("y_m"),
  column<EmissionEvent, &EmissionEvent::centroid, 2>("z_m"),
  column<EmissionEvent, &EmissionEvent::extent>("extent_m"),
  column<EmissionEvent, &EmissionEvent::moment, 0>("moment_xx_N_m"),
  column<EmissionEvent, &EmissionEvent::moment, 1>("moment_xy_N_m"),
  column<EmissionEvent, &EmissionEvent::moment, 2>("moment_xz_N_m"),
  column<EmissionEvent, &EmissionEvent::moment, 3>("moment_yy_N_m"),
  column<EmissionEvent, &EmissionEvent::moment, 4>("moment_yz_N_m"),
  column<EmissionEvent, &EmissionEvent::moment, 5>("moment_zz_N_m")};

/// The columns of grains/NAME.csv. `group`: the name of the column of the groups, which outlives the columns.
inline std::array<Column<GrainPicture>, 10> grain_columns(const std::string_view group)
{
  return {column<GrainPicture, &GrainPicture::start, 0>("start_x_m"),
          column<GrainPicture, &GrainPicture::start, 1>("start_y_m"),
          column<GrainPicture, &GrainPicture::start, 2>("start_z_m"),
          column<GrainPicture, &GrainPicture::position, 0>("x_m"),
          column<GrainPicture, &GrainPicture::position, 1>("y_m"),
          column<GrainPicture, &GrainPicture::position, 2>("z_m"),
          column<GrainPicture, &GrainPicture::radius>("radius_m"),
          column<GrainPicture, &GrainPicture::fragment>("fragment"),
          column<GrainPicture, &GrainPicture::mineral>(group, "", added_later),
          column<GrainPicture, &GrainPicture::mean_stress>("mean_stress_Pa", "", added_later)};
}
} // namespace feldspar
