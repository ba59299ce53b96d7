#include "coupling/sample/grain_material.h"

#include "base/byte_archive.h"
#include "base/checksum/fingerprint.h"
#include "base/random.h"
#include "coupling/rve/homogenisation.h"
#include "coupling/rve/state_archive.h"

#include <Eigen/Geometry>

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <numeric>

namespace feldspar
{
template <int dim>
GrainPoint<dim>::GrainPoint(std::shared_ptr<const Network<dim>> network, const Tensor<dim>& orientation,
                            const EquilibriumParameters& parameters, std::function<bool()> leaves,
                            const bool with_factors)
  : turn(orientation)
  , accepted(network, parameters)
  , at_work(std::move(network), parameters)
  , gives_up(std::move(leaves))
  , keeps_factors(with_factors)
{
  for (int k = 0; k < n_voigt<dim>; ++k)
    strain_to_rve.col(k) = strain_voigt<dim>(turn.transpose() * strain_tensor<dim>(Voigt<dim>::Unit(k)) * turn);
}

/// Tries a strain in the axes of the RVE with the factor of the trial before. The search begins where that ended.
template <int dim>
Trial<dim> GrainPoint<dim>::tried_at_work(const Voigt<dim>& strain, TrialOptions<dim> options) const
{
  options.factorised = factorised;
  if (tried_strain && !tried.state.motions.empty())
    options.nearby = &tried.state;
  Trial<dim> trial = at_work.trial(strain_control<dim>(strain), options);
  const KeptFactor<dim> last = std::exchange(trial.factorised, {});
  if (keeps_factors)
    factorised = last;
  return trial;
}

template <int dim>
fem::MaterialResponse<dim> GrainPoint<dim>::trial(const Voigt<dim>& strain) const
{
  const Voigt<dim> wanted = strain_to_rve * strain;
  if (!tried_strain || *tried_strain != wanted)
    {
      tried = tried_at_work(wanted, {.bonds = Bonds::frozen,
                                     .with_tangent = true,
                                     .provisional = true,
                                     .tangent = last_tangent,
                                     .gives_up = gives_up});
      tried_strain = wanted;
      if (tried.tangent && !at_work.state().intact)
        last_tangent = tried.tangent;
    }
  if (!tried.in_equilibrium)
    throw fem::PointFailure("the grains of an RVE find no equilibrium");
  // Work is the same in both axes, so stress and stiffness follow from how strain turns.
  return {strain_to_rve.transpose() * tried.state.stress,
          strain_to_rve.transpose() * tried.tangent->value * strain_to_rve};
}

template <int dim>
fem::PointEvents<dim> GrainPoint<dim>::relax(const Voigt<dim>& strain, const Bonds bonds)
{
  const Voigt<dim> wanted = strain_to_rve * strain;
  Trial<dim> broken = tried_at_work(wanted, {.bonds = bonds, .gives_up = gives_up});
  if (!broken.in_equilibrium)
    throw fem::PointFailure("the grains of an RVE find no equilibrium after a break");
  const std::size_t n_events = broken.n_loosened;
  const Voigt<dim> stress = strain_to_rve.transpose() * broken.state.stress;
  if (n_events == 0)
    {
      stable = {wanted, std::move(broken)};
      return {0, stress};
    }
  events_at_work.insert(events_at_work.end(), broken.breaks.begin(), broken.breaks.end());
  at_work.accept(std::move(broken));
  forget_trial();
  return {n_events, stress};
}

/// All points are to accept, or none.
template <int dim>
void GrainPoint<dim>::accept(const Voigt<dim>& strain)
{
  const Voigt<dim> wanted = strain_to_rve * strain;
  Trial<dim> found =
    stable && stable->first == wanted ? std::move(stable->second) : tried_at_work(wanted, {.bonds = Bonds::frozen});
  if (!found.in_equilibrium)
    throw fem::PointFailure("the grains of an RVE find no equilibrium");
  at_work.accept(std::move(found));
  forget_trial();
  factorised = {};
  accepted = at_work;
  accepted_tangent = last_tangent;
  events_accepted = std::exchange(events_at_work, {});
}

template <int dim>
void GrainPoint<dim>::reject()
{
  at_work = accepted;
  events_at_work.clear();
  forget_trial();
  factorised = {};
  last_tangent = accepted_tangent;
}

namespace
{
/// The tangent goes with the state: computed anew it would differ by its precision, and a resumed run would go another
/// way.
template <int dim>
struct StoredPoint
{
  NetworkState<dim> state;
  std::optional<Tangent<dim>> tangent;
};

template <int dim, typename Archive>
void transfer(Archive& archive, StoredPoint<dim>& point)
{
  feldspar::transfer(archive, point.state);
  bool has_tangent = point.tangent.has_value();
  transfer_flag(archive, "has_tangent", has_tangent);
  if (!has_tangent)
    return;
  if (!point.tangent)
    point.tangent.emplace();
  archive.value("states_of_tangent", point.tangent->states);
  for (double& entry : point.tangent->value.reshaped())
    archive.value("tangent_Pa", entry);
}
} // namespace

template <int dim>
std::string GrainPoint<dim>::stored() const
{
  return to_bytes(StoredPoint<dim>{accepted.state(), accepted_tangent});
}

template <int dim>
void GrainPoint<dim>::restore(const std::string& stored)
{
  auto [state, tangent] = from_bytes<StoredPoint<dim>>(stored);
  accepted.restore(std::move(state));
  accepted_tangent = std::move(tangent);
  events_accepted.clear();
  reject();
}

template <int dim>
void GrainPoint<dim>::forget_trial()
{
  tried_strain.reset();
  tried = {};
  stable.reset();
}

template <int dim>
std::vector<fem::PointCrack<dim>> GrainPoint<dim>::cracks_of_last_step() const
{
  std::vector<fem::PointCrack<dim>> cracks;
  const Network<dim>& network = accepted.network();
  for (const BreakEvent<dim>& event : events_accepted)
    {
      const std::uint32_t joint = network.link_of_segment(event.segment);
      const auto place = segment_place(network, joint, event.segment - network.links()[joint].first_segment);
      cracks.push_back({event.in_tension, event.segment, turn * place.normal, place.size, event.released_energy,
                        event.released_energy / network.volume()});
    }
  return cracks;
}

template <int dim>
std::optional<fem::PointEnergies> GrainPoint<dim>::energies() const
{
  const NetworkWork& work = at_work.state().work;
  const double volume = at_work.network().volume();
  return fem::PointEnergies{at_work.stored_energy() / volume, work.slip / volume, work.released / volume,
                            work.settled / volume};
}

template <int dim>
std::any GrainPoint<dim>::structure() const
{
  return GrainStructure<dim>{turn, &accepted.network(), accepted.state()};
}

template <int dim>
std::vector<double> GrainPoint<dim>::fields() const
{
  const NetworkState<dim>& state = accepted.state();
  const auto n = double(accepted.network().n_segments());
  const NetworkWork& work = state.work;
  const CrackMeasures<dim> cracks = crack_measures(accepted.network(), state);
  std::vector<double> values{(state.n_tension_breaks + state.n_shear_breaks) / n, state.n_shear_breaks / n,
                             (work.slip + work.released + work.settled) / accepted.network().volume(), cracks.density};
  const Voigt<dim> orientation = stress_voigt<dim>(turn * cracks.orientation * turn.transpose());
  values.insert(values.end(), orientation.begin(), orientation.end());
  return values;
}

namespace
{
/// A number of its own for each point of each sample; one for all points of a cell where they share their RVE.
std::uint64_t point_seed(const GrainMaterialParameters& parameters, const fem::PointPlace& place)
{
  Fingerprint print;
  print.add(parameters.seed);
  print.add(place.cell);
  print.add_byte(parameters.to_elements ? 0 : place.quadrature_point);
  return print.value();
}

/// The realisation that a place gets from a shuffled stack.
std::size_t drawn_without_replacement(const GrainMaterialParameters& parameters, const fem::PointPlace& place,
                                      const std::size_t n)
{
  std::vector<std::size_t> stack(n);
  std::iota(stack.begin(), stack.end(), std::size_t(0));
  Random(parameters.seed, RandomStream::dealing).shuffle(stack);
  const std::uint64_t number = parameters.to_elements
                                 ? place.cell_number
                                 : place.cell_number * parameters.n_points_of_cell + place.quadrature_point;
  return stack[number % n];
}

/// Any turn as likely as any other.
template <int dim>
Tensor<dim> random_turn(Random& random)
{
  if constexpr (dim == 2)
    return Eigen::Rotation2Dd(random.uniform(0.0, 2.0 * std::numbers::pi)).toRotationMatrix();
  else
    {
      // A direction in four dimensions, taken as a quaternion (Shoemake 1992).
      Eigen::Quaterniond turn;
      for (double& component : turn.coeffs())
        component = random.normal(0.0, 1.0);
      return turn.normalized().toRotationMatrix();
    }
}

/// Rotation from r, θ, z to x, y, z.
template <int dim>
Tensor<dim> local_axes(const fem::PointPlace& place)
{
  Tensor<dim> axes = Tensor<dim>::Identity();
  axes.template topLeftCorner<2, 2>() =
    Eigen::Rotation2Dd(std::atan2(place.position[1], place.position[0])).toRotationMatrix();
  return axes;
}

/// The least turn that takes the first axis to a normal, or against it, in the coordinates of a sample: of a section these
/// are the first and the last axis.
template <int dim>
Tensor<dim> first_axis_along(const std::vector<double>& normal)
{
  Vector<dim> wanted = Vector<dim>::Zero();
  for (std::size_t c = 0; c + 1 < normal.size(); ++c)
    wanted[Eigen::Index(c)] = normal[c];
  wanted[dim - 1] = normal.back();
  if (wanted[0] < 0.0)
    wanted = -wanted;
  if constexpr (dim == 2)
    return Eigen::Rotation2Dd(std::atan2(wanted[1], wanted[0])).toRotationMatrix();
  else
    return Eigen::Quaterniond::FromTwoVectors(Vector<3>::UnitX(), wanted).toRotationMatrix();
}
} // namespace

template <int dim>
Specimen<dim> weakened(Specimen<dim> specimen, const double share)
{
  auto& joints = specimen.joints;
  for (std::size_t j = 0; j < joints.size(); ++j)
    for (std::size_t i = 0; i < joints.elements.size(); ++i)
      {
        const std::size_t k = joints.segment(i, j);
        joints.tensile_strength[k] *= share;
        joints.cohesion[k] *= share;
      }
  return specimen;
}

template <int dim>
fem::Material<dim> grain_material(std::vector<Realisation<dim>> realisations, const GrainMaterialParameters& parameters,
                                  RocksOfCells rocks)
{
  std::map<std::string, std::vector<Realisation<dim>>> by_rock;
  for (Realisation<dim>& one : realisations)
    by_rock[one.rock].push_back(std::move(one));
  fem::Material<dim> material;
  material.field_names = {"broken_segments_share", "broken_in_shear_share", "dissipation_J_per_m3",
                          "crack_density_per_m"};
  for (int k = 0; k < n_voigt<dim>; ++k) // along the axes of the sample
    material.field_names.push_back(fmt::format("crack_orientation_{}_per_m", voigt_name<dim>(k)));
  material.make_point = [by_rock = std::move(by_rock), parameters, rocks = std::move(rocks)](
                          const fem::PointPlace& place) -> std::unique_ptr<fem::MaterialPoint<dim>> {
    Random random(point_seed(parameters, place), RandomStream::dealing);
    const auto rock = rocks.find(place.cell);
    const auto& candidates = by_rock.at(rock == rocks.end() ? "" : rock->second);
    const auto with_replacement = std::size_t(random.uniform() * double(candidates.size()));
    const auto& assigned =
      candidates[parameters.without_replacement ? drawn_without_replacement(parameters, place, candidates.size())
                                                : with_replacement];
    const auto& network = place.side_normal.empty() ? assigned.inside : assigned.at_side;
    const bool is_edge = network->boundary().kind == BoundaryKind::edge;
    Tensor<dim> turn = Tensor<dim>::Identity();
    if (is_edge && !parameters.in_local_axes)
      turn = first_axis_along<dim>(place.side_normal);
    else if (!is_edge && parameters.random_orientation)
      turn = random_turn<dim>(random);
    if (parameters.in_local_axes)
      turn = local_axes<dim>(place) * turn;
    return std::make_unique<GrainPoint<dim>>(network, turn, parameters.equilibrium, parameters.gives_up,
                                             parameters.keeps_factors);
  };
  return material;
}

template class GrainPoint<2>;
template Specimen<2> weakened<2>(Specimen<2>, double);
template fem::Material<2> grain_material<2>(std::vector<Realisation<2>>, const GrainMaterialParameters&, RocksOfCells);
template class GrainPoint<3>;
template Specimen<3> weakened<3>(Specimen<3>, double);
template fem::Material<3> grain_material<3>(std::vector<Realisation<3>>, const GrainMaterialParameters&, RocksOfCells);
} // namespace feldspar
