#include "app/programme/rve_results.h"

#include "base/colour.h"
#include "base/whole_file.h"
#include "coupling/rve/homogenisation.h"
#include "results/folder/provenance_json.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>
#include <utility>

namespace feldspar
{
namespace
{
using Json = nlohmann::ordered_json;

/// Tensor shear outside, engineering shear inside.
template <int dim>
double outside(const PathSample<dim>& sample, const int k)
{
  return sample.strain[k] / engineering_factor<dim>(k);
}

template <int dim>
std::string components(const char* prefix, const char* suffix)
{
  std::string text;
  for (int k = 0; k < n_voigt<dim>; ++k)
    text += fmt::format("{}{}{}{}", k > 0 ? "," : "", prefix, voigt_name<dim>(k), suffix);
  return text;
}

template <int dim>
void write_curve(const FinishedRve<dim>& rve, const std::filesystem::path& file)
{
  std::string text = components<dim>("strain_", "") + "," + components<dim>("stress_", "_Pa");
  for (const auto& column : path_columns<dim>)
    fmt::format_to(std::back_inserter(text), ",{}", column.name);
  text += '\n';
  for (const auto& row : rve.record.samples)
    {
      for (int k = 0; k < n_voigt<dim>; ++k)
        fmt::format_to(std::back_inserter(text), "{}{}", k > 0 ? "," : "", outside(row, k) + 0.0); // no -0
      for (const double component : row.stress)
        fmt::format_to(std::back_inserter(text), ",{}", component + 0.0);
      for (const auto& column : path_columns<dim>)
        fmt::format_to(std::back_inserter(text), ",{}", column.value(row));
      text += '\n';
    }
  write_whole_file(file, text);
}

template <int dim>
void write_cracks(const std::vector<FinishedRve<dim>>& rves, const std::filesystem::path& file)
{
  constexpr std::string_view axes = "xyz";
  std::string text = "rve,kind,joint,segment,increment," + components<dim>("strain_", "");
  for (int c = 0; c < dim; ++c)
    text += fmt::format(",{}_m", axes[c]);
  for (int c = 0; c < dim; ++c)
    text += fmt::format(",normal_{}", axes[c]);
  text += ",size_m,released_energy_J,mineral_1,mineral_2,on_boundary\n";
  for (const auto& rve : rves)
    for (const auto& crack : rve.record.cracks)
      {
        fmt::format_to(std::back_inserter(text), "{},{},{},{},{}", rve.name, crack.in_tension ? "tension" : "shear",
                       crack.joint, crack.segment, crack.increment);
        for (int k = 0; k < n_voigt<dim>; ++k)
          fmt::format_to(std::back_inserter(text), ",{}", outside(rve.record.samples[crack.increment], k));
        const auto place = segment_place(*rve.network, crack.joint, crack.segment);
        for (int c = 0; c < dim; ++c)
          fmt::format_to(std::back_inserter(text), ",{}", place.centroid[c]);
        for (int c = 0; c < dim; ++c)
          fmt::format_to(std::back_inserter(text), ",{}", place.normal[c]);
        const MineralSides sides = rve.network->sides_of(crack.joint);
        fmt::format_to(std::back_inserter(text), ",{},{},{},{},{:d}\n", place.size, crack.released_energy, sides.lower,
                       sides.higher, sides.on_boundary);
      }
  write_whole_file(file, text);
}

template <typename Matrix>
Json rows(const Matrix& matrix)
{
  Json json = Json::array();
  for (const auto& row : matrix.rowwise())
    json.push_back(std::vector<double>(row.begin(), row.end()));
  return json;
}

void write_constants(Json& json, const IsotropicConstants& constants)
{
  json["youngs_modulus_Pa"] = constants.youngs_modulus;
  json["poissons_ratio"] = constants.poissons_ratio;
  json["bulk_modulus_Pa"] = constants.bulk_modulus;
  json["shear_modulus_Pa"] = constants.shear_modulus;
  json["anisotropy"] = constants.anisotropy;
}

/// Largest of a figure over the samples. Where a path has not set off yet, as in explicit dynamics at a first row of zeros, all
/// terms are round-off and so are their ratios: such a sample does not count.
template <int dim, typename Of>
double largest(const PathRecord<dim>& record, const Of& of)
{
  double turnover = 0.0;
  for (const auto& sample : record.samples)
    turnover = std::max(turnover, sample.turnover());
  constexpr double round_off = 1e-12;
  double found = 0.0;
  for (const auto& sample : record.samples)
    if (sample.turnover() > round_off * turnover)
      found = std::max(found, of(sample));
  return found;
}

/// The sample with the highest stress of a component times sign.
template <int dim>
const PathSample<dim>& extreme(const PathRecord<dim>& record, const int k, const double sign)
{
  return *std::ranges::max_element(
    record.samples, [&](const auto& a, const auto& b) { return sign * a.stress[k] < sign * b.stress[k]; });
}

template <int dim>
Json as_json(const FinishedRve<dim>& rve)
{
  const Network<dim>& network = *rve.network;
  const PathRecord<dim>& record = rve.record;
  Json json;
  json["name"] = rve.name;
  json["seed"] = rve.seed;
  if (!rve.variant.empty())
    {
      json["variant"] = rve.variant;
      json["variant_values"] = as_json(rve.settings);
    }
  json["boundary"] = name(network.boundary());
  json["n_grains"] = network.n_own_grains();
  json["n_joints"] = network.n_joints();
  json["coordination_number"] = rve.specimen.coordination_number;
  json["installation_gap_ratio"] = rve.specimen.installation_gap_ratio;
  json["porosity"] = rve.specimen.porosity;
  json["cell_m"] = rows(network.cell());
  for (const auto& [mineral, n_grains, share] : network.minerals())
    json["minerals"].push_back(
      {{"name", mineral.name}, {"colour", colour_text(mineral.colour)}, {"n_grains", n_grains}, {"share", share}});
  json["stiffness_Pa"] = rows(network.intact_stiffness());
  write_constants(json, isotropic_constants<dim>(network.intact_stiffness()));
  if (const auto& bounds = rve.mixture)
    for (const auto& [name, moduli] : {std::pair("reuss", bounds->reuss),
                                       {"hashin_shtrikman_lower", bounds->hashin_shtrikman_lower},
                                       {"hashin_shtrikman_upper", bounds->hashin_shtrikman_upper},
                                       {"voigt", bounds->voigt}})
      json["mixture_bounds"][name] = {{"bulk_modulus_Pa", moduli.bulk_modulus},
                                      {"shear_modulus_Pa", moduli.shear_modulus}};
  json["stiffness_minimal_kinematic_Pa"] = rows(rve.bounds.minimal_kinematic);
  json["stiffness_affine_Pa"] = rows(rve.bounds.affine);
  json["fabric"] = rows(fabric(network));

  for (const auto& [key, sign] : {std::pair("highest_stress", 1.0), std::pair("lowest_stress", -1.0)})
    for (int k = 0; k < n_voigt<dim>; ++k)
      {
        const auto& sample = extreme(record, k, sign);
        Json& out = json[key][voigt_name<dim>(k)];
        out["stress_Pa"] = sample.stress[k] + 0.0;
        out["strain"] = outside(sample, k) + 0.0;
        out["n_tension_cracks"] = sample.n_tension_cracks;
        out["n_shear_cracks"] = sample.n_shear_cracks;
      }

  const auto& last = record.samples.back();
  Json& end = json["at_end"];
  for (int k = 0; k < n_voigt<dim>; ++k)
    {
      end["strain_" + voigt_name<dim>(k)] = outside(last, k) + 0.0;
      end["stress_" + voigt_name<dim>(k) + "_Pa"] = last.stress[k] + 0.0;
    }
  for (const auto& column : path_columns<dim>)
    if (column.in_summary == InSummary::count_at_end)
      end[std::string(column.name)] = std::uint64_t(column.value(last));
    else if (column.in_summary == InSummary::at_end)
      end[std::string(column.name)] = column.value(last);
  const auto cracks = crack_measures(network, rve.state);
  end["crack_density_per_m"] = cracks.density;
  end["crack_area_share"] = cracks.area_share;
  end["crack_orientation_per_m"] = rows(cracks.orientation);
  end["n_fragments"] = n_fragments(network, rve.state);

  json["increments"] = record.samples.size() - 1;
  for (const auto& column : path_columns<dim>)
    if (column.in_summary == InSummary::largest)
      json[std::string(column.name)] = largest(record, column.value);
  json["wall_time_s"] = rve.wall_time;
  if (!record.failure.empty())
    json["ended_early"] = record.failure;
  return json;
}
} // namespace

template <int dim>
void write_results(const Provenance& provenance, const std::vector<FinishedRve<dim>>& rves,
                   const std::filesystem::path& folder)
{
  std::filesystem::create_directories(folder / "curves");
  for (const auto& rve : rves)
    write_curve(rve, folder / "curves" / (rve.name + ".csv"));
  write_cracks(rves, folder / "cracks.csv");

  Json json = as_json(provenance);
  Stiffness<dim> mean = Stiffness<dim>::Zero();
  for (const auto& rve : rves)
    mean += rve.network->intact_stiffness() / double(rves.size());
  json["stiffness_Pa"] = rows(mean); // Voigt, engineering shear; mean of the RVEs
  write_constants(json, isotropic_constants<dim>(mean));
  json["rves"] = Json::array();
  for (const auto& rve : rves)
    json["rves"].push_back(as_json(rve));
  write_whole_file(folder / "summary.json", json_text(json));
}

template <int dim>
std::string describe(const FinishedRve<dim>& rve)
{
  const auto& stiffness = rve.network->intact_stiffness();
  const auto constants = isotropic_constants<dim>(stiffness);
  const auto& last = rve.record.samples.back();
  std::string text =
    fmt::format("{}{}: {} grains, {} joints, z {:.3f}, gap {:.4f}\n", rve.name,
                rve.variant.empty() ? "" : ", " + rve.variant, rve.network->n_own_grains(), rve.network->n_joints(),
                rve.specimen.coordination_number, rve.specimen.installation_gap_ratio);
  text += fmt::format("  stiffness, GPa                {}\n", components<dim>("", ""));
  for (int i = 0; i < n_voigt<dim>; ++i)
    {
      text += fmt::format("    {:<28}", voigt_name<dim>(i));
      for (int j = 0; j < n_voigt<dim>; ++j)
        text += fmt::format("{:9.3f}", stiffness(i, j) / 1e9);
      text += "\n";
    }
  text += fmt::format("  nearest isotropic body        E {:.2f} GPa, nu {:.4f}, K {:.2f} GPa, G {:.2f} GPa\n"
                      "  anisotropy                    {:.2f} % of the stiffness\n",
                      constants.youngs_modulus / 1e9, constants.poissons_ratio, constants.bulk_modulus / 1e9,
                      constants.shear_modulus / 1e9, 100.0 * constants.anisotropy);
  if (rve.mixture)
    text += fmt::format(
      "  bounds of its minerals        Hashin and Shtrikman K {:.2f} to {:.2f} GPa, G {:.2f} to {:.2f} "
      "GPa; Reuss and Voigt K {:.2f} to {:.2f}, G {:.2f} to {:.2f}\n",
      rve.mixture->hashin_shtrikman_lower.bulk_modulus / 1e9, rve.mixture->hashin_shtrikman_upper.bulk_modulus / 1e9,
      rve.mixture->hashin_shtrikman_lower.shear_modulus / 1e9, rve.mixture->hashin_shtrikman_upper.shear_modulus / 1e9,
      rve.mixture->reuss.bulk_modulus / 1e9, rve.mixture->voigt.bulk_modulus / 1e9,
      rve.mixture->reuss.shear_modulus / 1e9, rve.mixture->voigt.shear_modulus / 1e9);
  for (int k = 0; k < n_voigt<dim>; ++k)
    {
      const auto& high = extreme(rve.record, k, 1.0);
      const auto& low = extreme(rve.record, k, -1.0);
      const auto megapascals = [](const double stress) {
        constexpr double shown = 1e3; // of three decimals; the 0 takes the sign of what vanishes by rounding
        return std::round(stress / 1e6 * shown) / shown + 0.0;
      };
      text += fmt::format("  stress {:<22} {:.3f} MPa at {:.3e} to {:.3f} MPa at {:.3e}\n", voigt_name<dim>(k),
                          megapascals(low.stress[k]), outside(low, k), megapascals(high.stress[k]), outside(high, k));
    }
  text += fmt::format("  cracks, tension / shear       {} / {}\n"
                      "  energy imbalance              {:.1e}\n"
                      "  time                          {:.2f} s for {} increments\n",
                      last.n_tension_cracks, last.n_shear_cracks,
                      largest(rve.record, [](const auto& sample) { return sample.energy_imbalance(); }), rve.wall_time,
                      rve.record.samples.size() - 1);
  if (!rve.record.failure.empty())
    text += fmt::format("  {}\n", rve.record.failure);
  return text;
}

template void write_results<2>(const Provenance&, const std::vector<FinishedRve<2>>&, const std::filesystem::path&);
template std::string describe<2>(const FinishedRve<2>&);
template void write_results<3>(const Provenance&, const std::vector<FinishedRve<3>>&, const std::filesystem::path&);
template std::string describe<3>(const FinishedRve<3>&);
} // namespace feldspar
