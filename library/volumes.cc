#include "library/cells.h"

#include <oneapi/tbb/parallel_for.h>

#include <atomic>
#include <map>
#include <mutex>

namespace feldspar::v1
{
namespace
{
/// All volumes at one moment. The state of an intact one follows from its strain.
template <int dim>
struct Moment
{
  std::vector<std::shared_ptr<const NetworkState<dim>>> damaged; ///< null: intact; [n], or none where all are
  std::vector<double> strains;                                   ///< [n × n_voigt], or none at rest
  std::uint64_t parent = ~std::uint64_t(0);                      ///< token of the state it came of; of rest none
};

template <int dim>
class Answers
{
public:
  Answers() = default;
  Answers(std::vector<Network<dim>> of_realisations, std::vector<std::size_t> of_volumes,
          const EquilibriumParameters& wanted)
    : networks(std::move(of_realisations))
    , assigned(std::move(of_volumes))
    , parameters(wanted)
  {
    moments[0] = {};
  }

  std::size_t size() const { return assigned.size(); }

  std::uint64_t update(const std::span<const double> strains, const std::uint64_t parent,
                       const std::span<double> stresses, const std::span<double> tangents, const Bonds bonds,
                       const Check& check)
  {
    constexpr std::size_t n = n_voigt<dim>;
    if (strains.size() != n * size() || stresses.size() != n * size() ||
        (!tangents.empty() && tangents.size() != n * n * size()))
      throw InputError("{} volumes in {} dimensions have {} x {} strains and stresses and {} x {} x {} "
                       "tangents; {}, {} and {} numbers were given",
                       size(), dim, size(), n, size(), n, n, strains.size(), stresses.size(), tangents.size());
    const Moment<dim>& from = moment(parent);
    Moment<dim> outcome{std::vector<std::shared_ptr<const NetworkState<dim>>>(size()),
                        {strains.begin(), strains.end()},
                        parent};
    std::atomic<std::size_t> first_failure = size();
    constexpr std::size_t at_a_time = 16; // intact volumes need a few hundred nanoseconds each
    oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, size(), at_a_time), [&](const auto& range) {
      leave_if(check);
      for (std::size_t k = range.begin(); k < range.end(); ++k)
        {
          const Voigt<dim> strain = strain_of<dim>(strains.subspan(n * k, n));
          const feldspar::Network<dim>& network = *networks[assigned[k]];
          Voigt<dim> stress;
          const NetworkState<dim>* const before = from.damaged.empty() ? nullptr : from.damaged[k].get();
          if (!before && network.unbonded().empty() && network.stays_intact(strain))
            {
              stress = network.intact_stiffness() * strain;
              if (!tangents.empty())
                write(network.intact_stiffness(), tangents.subspan(n * n * k, n * n));
            }
          else
            {
              Cell<dim> cell(networks[assigned[k]], parameters);
              if (before)
                cell.restore(*before);
              else if (!from.strains.empty()) // the bits of an equilibrium depend on where the search for it begins
                cell.restore(answer<dim>(cell, strain_of<dim>(std::span(from.strains).subspan(n * k, n)), Bonds::frozen,
                                         false, check)
                               .state);
              auto trial = answer<dim>(cell, strain, bonds, !tangents.empty(), check);
              if (!trial.in_equilibrium)
                {
                  for (std::size_t first = first_failure; k < first && !first_failure.compare_exchange_weak(first, k);)
                    ;
                  continue;
                }
              stress = trial.state.stress;
              if (!tangents.empty())
                write(trial.tangent->value, tangents.subspan(n * n * k, n * n));
              if (!trial.state.intact)
                outcome.damaged[k] = std::make_shared<const NetworkState<dim>>(std::move(trial.state));
            }
          std::ranges::copy(stress, stresses.begin() + std::ptrdiff_t(n * k));
        }
    });
    if (first_failure < size())
      throw InputError("volume {} finds no equilibrium at its strain; take a smaller step", first_failure);
    if (std::ranges::none_of(outcome.damaged, [](const auto& state) { return bool(state); }))
      outcome.damaged = {};
    accept(parent);
    moments.emplace(++last, std::move(outcome));
    return last;
  }

