#include "benchmarks/committed_version.h"
#include "coupling/network/network.h"
#include "coupling/rve/homogenisation.h"
#include "dem/genesis/genesis.h"

#include <fmt/format.h>

/// Coordination and stiffness of bonded periodic networks of some 840 spheres, all bonds intact, by the gap up to which
/// pairs are joined: three packings, each joined four times over. Writes benchmarks/results/networks-in-space.json to the
/// screen; two minutes.
int main()
{
  using namespace feldspar;
  const std::string version_of_results = committed_version();
  SpecimenParameters wanted;
  wanted.dimension = 3;
  wanted.shape = BodyShape::periodic;
  wanted.width = wanted.height = 0.0148;
  wanted.porosity = 0.36;
  wanted.packed_by_descent = false; // as what it is compared with
  FlatJointParameters joint;
  std::string rows;
  for (const std::uint64_t seed : {1, 2, 3})
    {
      joint.installation_gap_ratio = 0.05;
      const auto packing = make_specimen<3>(wanted, joint, {}, seed);
      for (const double gap : {0.0, 0.05, 0.1, 0.3})
        {
          Specimen<3> specimen = packing;
          joint.installation_gap_ratio = gap;
          install_joints(specimen, joint);
          const Network<3> network(specimen);
          const auto constants = isotropic_constants<3>(network.intact_stiffness());
          rows += fmt::format(
            "{}  {{\"seed\": {}, \"n_grains\": {}, \"n_joints\": {}, \"installation_gap_ratio\": {}, "
            "\"coordination_number\": {:.3f}, \"youngs_modulus_over_joint_modulus\": {:.4f}, \"poissons_ratio\": {:.4f}, "
            "\"anisotropy\": {:.3f}}}",
            rows.empty() ? "" : ",\n", seed, network.n_grains(), network.n_joints(), gap,
            specimen.report.coordination_number, constants.youngs_modulus / joint.modulus, constants.poissons_ratio,
            constants.anisotropy);
        }
    }
  fmt::print("{{\"feldspar_version\": \"{}\", \"networks\": [\n{}\n]}}\n", version_of_results, rows);
}
