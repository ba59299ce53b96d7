#include "coupling/sample/softening.h"

#include "base/byte_archive.h"

#include <algorithm>
#include <utility>

namespace feldspar
{
namespace
{
template <int dim>
double total_energy(const fem::MaterialPoint<dim>& point)
{
  const auto energies = point.energies().value_or(fem::PointEnergies{});
  return energies.stored + energies.slip + energies.released + energies.settled;
}
} // namespace

template <int dim>
SofteningPoint<dim>::SofteningPoint(std::unique_ptr<fem::MaterialPoint<dim>> rve, const double its_scale)
  : fem::ForwardingPoint<dim>(std::move(rve))
  , scale(its_scale)
  , compliance(inner->trial(Voigt<dim>::Zero()).tangent.inverse())
{
}

template <int dim>
Voigt<dim> SofteningPoint<dim>::residual(const Voigt<dim>& strain, const Voigt<dim>& rve_strain,
                                         const Voigt<dim>& stress) const
{
  return rve_strain - scale * strain - (1.0 - scale) * (compliance * stress + at_work.inelastic_strain);
}

/// Newton's method on the strain of the RVE, bonds frozen. C is at most C_0, so the gradient lies between κ and 1.
/// One step at least: what is left of the tolerance from where the search began would stay, however the strain is refined.
template <int dim>
auto SofteningPoint<dim>::find(const Voigt<dim>& strain) const -> const Found&
{
  if (found && found->strain == strain)
    return *found;
  if (!at_work.localised || scale == 1.0)
    return found.emplace(Found{strain, strain, inner->trial(strain)});

  constexpr double tolerance = 1e-7; // of the strain; the stresses of an RVE are known to some 1e-6
  constexpr int most_iterations = 30;
  Voigt<dim> at = nearby;
  auto response = inner->trial(at);
  Voigt<dim> missing = residual(strain, at, response.stress);
  for (int k = 0; k < most_iterations; ++k)
    {
      if (k > 0 && missing.norm() <= tolerance * std::max(at.norm(), strain.norm()))
        {
          nearby = at;
          return found.emplace(Found{strain, at, std::move(response)});
        }
      const Voigt<dim> step = gradient(response.tangent).partialPivLu().solve(missing);
      double share = 1.0;
      for (;; share *= 0.5) // faces that open, close and slide make kinks
        {
          const Voigt<dim> next = at - share * step;
          auto there = inner->trial(next);
          const Voigt<dim> left = residual(strain, next, there.stress);
          if (left.norm() < missing.norm() || share < 0.1)
            {
              at = next;
              response = std::move(there);
              missing = left;
              break;
            }
        }
    }
  throw fem::PointFailure("no strain of a softening RVE fits that of its element");
}

template <int dim>
fem::MaterialResponse<dim> SofteningPoint<dim>::trial(const Voigt<dim>& strain) const
{
  const Found& at = find(strain);
  if (!at_work.localised || scale == 1.0)
    return at.response;
  // dσ/dε = C (I - (1 - κ) S_0 C)⁻¹ κ
  const auto& C = at.response.tangent;
  return {at.response.stress, scale * C * gradient(C).inverse()};
}

template <int dim>
std::size_t SofteningPoint<dim>::relax(const Voigt<dim>& strain)
{
  if (scale == 1.0)
    {
      const std::size_t n_events = inner->relax(strain);
      if (n_events > 0)
        {
          found.reset();
          check_localisation(strain, find(strain).response.stress);
        }
      return n_events;
    }
  std::size_t n_events = 0;
  Voigt<dim> at = find(strain).rve_strain;
  Stiffness<dim> tangent = found->response.tangent; // one event changes it little
  bool relation_holds = true;
  std::optional<Held> first;
  std::optional<Held> last;
  for (;;)
    {
      const bool had_localised = at_work.localised;
      const Voigt<dim> stress_before = found ? found->response.stress : Voigt<dim>::Zero();
      const auto events = inner->relax_once(at);
      n_events += events.n;
      if (events.n == 0 && relation_holds)
        {
          if (first)
            at_work.gained_while_held += gained(*first, *last, *found);
          return n_events;
        }
      if (events.n > 0)
        {
          found.reset();
          check_localisation(strain, events.stress);
          if (at_work.localised)
            {
              last = {at, events.stress, total_energy(*inner)};
              if (!first) // the event itself leaves the total as it is
                first = {at, had_localised ? stress_before : events.stress, last->energy};
            }
        }
      if (!at_work.localised)
        continue;
      if (events.n > 0)
        {
          at -= gradient(tangent).partialPivLu().solve(residual(strain, at, events.stress));
          nearby = at;
          relation_holds = false;
        }
      else
        {
          at = find(strain).rve_strain;
          tangent = found->response.tangent;
          relation_holds = true;
        }
    }
}

/// The gain of the scaled energies of the piece between two states at one of its strains: those of the RVE do, along
/// a straight way from its last event, and count 1/κ times but for the elastic one.
template <int dim>
double SofteningPoint<dim>::gained(const Held& first, const Held& last, const Found& now) const
{
  const Voigt<dim>& stress = now.response.stress;
  const double of_rve = last.energy - first.energy + 0.5 * (last.stress + stress).dot(now.rve_strain - last.rve_strain);
  const double elastic = elastic_energy(stress) - elastic_energy(first.stress);
  return elastic + (of_rve - elastic) / scale;
}

template <int dim>
void SofteningPoint<dim>::check_localisation(const Voigt<dim>& strain, const Voigt<dim>& stress)
{
  if (at_work.localised || (stress - accepted.stress).dot(strain - accepted.strain) >= 0.0)
    return;
  at_work.localised = true;
  at_work.inelastic_strain = strain - compliance * stress;
  at_work.energies = inner->energies().value_or(fem::PointEnergies{});
  at_work.elastic_energy = elastic_energy(stress);
  at_work.elastic_strain = (compliance * stress).norm();
  nearby = strain;
}

template <int dim>
void SofteningPoint<dim>::accept(const Voigt<dim>& strain)
{
  const Found at = find(strain);
  inner->accept(at.rve_strain);
  at_work.strain = strain;
  at_work.rve_strain = nearby = at.rve_strain;
  at_work.stress = at.response.stress;
  accepted = at_work;
  found.reset();
}

template <int dim>
void SofteningPoint<dim>::reject()
{
  inner->reject();
  at_work = accepted;
  nearby = accepted.rve_strain;
  found.reset();
}

template <int dim>
struct SofteningPoint<dim>::Stored
{
  State state;
  std::string rve;

