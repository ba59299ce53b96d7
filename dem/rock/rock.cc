#include "dem/rock/rock.h"

#include "base/parameter_id.h"
#include "dem/flaws/apply.h"
#include "dem/flaws/clumps.h"
#include "dem/flaws/mineral_grains.h"
#include "dem/genesis/genesis.h"
#include "dem/minerals/minerals.h"
#include "dem/specimen/specimen_file.h"

#include <fmt/format.h>

#include <variant>

namespace feldspar
{
namespace
{
/// A specimen out of a file brings its own joint law, which must be that of the rock.
template <int dim>
Specimen<dim> read_finished_specimen(const SpecimenParameters& wanted, const std::function<void()>& check)
{
  auto specimen = read_specimen<dim>(wanted.specimen_file, check);
  const auto law = std::visit([](const auto& known) { return known.name; }, specimen.joints.law);
  if (law != wanted.joint_law)
    throw ParameterError(parameter_id<&SpecimenParameters::joint_law>(), wanted.joint_law,
                         fmt::format("the joints of {} are of the law {}", wanted.specimen_file, law));
  return specimen;
}
} // namespace

template <int dim>
Specimen<dim> make_rock(const RockParameters& rock, const std::uint64_t seed, const std::function<void()>& check,
                        const std::function<void()>& check_within)
{
  auto specimen = rock.specimen.specimen_file.empty()
                    ? make_specimen<dim>(rock.specimen, rock.joint, rock.particle_contact, seed, check, check_within)
                    : read_finished_specimen<dim>(rock.specimen, check_within);
  put_in_minerals(specimen, rock.minerals);
  put_in_flaws(specimen, rock.flaws, rock.smooth_joint);
  put_in_mineral_grains(specimen, rock.mineral_grains, rock.smooth_joint);
  put_in_clumps(specimen, rock.clumps);
  if (rock.minerals.form_of_rock() == MineralGrainForm::smooth_boundaries)
    join_minerals_smoothly(specimen, rock.minerals, rock.smooth_joint);
  else if (rock.minerals.form_of_rock() == MineralGrainForm::rigid)
    make_minerals_rigid(specimen);
  return specimen;
}

template decltype(make_rock<2>) make_rock<2>;
template decltype(make_rock<3>) make_rock<3>;
} // namespace feldspar
