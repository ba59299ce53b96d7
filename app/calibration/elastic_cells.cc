#include "app/calibration/elastic_cells.h"

#include "app/calibration/calibrated_input.h"
#include "app/calibration/kept_values.h"
#include "app/programme/run_board.h"
#include "app/run/interrupt.h"
#include "coupling/network/network.h"
#include "coupling/rve/homogenisation.h"
#include "dem/genesis/genesis.h"
#include "dem/minerals/minerals.h"
#include "runs/jobs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace feldspar::calibration
{
namespace
{
std::vector<double> spread(const Bounds& bounds, const std::size_t n)
{
  std::vector<double> values;
  for (std::size_t k = 0; k < n; ++k)
    values.push_back(bounds.lower * std::pow(bounds.upper / bounds.lower, double(k) / double(n - 1)));
  return values;
}

/// The same rock as a periodic cell.
Input cell_of(const Input& input)
{
  constexpr double n_grains = 900.0; // the constants of a cell then scatter by about a per cent
  Input cell = input;
  cell.specimen.shape = BodyShape::periodic;
  cell.specimen.coring = Coring::none; // a core is cut from such a cell
  cell.specimen.cells_across = 1;
  cell.specimen.cells_along = 1;
  if (input.specimen.dimension == 3)
    {
      // Walls leave voids, which a cell has not: at the porosity of a narrow cylinder it would be too loose to come to rest.
      cell.specimen.porosity = std::min(input.specimen.porosity, porosity_in_space);
      cell.specimen.packed_by_descent = true; // half a minute less than by motion
    }
  const double present = expected_grains(cell.specimen) / (cell.specimen.width * cell.specimen.height *
                                                           (cell.specimen.dimension == 3 ? cell.specimen.width : 1.0));
  cell.specimen.width = std::pow(n_grains / present, 1.0 / double(cell.specimen.dimension));
  cell.specimen.height = cell.specimen.width;
  return cell;
}
} // namespace

template <int dim>
ElasticTable elastic_constants(const Input& input, const std::optional<Bounds>& stiffness_ratio,
                               const std::optional<Bounds>& gap, const double gap_of_specimens,
                               const std::filesystem::path& folder, Progress& progress)
{
  constexpr std::size_t n_packings = 3;
  constexpr std::size_t n_ratios = 17;
  constexpr std::size_t n_gaps = 9;
  const Input cell = cell_of(input);
  const std::vector<double> ratios = stiffness_ratio
                                       ? spread(*stiffness_ratio, n_ratios)
                                       : std::vector{std::get<FlatJointParameters>(input.joints).stiffness_ratio};
  const std::vector<double> gaps = gap ? spread(*gap, n_gaps) : std::vector{gap_of_specimens};
  using Constants = ElasticTable::Constants;
  std::vector<std::vector<Constants>> constants(gaps.size(), std::vector<Constants>(ratios.size()));
  struct Order
  {
    std::size_t gap, ratio;
    Input rock;
    KeptValues kept;
  };
  std::vector<Order> orders; // that no earlier run has carried out
  for (std::size_t g = 0; g < gaps.size(); ++g)
    for (std::size_t r = 0; r < ratios.size(); ++r)
      {
        MicroParameters parameters = micro_parameters(cell);
        parameters.stiffness_ratio = ratios[r];
        parameters.gap = gaps[g];
        const Input rock = with_parameters(cell, parameters);
        const KeptValues kept(folder, fmt::format("elastic_gap_{}_ratio_{}", g, r), rock);
        if (const auto values = kept.read(2); values && (*values)[0] && (*values)[1])
          constants[g][r] = {*(*values)[0], *(*values)[1]};
        else
          orders.push_back({g, r, rock, kept});
      }
  std::vector<Specimen<dim>> packings(orders.empty() ? 0 : n_packings);
  for_each_job(packings.size(), [&](const std::size_t k) { packings[k] = packing_of<dim>(cell, k + 1); });

  RunBoard board(progress, "", std::vector<BoardPart>(orders.size()));
  for_each_job(orders.size(), [&](const std::size_t job) {
    end_if_interrupted();
    const Order& order = orders[job];
    const auto& joint = std::get<FlatJointParameters>(order.rock.joints);
    Constants mean{0.0, 0.0};
    for (const Specimen<dim>& packing : packings)
      {
        Specimen<dim> specimen = packing;
        specimen.joints = {};
        specimen.particle_contact = order.rock.particle_contact;
        install_joints(specimen, joint);
        put_in_minerals(specimen, order.rock.minerals);
        const IsotropicConstants of_cell = isotropic_constants<dim>(Network<dim>(specimen).intact_stiffness());
        mean.modulus_ratio += of_cell.youngs_modulus / joint.modulus / double(n_packings);
        mean.poissons_ratio += of_cell.poissons_ratio / double(n_packings);
      }
    constants[order.gap][order.ratio] = mean;
    order.kept.write({mean.modulus_ratio, mean.poissons_ratio});
    board.ended(job);
  });
  return {ratios, gaps, constants};
}

template <int dim>
Specimen<dim> packing_of(const Input& input, const std::uint64_t seed)
{
  return make_specimen<dim>(input.specimen, std::get<FlatJointParameters>(input.joints), input.particle_contact, seed,
                            end_if_interrupted);
}

template decltype(elastic_constants<2>) elastic_constants<2>;
template decltype(elastic_constants<3>) elastic_constants<3>;
template decltype(packing_of<2>) packing_of<2>;
template decltype(packing_of<3>) packing_of<3>;
} // namespace feldspar::calibration
