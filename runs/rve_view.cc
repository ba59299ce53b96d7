#include "runs/rve_view.h"

#include "dem/specimen/fragments.h"
#include "dem/specimen/mineral_sides.h"
#include "dem/storage/segment_place.h"

#include <utility>

namespace feldspar
{
template <int dim>
RveView as_seen(const Specimen<dim>& specimen, const SampleRve<dim>& rve, const TestRecord& of_sample)
{
  Specimen<dim> broken = specimen;
  Joints<dim>& joints = broken.joints;
  const std::size_t n_grains = specimen.grains.size();
  std::vector<std::uint32_t> n_broken(n_grains, 0);
  for (const auto& unbonded : rve.state.unbonded)
    if (const std::size_t joint = unbonded.segment / joints.n_segments; joint < joints.size())
      {
        joints.bonded[joints.segment(unbonded.segment % joints.n_segments, joint)] = 0.0;
        ++n_broken[joints.grain_1[joint]];
        ++n_broken[joints.grain_2[joint]];
      }
  const auto placed = [&](const Vector<dim>& position) -> Vector<dim> {
    return rve.position + rve.orientation * (position - 0.5 * specimen.size);
  };
  const Tensor<dim> strain = strain_tensor<dim>(rve.state.strain);
  const Unknowns unknowns = unknowns_of(*rve.network, rve.state);
  const auto moved = [&](const Vector<dim>& rest, const std::size_t grain) -> Vector<dim> {
    const Vector<dim> fluctuation = unknowns.segment<dim>(n_motions<dim> * Eigen::Index(grain));
    return rest + strain * (rest - 0.5 * specimen.size) + fluctuation;
  };

  const auto mineral_of = [&](const std::size_t i) {
    return specimen.mineral.empty()
             ? 0
             : number_of_mineral(of_sample.minerals, specimen.minerals[specimen.mineral[i]].name);
  };

  RveView seen;
  const auto fragment = fragments(joints, n_grains);
  for (const bool now : {false, true})
    {
      Snapshot snapshot;
      if (now)
        {
          snapshot.step = of_sample.curve.back().step;
          snapshot.axial_strain = of_sample.curve.back().axial_strain;
          snapshot.axial_stress = of_sample.curve.back().axial_stress;
        }
      for (std::size_t i = 0; i < n_grains; ++i)
        {
          const Vector<dim> rest = at<dim>(specimen.grains.position, i);
          const Vector<dim> position = placed(now ? moved(rest, i) : rest);
          for (std::size_t c = 0; c < dim; ++c)
            snapshot.position[c].push_back(position[Eigen::Index(c)]);
          if (now)
            seen.appearance.grains_at_end.push_back(
              {in_space<dim>(placed(rest)), in_space<dim>(position), specimen.grains.radius[i], fragment[i],
               specimen.groups.empty() ? 0 : specimen.groups[i] + 1, 0.0, mineral_of(i)});
        }
      snapshot.fragment = now ? fragment : std::vector<std::uint32_t>(n_grains, 0);
      snapshot.n_broken_segments = now ? n_broken : std::vector<std::uint32_t>(n_grains, 0);
      seen.appearance.snapshots.push_back(std::move(snapshot));
    }
  for (Crack crack : of_sample.cracks)
    if (crack.joint == rve.number)
      {
        const std::size_t joint = crack.segment / joints.n_segments;
        const std::size_t i = crack.segment % joints.n_segments;
        crack.centroid = in_space<dim>(placed(segment_place<dim>(specimen.grains, joints, joint, i).centroid));
        crack.joint = joint;
        crack.segment = std::uint32_t(i);
        seen.cracks.push_back(crack);
      }
  return seen;
}

template RveView as_seen<2>(const Specimen<2>&, const SampleRve<2>&, const TestRecord&);
template RveView as_seen<3>(const Specimen<3>&, const SampleRve<3>&, const TestRecord&);
} // namespace feldspar