  std::vector<std::size_t> n_broken(const std::uint64_t token) const
  {
    std::vector<std::size_t> n(size(), 0);
    const auto& damaged = moment(token).damaged;
    for (std::size_t k = 0; k < damaged.size(); ++k)
      if (damaged[k])
        n[k] = broken(*damaged[k]);
    return n;
  }

private:
  static void write(const Stiffness<dim>& tangent, const std::span<double> to)
  {
    std::copy_n(rows_of(tangent).begin(), to.size(), to.begin());
  }

  const Moment<dim>& moment(const std::uint64_t token) const
  {
    const auto found = moments.find(token);
    if (found == moments.end())
      throw InputError("token {} is not known: it was never handed out, or a later state has taken its place", token);
    return found->second;
  }

  /// Keeps a state that was built on, and what came of it. No state of these has been built on itself.
  void accept(const std::uint64_t token)
  {
    std::erase_if(moments, [&](const auto& one) { return one.first != token && one.second.parent != token; });
  }

  std::vector<Network<dim>> networks;
  std::vector<std::size_t> assigned;
  EquilibriumParameters parameters;
  std::map<std::uint64_t, Moment<dim>> moments;
  std::uint64_t last = 0;
};
} // namespace

class VolumesState
{
public:
  std::variant<Answers<2>, Answers<3>> answers;
  std::mutex one_at_a_time;
};

Volumes::Volumes(const std::span<const Specimen> specimens, const Input& input, const std::size_t n,
                 const std::span<const std::size_t> assigned)
  : of(guarded([&] {
    if (specimens.empty())
      throw InputError("volumes need at least one specimen");
    if (!assigned.empty() && assigned.size() != n)
      throw InputError("{} volumes have {} specimens assigned to them; there must be one each", n, assigned.size());
    std::vector<std::size_t> of_volumes(assigned.begin(), assigned.end());
    of_volumes.resize(n, 0);
    if (std::ranges::any_of(of_volumes, [&](const std::size_t k) { return k >= specimens.size(); }))
      throw InputError("a volume has a specimen that is not there; they are numbered from 0 to {}",
                       specimens.size() - 1);
    const feldspar::Input wanted = input_of_rve(input, specimens.front());
    const auto make = [&]<int dim>() {
      std::vector<Network<dim>> networks;
      for (const Specimen& specimen : specimens)
        if (const auto* const body = std::get_if<feldspar::Specimen<dim>>(&specimen.state().body))
          networks.push_back(network_of(*body, wanted));
        else
          throw InputError("the specimens of volumes must have one dimension");
      auto state = std::make_unique<VolumesState>();
      state->answers.template emplace<Answers<dim>>(std::move(networks), std::move(of_volumes), wanted.equilibrium);
      return state;
    };
    return specimens.front().dimension() == 2 ? make.template operator()<2>() : make.template operator()<3>();
  }))
{
}

Volumes::Volumes(Volumes&&) noexcept = default;
Volumes& Volumes::operator=(Volumes&&) noexcept = default;
Volumes::~Volumes() = default;

std::size_t Volumes::size() const
{
  return std::visit([](const auto& answers) { return answers.size(); }, of->answers);
}

int Volumes::dimension() const { return of->answers.index() == 0 ? 2 : 3; }

std::uint64_t Volumes::update(const std::span<const double> strains, const std::uint64_t parent,
                              const std::span<double> stresses, const std::span<double> tangents,
                              const bool bonds_break, const Check& check)
{
  const std::lock_guard lock(of->one_at_a_time);
  return guarded([&] {
    const Bonds bonds = bonds_break ? Bonds::may_break : Bonds::frozen;
    return std::visit([&](auto& answers) { return answers.update(strains, parent, stresses, tangents, bonds, check); },
                      of->answers);
  });
}

std::vector<std::size_t> Volumes::n_broken(const std::uint64_t token) const
{
  const std::lock_guard lock(of->one_at_a_time);
  return guarded([&] { return std::visit([&](const auto& answers) { return answers.n_broken(token); }, of->answers); });
}
} // namespace feldspar::v1
