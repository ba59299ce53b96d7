#include "base/byte_archive.h"
#include "base/system/hdf5_archive.h"
#include "base/whole_file.h"
#include "dem/lab/laboratory_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

/// The state of a running test in a file.
namespace feldspar
{
template <int dim>
template <typename Archive>
void LabTest<dim>::transfer(Archive& archive)
{
  auto dynamics = archive.subgroup("dynamics");
  set_up.dynamics.transfer(dynamics);
  auto emitted = archive.subgroup("emission");
  emission.transfer(emitted);
  archive.array("curve", record.curve);
  archive.array("cracks", record.cracks);
  transfer_components(archive, "gauge_position", gauge_positions);
  archive.value("wall_time", wall_time);
  archive.value("time_at_start", time_at_start);
  archive.value("time_of_last_row", time_of_last_row);
  archive.value("lateral_stress_over_time", lateral_stress_over_time);
  archive.value("n_tension", n_tension);
  archive.value("n_shear", n_shear);
  if (set_up.loading.drive_stage)
    stage_walk.transfer(archive);
  if (set_up.loading.shortening)
    archive.value("shortening_at_start", shortening_at_start);
  if (set_up.loading.opening)
    archive.value("opening_at_start", opening_at_start);
  transfer_flag(archive, "ended", ended);
  archive.array("n_broken_segments", n_broken_segments);
  archive.value("rows_between_snapshots", rows_between_snapshots);
  std::uint64_t n_snapshots = snapshots.size();
  archive.value("n_snapshots", n_snapshots);
  snapshots.resize(n_snapshots);
  for (std::size_t k = 0; k < n_snapshots; ++k)
    {
      Snapshot& snapshot = snapshots[k];
      auto group = archive.subgroup(fmt::format("snapshot_{}", k));
      group.value("step", snapshot.step);
      group.value("axial_strain", snapshot.axial_strain);
      group.value("axial_stress", snapshot.axial_stress);
      for (int c = 0; c < dim; ++c)
        group.array(fmt::format("position_{}", "xyz"[c]), snapshot.position[c]);
      for (std::size_t c = 0; c < snapshot.stress.size(); ++c)
        group.array(fmt::format("stress_{}", c), snapshot.stress[c]);
      for (std::size_t c = 0; c < snapshot.mineral_strain.size() && !record.minerals.empty(); ++c)
        group.array(fmt::format("mineral_strain_{}", c), snapshot.mineral_strain[c]);
      group.array("fragment", snapshot.fragment);
      group.array("n_broken_segments", snapshot.n_broken_segments);
    }
}

namespace
{
const std::string checkpoint_format = "feldspar checkpoint";

/// The values that must agree before the rest is read.
template <typename Archive>
void transfer_identity(Archive& archive, const std::string& identity)
{
  std::string format = checkpoint_format;
  std::string whose = identity;
  archive.text("format", format);
  archive.text("identity", whose);
  if (format != checkpoint_format)
    throw InputError("another kind of file");
  if (whose != identity)
    throw InputError("of another test, input or version of this program");
}
} // namespace

template <int dim>
void LabTest<dim>::write_checkpoint(const std::filesystem::path& file, const std::string& identity)
{
  auto& dynamics = set_up.dynamics;
  const BodyShare<dim>& share = dynamics.sharing();
  dynamics.know_all();
  if (share.is_first())
    try
      {
        write_hdf5(file, [&](Hdf5Writer& archive) {
          transfer_identity(archive, identity);
          transfer(archive);
        });
      }
    catch (...)
      {
        share.any(true);
        throw;
      }
  else
    {
      NothingWriter nothing;
      dynamics.transfer(nothing);
    }
  if (share.any(false))
    throw OutputError("the first process could not write the body");
}

template <int dim>
void LabTest<dim>::read_checkpoint(const std::filesystem::path& file, const std::string& identity)
{
  read_hdf5(file, "a checkpoint of this test", [&](Hdf5Reader& archive) {
    transfer_identity(archive, identity);
    transfer(archive);
  });
  if (!set_up.dynamics.sharing().is_first())
    std::ranges::fill(snapshots, Snapshot());
  start_gauge();
  for (const CurveSample& row : record.curve)
    {
      energy_watch.has_grown_without_work(row.energies);
      stop_rule.add(row);
    }
  seated = true;
}

template void LabTest<2>::write_checkpoint(const std::filesystem::path&, const std::string&);
template void LabTest<3>::write_checkpoint(const std::filesystem::path&, const std::string&);
template void LabTest<2>::read_checkpoint(const std::filesystem::path&, const std::string&);
template void LabTest<3>::read_checkpoint(const std::filesystem::path&, const std::string&);
} // namespace feldspar