  template <typename Archive>
  friend void transfer(Archive& archive, Stored& stored)
  {
    State& written = stored.state;
    for (auto* const columns : {&written.strain, &written.rve_strain, &written.stress, &written.inelastic_strain})
      for (double& component : *columns)
        archive.value("strains_and_stress", component);
    transfer_flag(archive, "localised", written.localised);
    archive.value("energies", written.energies);
    archive.value("elastic_energy", written.elastic_energy);
    archive.value("elastic_strain", written.elastic_strain);
    archive.value("gained_while_held", written.gained_while_held);
    archive.text("rve", stored.rve);
  }
};

template <int dim>
std::string SofteningPoint<dim>::stored() const
{
  return to_bytes(Stored{accepted, inner->stored()});
}

template <int dim>
void SofteningPoint<dim>::restore(const std::string& stored)
{
  auto [state, rve] = from_bytes<Stored>(stored);
  inner->restore(rve);
  accepted = state;
  reject();
}

template <int dim>
std::vector<double> SofteningPoint<dim>::fields() const
{
  std::vector<double> values = inner->fields();
  const Voigt<dim> since = accepted.strain - compliance * accepted.stress - accepted.inelastic_strain;
  values.push_back(accepted.localised && since.norm() > accepted.elastic_strain ? 1.0 : 0.0);
  return values;
}

/// Cracks release as many times the energy as energies() has it.
template <int dim>
std::vector<fem::PointCrack<dim>> SofteningPoint<dim>::cracks_of_last_step() const
{
  auto cracks = inner->cracks_of_last_step();
  if (cracks.empty() || !accepted.localised)
    return cracks;
  double since = inner->energies().value_or(fem::PointEnergies{}).released - accepted.energies.released;
  for (auto crack = cracks.rbegin(); crack != cracks.rend() && since > 0.5 * crack->released_density; ++crack)
    {
      since -= crack->released_density;
      crack->released_density /= scale;
    }
  return cracks;
}

template <int dim>
std::optional<fem::PointEnergies> SofteningPoint<dim>::energies() const
{
  auto all = inner->energies();
  if (!all || !accepted.localised)
    return all;
  const fem::PointEnergies& then = accepted.energies;
  const double elastic = elastic_energy(accepted.stress) - accepted.elastic_energy;
  const auto scaled = [this](const double now, const double before, const double unscaled) {
    return before + unscaled + (now - before - unscaled) / scale;
  };
  return fem::PointEnergies{scaled(all->stored, then.stored, elastic), scaled(all->slip, then.slip, 0.0),
                            scaled(all->released, then.released, 0.0) - accepted.gained_while_held,
                            scaled(all->settled, then.settled, 0.0)};
}

template <int dim>
fem::Material<dim> scaled_softening(const fem::Material<dim>& rves, const double size)
{
  fem::Material<dim> material;
  material.field_names = rves.field_names;
  material.field_names.push_back("localised_share");
  material.make_point = [make = rves.make_point,
                         size](const fem::PointPlace& place) -> std::unique_ptr<fem::MaterialPoint<dim>> {
    return std::make_unique<SofteningPoint<dim>>(make(place), std::min(1.0, place.element_size / size));
  };
  return material;
}

template class SofteningPoint<2>;
template class SofteningPoint<3>;
template fem::Material<2> scaled_softening<2>(const fem::Material<2>&, double);
template fem::Material<3> scaled_softening<3>(const fem::Material<3>&, double);
} // namespace feldspar
