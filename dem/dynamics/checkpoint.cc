// The whole state of a body in motion, into a checkpoint and out of it.

#include "base/system/hdf5_archive.h"
#include "dem/dynamics/dynamics.h"

#include <cstdint>
#include <string>

namespace feldspar
{
template <int dim>
template <typename Archive>
void Dynamics<dim>::transfer(Archive& archive)
{
  auto& grains = body.grains;
  const auto all_of = [&](const std::string& name, auto& components) {
    for (std::size_t c = 0; c < components.size(); ++c)
      archive.array(name + "_" + "xyz"[c], components[c]);
  };
  all_of("position", grains.position);
  all_of("velocity", grains.velocity);
  all_of("spin", grains.spin);
  all_of("force", grains.force);
  all_of("couple", grains.couple);
  all_of("applied_force", applied_force);
  images.transfer(archive, grains);
  groups.transfer(archive);

  auto& joints = body.joints;
  archive.array("grain_1", joints.grain_1);
  archive.array("grain_2", joints.grain_2);
  archive.array("number", joints.number);
  if constexpr (Archive::reads)
    joints.resize_all(joints.grain_1.size());
  const auto pass = [&](const std::string& name, auto& values) { transfer_numbers(archive, name, values); };
  joints.visit_per_joint(pass);
  joints.visit_per_segment(pass);
  if (!body.minerals.empty())
    pass("further_friction", joints.further_friction);
  const auto pass_all = [&](const std::string& name, auto& components) {
    for (std::size_t c = 0; c < components.size(); ++c)
      pass(name + "_" + "xyz"[c], components[c]);
  };
  pass_all("joint_force", joints.force);
  pass_all("joint_couple_1", joints.couple_1);
  pass_all("joint_couple_2", joints.couple_2);

  archive.bytes("smooth_joints", body.smooth_joints);
  touches.transfer(archive);
  wall_set.transfer(archive);
  watch.transfer(archive);
  ledger.transfer(archive);

  std::uint32_t flags = std::uint32_t(started) + 2 * std::uint32_t(contact_made) +
                        4 * std::uint32_t(zero_force == ZeroForce::as_placed) + 8 * std::uint32_t(faces_have_gone);
  archive.value("flags", flags);
  started = flags & 1;
  contact_made = flags & 2;
  faces_have_gone = flags & 8;
  zero_force = flags & 4 ? ZeroForce::as_placed : ZeroForce::at_touch;
  archive.value("steps", steps);
  archive.value("dt", dt);
  archive.value("previous_dt", previous_dt);
  archive.value("current_time", current_time);
  joint_groups = JointGroups<dim>(joints); // writing too, so that a resumed run regroups when this one does
  if constexpr (Archive::reads)
    {
      index_joints();
      inverse_inertia = InverseInertia(bodies());
    }
  touches.number(images);
}

template void Dynamics<2>::transfer(Hdf5Writer&);
template void Dynamics<2>::transfer(Hdf5Reader&);
template void Dynamics<3>::transfer(Hdf5Writer&);
template void Dynamics<3>::transfer(Hdf5Reader&);
} // namespace feldspar
