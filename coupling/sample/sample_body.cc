#include "coupling/sample/sample_body.h"

#include "base/parameter_id.h"
#include "base/ranks/communicator.h"
#include "base/ranks/ranks.h"
#include "coupling/sample/continua/continua.h"
#include "coupling/sample/grain_material.h"
#include "coupling/sample/sample_mesh.h"
#include "coupling/sample/sample_run.h"
#include "coupling/sample/softening.h"
#include "fem/solid/platens.h"

#include <deal.II/grid/grid_tools.h>

#include <fmt/format.h>

#include <algorithm>
#include <any>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace feldspar
{
namespace
{
fem::Kinematics kinematics_of(const SampleGeometry geometry)
{
  return geometry == SampleGeometry::axisymmetric ? fem::Kinematics::axisymmetric
         : geometry == SampleGeometry::cylinder   ? fem::Kinematics::full
                                                  : fem::Kinematics::plane;
}

template <int dim, int material_dim>
class FiniteElementBody final : public SampleBody
{
public:
  FiniteElementBody(const SampleParameters& its_sample, const SampleSetUp& set_up, fem::SampleMesh<dim> its_mesh,
                    const fem::Material<material_dim>& material, std::vector<MineralShare> of_rves)
    : sample(its_sample)
    , its_minerals(std::move(of_rves))
    , platens{kinematics_of(sample.geometry), sample.rough_platens ? fem::Platens::rough : fem::Platens::smooth}
    , mesh(std::move(its_mesh))
    , lower_corner(dealii::GridTools::compute_bounding_box(*mesh.triangulation).get_boundary_points().first)
    , its_size(size_of(mesh, sample))
    , solid(mesh, parameters_of(set_up), material)
  {
  }

  fem::NewtonReport solve(const SampleTarget& target, const double fraction) override
  {
    const auto test = platens.under(target.confining_pressure);
    switch (target.lead)
      {
      case SampleTarget::Lead::stress:
        return solid.solve(test.holding(target.target), fraction);
      case SampleTarget::Lead::lateral_strain:
        return solid.solve(test.widening(target.target * volume_of_lateral_strain()), fraction);
      default:
        return solid.solve(test.pressing(target.target), fraction);
      }
  }
  void let_force_hold_platen() override { solid.bear_by_pressure("top", dim - 1); }
  void accept() override { solid.accept(); }
  void reject() override { solid.reject(); }
  void limit_events(const std::uint64_t most_events) override { solid.limit_events(most_events); }

  SampleSize size() const override { return its_size; }
  std::array<double, 3> box() const override
  {
    const double width = its_size.width;
    const double height = its_size.height;
    if (sample.geometry == SampleGeometry::plane)
      return {width, height, 0.0};
    constexpr double thickness = 1.0;
    return {width, sample.geometry == SampleGeometry::plane_strain ? thickness : width, height};
  }
  std::uint64_t n_points() const override { return solid.n_points(); }
  std::uint64_t n_segments() const override
  {
    std::uint64_t n = 0;
    for (std::size_t i = 0; i < n_points_here(); ++i)
      {
        const std::any structure = solid.material_points()[i].structure();
        if (const auto* const grains = std::any_cast<GrainStructure<material_dim>>(&structure))
          n += grains->network->n_segments();
      }
    return ranks::sum(n);
  }
  std::size_t n_points_per_cell() const override { return solid.n_points_per_cell(); }
  const std::vector<MineralShare>& minerals() const override { return its_minerals; }

  double top_displacement() const override { return solid.mean_displacement("top", dim - 1); }
  double lateral_strain() const override
  {
    double swept = 0.0;
    for (const std::string& boundary : boundaries_of(sample.geometry))
      if (boundary == "left" || boundary == "right" || boundary == "side")
        swept += solid.swept_volume(boundary);
    return swept / volume_of_lateral_strain();
  }
  double n_lateral_directions() const override { return platens.kinematics == fem::Kinematics::plane ? 1.0 : 2.0; }
  double platen_stress(const std::string& end) const override
  {
    return solid.reaction(end, dim - 1) / solid.area(end) - solid.pressure(end);
  }
  double mean_axial_stress() const override { return solid.mean_stress()[material_dim - 1]; }

  /// The moment of an event is the volume times the fall of its stress at a held strain (stress glut; docs/theory.md §4.14).
  PointBreaks breaks_of_last_step() const override
  {
    PointBreaks breaks;
    for (std::size_t i = 0; i < n_points_here(); ++i)
      {
        const auto broken_here = solid.material_points()[i].cracks_of_last_step();
        if (broken_here.empty())
          continue;
        const std::any structure = its_minerals.empty() ? std::any() : solid.material_points()[i].structure();
        EmissionEvent event{.number = solid.number_of_point(i), .centroid = in_box(i)};
        const double volume = thickness_ratio() * solid.volumes()[i];
        for (int k = 0; k < n_voigt<material_dim>; ++k)
          {
            const auto [row, column] = voigt_pair<material_dim>(k);
            event.moment[std::size_t(row * (5 - row) / 2 + column)] = volume * solid.stress_drops()[i][k];
          }
        for (const fem::PointCrack<material_dim>& broken : broken_here)
          {
            ++(broken.in_tension ? event.n_tension : event.n_shear);
            event.released_energy += volume * broken.released_density;
            Crack crack{broken.in_tension ? CrackKind::tension : CrackKind::shear,
                        event.number,
                        broken.segment,
                        0,
                        0.0,
                        event.centroid,
                        in_space<material_dim>(broken.normal),
                        broken.size,
                        broken.released_energy};
            const MineralSides sides = sides_of(broken.segment, structure);
            crack.mineral_1 = sides.lower;
            crack.mineral_2 = sides.higher;
            crack.on_boundary = sides.on_boundary;
            breaks.cracks.push_back(crack);
          }
        breaks.events.push_back(event);
      }
    return breaks;
  }

  Energies energies() const override
  {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    std::vector<double> sums(4, 0.0);
    for (std::size_t i = 0; i < n_points_here(); ++i)
      {
        const double volume = solid.volumes()[i];
        const fem::PointEnergies densities =
          solid.material_points()[i].energies().value_or(fem::PointEnergies{unknown, unknown, unknown, unknown});
        sums[0] += volume * densities.stored;
        sums[1] += volume * densities.slip;
        sums[2] += volume * densities.released;
        sums[3] += volume * densities.settled;
      }
    sums = ranks::sums(sums);
    Energies energies;
    energies.boundary_work = solid.boundary_work().total();
    energies.redistribution = solid.boundary_work().redistribution;
    energies.strain = sums[0];
    energies.slip = sums[1];
    energies.released = sums[2];
    energies.damping = sums[3];
    return energies;
  }

  std::uint64_t n_damaged_points() const override
  {
    std::uint64_t n = 0;
    for (std::size_t i = 0; i < n_points_here(); ++i)
      n += solid.material_points()[i].is_damaged();
    return ranks::sum(n);
  }

  std::optional<std::variant<SampleRve<2>, SampleRve<3>>> rve(const std::uint64_t number) const override
  {
    std::size_t i = 0;
    while (i < n_points_here() && solid.number_of_point(i) != number)
      ++i;
    if (i == n_points_here())
      return std::nullopt;
    const std::any structure = solid.material_points()[i].structure();
    const auto* const grains = std::any_cast<GrainStructure<material_dim>>(&structure);
    if (grains == nullptr)
      throw ParameterError(parameter_id<&SampleParameters::material>(), "the points of this sample have no grains");
    return SampleRve<material_dim>{*grains, number, position(i)};
  }

  void write_fields(fem::FieldOutput& output, const double time) const override { output.write(solid, time); }
  std::vector<std::string> boundaries() const override { return boundaries_of(sample.geometry); }
  fem::Balance rebalance() override { return solid.rebalance(); }
  fem::StoredSolid stored() const override { return solid.stored(); }
  void restore(const fem::StoredSolid& stored) override { solid.restore(stored); }

private:
  /// Ratio of the thickness of the body in the laboratory, its width, to the metre of the plane.
  double thickness_ratio() const { return platens.kinematics == fem::Kinematics::plane ? its_size.width : 1.0; }
  /// The volume that the sides sweep by a lateral strain of one [m³].
  double volume_of_lateral_strain() const { return n_lateral_directions() * solid.area("top") * its_size.height; }

  fem::SolidParameters parameters_of(const SampleSetUp& set_up) const
  {
    fem::SolidParameters parameters;
    parameters.kinematics = platens.kinematics;
    parameters.order = sample.order;
    parameters.reduced_quadrature = sample.reduced_quadrature;
    parameters.newton_tolerance = sample.newton_tolerance;
    parameters.watch = set_up.watch;
    parameters.gives_up = set_up.gives_up;
    return parameters;
  }

  std::size_t n_points_here() const { return solid.material_points().size(); }

  /// Minerals on both sides of a segment of an RVE, by their numbers in minerals().
  MineralSides sides_of(const std::uint32_t segment, const std::any& structure) const
  {
    const auto* const grains = std::any_cast<GrainStructure<material_dim>>(&structure);
    if (grains == nullptr || grains->network->minerals().empty())
      return {};
    const Network<material_dim>& network = *grains->network;
    const MineralSides own = network.sides_of(network.link_of_segment(segment));
    const auto number = [&](const std::uint32_t k) {
      return number_of_mineral(its_minerals, network.minerals()[k - 1].mineral.name);
    };
    const auto [lower, higher] = std::minmax({number(own.lower), number(own.higher)});
    return {lower, higher, own.on_boundary};
  }

  Vector<material_dim> position(const std::size_t i) const
  {
    const auto& place = solid.places()[i].position;
    Vector<material_dim> result = Vector<material_dim>::Zero();
    for (std::size_t c = 0; c + 1 < place.size(); ++c)
      result[Eigen::Index(c)] = place[c];
    result[material_dim - 1] = place.back();
    return result;
  }

  /// Position of a point in box(), with its lower corner as origin.
  std::array<double, 3> in_box(const std::size_t i) const
  {
    Vector<material_dim> result = position(i);
    result[0] -= lower_corner[0];
    result[material_dim - 1] -= lower_corner[dim - 1];
    if (sample.geometry == SampleGeometry::axisymmetric) // the right half of the section in front
      {
        result[0] += 0.5 * its_size.width;
        result[1] += 0.5 * its_size.width;
      }
    else if (material_dim == 3)
      result[1] -= dim == 3 ? lower_corner[1] : -0.5 * box()[1];
    return in_space<material_dim>(result);
  }

  SampleParameters sample;
  std::vector<MineralShare> its_minerals;
  fem::PlatenTest<dim> platens;
  fem::SampleMesh<dim> mesh;
  dealii::Point<dim> lower_corner;
  SampleSize its_size;
  fem::Solid<dim, material_dim> solid;
};

/// material_of: the material of a mesh.
template <int dim, int material_dim, class MaterialOf>
std::unique_ptr<SampleBody> make_body(const SampleParameters& sample, const SampleSetUp& set_up,
                                      const MaterialOf& material_of, const std::vector<MineralShare>& minerals)
{
  fem::SampleMesh<dim> mesh = mesh_of<dim>(sample);
  const fem::Material<material_dim> material = material_of(mesh);
  return std::make_unique<FiniteElementBody<dim, material_dim>>(sample, set_up, std::move(mesh), material, minerals);
}

/// Makes the body with a mesh of the dimension that the geometry needs.
template <int material_dim, class MaterialOf>
std::unique_ptr<SampleBody> make_body(const SampleParameters& sample, const SampleSetUp& set_up,
                                      const MaterialOf& material_of, const std::vector<MineralShare>& minerals = {})
{
  if constexpr (material_dim == 3)
    if (sample.geometry == SampleGeometry::cylinder)
      return make_body<3, 3>(sample, set_up, material_of, minerals);
  return make_body<2, material_dim>(sample, set_up, material_of, minerals);
}
} // namespace

SampleSize measure(const SampleParameters& sample)
{
  return sample.geometry == SampleGeometry::cylinder ? size_of(mesh_of<3>(sample), sample)
                                                     : size_of(mesh_of<2>(sample), sample);
}

namespace
{
/// Number of points of a cell, as the quadrature of fem/solid has them.
unsigned int n_points_of_cell(const SampleParameters& sample)
{
  const unsigned int each_way = sample.reduced_quadrature ? sample.order : sample.order + 1;
  const unsigned int in_section = each_way * each_way;
  return sample.geometry == SampleGeometry::cylinder ? in_section * each_way : in_section;
}

/// A factor at every point takes some 3 GB for 8 192 cells of a hundred spheres. By what the input says alone, as a run is to
/// give the same on any machine and any number of ranks.
template <int dim>
bool has_room_for_factors(const std::uint64_t n_points, const Network<dim>& of_point)
{
  constexpr double most_bytes = 16e9;
  return double(n_points) * double(of_point.factorised_stiffest().bytes()) <= most_bytes;
}
} // namespace

template <int dim>
std::unique_ptr<SampleBody> make_body_of_grains(const SampleParameters& sample, const SampleSetUp& set_up,
                                                const EquilibriumParameters& equilibrium,
                                                std::vector<Realisation<dim>> realisations, const std::uint64_t seed)
{
  if (dimension_of_rves(sample.geometry) != dim)
    throw std::invalid_argument("RVEs of another dimension than the sample's");
  GrainMaterialParameters material;
  material.seed = seed;
  material.random_orientation = sample.random_orientation;
  material.to_elements = sample.assigned_to_elements;
  material.without_replacement = sample.without_replacement;
  material.n_points_of_cell = n_points_of_cell(sample);
  material.in_local_axes = sample.geometry == SampleGeometry::cylinder; // as a mesh in r-z has them
  material.equilibrium = equilibrium;
  material.gives_up = set_up.gives_up;
  const Network<dim>& first = *realisations.front().inside;
  const double size = std::pow(first.volume() / first.thickness(), 1.0 / dim);
  const double unscaled = 0.0; // any element is larger
  const std::vector<MineralShare> minerals = minerals_of(realisations);
  const auto material_of = [&](const auto& mesh) {
    material.keeps_factors =
      has_room_for_factors(mesh.triangulation->n_global_active_cells() * material.n_points_of_cell, first);
    auto rves = grain_material<dim>(std::move(realisations), material, rocks_of_cells(mesh, sample));
    return scaled_softening<dim>(std::move(rves), sample.scaled_softening ? size : unscaled);
  };
  return make_body<dim>(sample, set_up, material_of, minerals);
}

std::unique_ptr<SampleBody> make_continuous_body(const SampleParameters& sample, const SampleSetUp& set_up,
                                                 const ContinuumParameters& continuum)
{
  const Continuum& material = continuum_of(sample.material);
  if (sample.geometry == SampleGeometry::plane)
    return make_body<2>(sample, set_up, [&](const auto&) { return material.in_plane(continuum); });
  return make_body<3>(sample, set_up, [&](const auto&) { return material.in_space(continuum); });
}

template decltype(make_body_of_grains<2>) make_body_of_grains<2>;
template decltype(make_body_of_grains<3>) make_body_of_grains<3>;
} // namespace feldspar
