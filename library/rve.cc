#include "app/programme/checks.h"
#include "base/byte_archive.h"
#include "base/checksum/fingerprint.h"
#include "coupling/rve/state_archive.h"
#include "coupling/sample/realisation.h"
#include "library/states.h"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <map>
#include <mutex>

namespace feldspar::v1
{
namespace
{
template <int dim>
using Network = std::shared_ptr<const feldspar::Network<dim>>;

template <int dim>
using Cell = RepresentativeVolume<dim>;

/// The input of representative volumes.
feldspar::Input input_of_rve(const Input& input, const Specimen& specimen)
{
  feldspar::Input wanted = input.state().read();
  wanted.specimen.dimension = unsigned(specimen.dimension());
  check_equilibria(wanted.specimen, "take another law");
  check_boundary(wanted);
  return wanted;
}

/// A number that two cells hardly share: boundary, grains, stiffness, bonds.
template <int dim>
std::uint64_t fingerprint_of(const feldspar::Network<dim>& network)
{
  Fingerprint print;
  const auto add = [&](const double value) { print.add(std::bit_cast<std::uint64_t>(value)); };
  print.add(name(network.boundary()));
  for (const Vector<dim>& position : network.positions())
    for (const double coordinate : position)
      add(coordinate);
  for (const double stiffness : network.intact_stiffness().reshaped())
    add(stiffness);
  for (std::uint32_t segment = 0; segment < network.n_segments(); ++segment)
    {
      add(network.bond(segment).tensile_strength);
      add(network.bond(segment).cohesion);
    }
  return print.value();
}

template <int dim>
Network<dim> network_of(const feldspar::Specimen<dim>& specimen, const feldspar::Input& input)
{
  if (!specimen.is_periodic())
    throw InputError("the specimen stands between walls; a representative volume needs Specimen/Shape = periodic");
  return std::make_shared<const feldspar::Network<dim>>(specimen, Tensor<dim>::Identity(), input.boundary);
}

template <typename Vector>
std::vector<double> values_of(const Vector& vector)
{
  return {vector.data(), vector.data() + vector.size()};
}

/// A symmetric or not, rows first.
template <typename Matrix>
std::vector<double> rows_of(const Matrix& matrix)
{
  std::vector<double> values;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    for (Eigen::Index j = 0; j < matrix.cols(); ++j)
      values.push_back(matrix(i, j));
  return values;
}

template <int dim>
Voigt<dim> strain_of(const std::span<const double> values)
{
  if (values.size() != n_voigt<dim>)
    throw InputError(fmt::format("a strain has {} components; in {} dimensions there must be {}: {}", values.size(),
                                 dim, n_voigt<dim>, dim == 2 ? "xx, yy, xy" : "xx, yy, zz, yz, xz, xy"));
  const Voigt<dim> strain = Eigen::Map<const Voigt<dim>>(values.data());
  if (!(strain.array().abs() <= largest_strain).all()) // nor is what is not a number
    throw InputError(fmt::format("a strain has a component that is not in [-{0}, {0}]", largest_strain));
  return strain;
}

template <int dim>
feldspar::Trial<dim> answer(const Cell<dim>& cell, const Voigt<dim>& strain, const Bonds bonds, const bool with_tangent,
                            const Check& check)
{
  TrialOptions<dim> options;
  options.bonds = bonds;
  options.with_tangent = with_tangent;
  options.gives_up = check;
  return cell.trial(strain_control<dim>(strain), options);
}

template <int dim>
std::size_t broken(const NetworkState<dim>& state)
{
  return state.n_tension_breaks + state.n_shear_breaks;
}
} // namespace

class RveState
{
public:
  using AnyCell = std::variant<Cell<2>, Cell<3>>;

  explicit RveState(AnyCell of_specimen)
    : cell(std::move(of_specimen))
  {
  }

  /// Use by one thread at a time.
  template <typename Use>
  auto alone(const Use& use)
  {
    const std::lock_guard lock(one_at_a_time);
    return guarded([&] { return std::visit(use, cell); });
  }

  AnyCell copied()
  {
    return alone([](const auto& own) { return AnyCell(own); });
  }

private:
  AnyCell cell;
  std::recursive_mutex one_at_a_time; // a signal's handler may ask again
};

bool Trial::in_equilibrium() const
{
  return std::visit([](const auto& trial) { return trial.in_equilibrium; }, of->trial);
}

std::vector<double> Trial::strain() const
{
  return std::visit([](const auto& trial) { return values_of(trial.state.strain); }, of->trial);
}

std::vector<double> Trial::stress() const
{
  return std::visit([](const auto& trial) { return values_of(trial.state.stress); }, of->trial);
}

std::vector<double> Trial::tangent() const
{
  return std::visit(
    [](const auto& trial) { return trial.tangent ? rows_of(trial.tangent->value) : std::vector<double>(); }, of->trial);
}

std::size_t Trial::n_breaks() const
{
  return std::visit([](const auto& trial) { return trial.breaks.size(); }, of->trial);
}

Rve::Rve(const Specimen& specimen, const Input& input)
  : of(guarded([&] {
    const feldspar::Input wanted = input_of_rve(input, specimen);
    return std::visit(
      [&]<int dim>(const feldspar::Specimen<dim>& body) {
        return std::make_unique<RveState>(Cell<dim>(network_of(body, wanted), wanted.equilibrium));
      },
      specimen.state().body);
  }))
{
}

Rve::Rve(const Rve& other)
  : of(std::make_unique<RveState>(other.of->copied()))
{
}

Rve& Rve::operator=(const Rve& other)
{
  of = std::make_unique<RveState>(other.of->copied());
  return *this;
}

Rve::~Rve() = default;

int Rve::dimension() const
{
  return of->alone([]<int dim>(const Cell<dim>&) { return dim; });
}

std::vector<double> Rve::stiffness() const
{
  return of->alone([](const auto& cell) { return rows_of(cell.network().intact_stiffness()); });
}

std::vector<double> Rve::strain() const
{
  return of->alone([](const auto& cell) { return values_of(cell.state().strain); });
}

std::vector<double> Rve::stress() const
{
  return of->alone([](const auto& cell) { return values_of(cell.state().stress); });
}

bool Rve::is_intact() const
{
  return of->alone([](const auto& cell) { return cell.state().intact; });
}

std::size_t Rve::n_broken() const
{
  return of->alone([](const auto& cell) { return broken(cell.state()); });
}

namespace
{
std::shared_ptr<TrialState> trial_of(RveState& state, const std::span<const double> strain, const Bonds bonds,
                                     const bool with_tangent, const Check& check)
{
  return state.alone([&]<int dim>(const Cell<dim>& cell) {
    return std::make_shared<TrialState>(
      TrialState{answer<dim>(cell, strain_of<dim>(strain), bonds, with_tangent, check), &cell.network()});
  });
}
} // namespace

Trial Rve::trial(const std::span<const double> strain, const bool with_tangent, const Check& check) const
{
  Trial trial;
  trial.of = trial_of(*of, strain, Bonds::frozen, with_tangent, check);
  return trial;
}

Trial Rve::relax(const std::span<const double> strain, const bool with_tangent, const Check& check) const
{
  Trial trial;
  trial.of = trial_of(*of, strain, Bonds::may_break, with_tangent, check);
  return trial;
}

void Rve::accept(const Trial& trial)
{
  of->alone([&]<int dim>(Cell<dim>& cell) {
    if (trial.of->network != &cell.network())
      throw InputError("the trial is of another cell; a volume accepts its own trials and those of its copies");
    if (!trial.in_equilibrium())
      throw InputError("no equilibrium was found at this strain; take a smaller step from the accepted state");
    cell.accept(feldspar::Trial<dim>(std::get<feldspar::Trial<dim>>(trial.of->trial)));
  });
}

double Rve::first_break(const std::span<const double> direction) const
{
  return of->alone([&]<int dim>(const Cell<dim>& cell) {
    if (direction.size() != n_voigt<dim> ||
        !std::ranges::all_of(direction, [](const double component) { return std::isfinite(component); }))
      throw InputError(fmt::format("a direction must have {} finite components in {} dimensions", n_voigt<dim>, dim));
    return cell.network().first_break(Eigen::Map<const Voigt<dim>>(direction.data())).factor;
  });
}

namespace
{
std::uint64_t fingerprint_of(const std::string& bytes)
{
  Fingerprint print;
  print.add(bytes);
  return print.value();
}

/// A state, with the fingerprints of its cell and of its bytes.
struct StoredState
{
  std::uint64_t cell = 0;
  std::uint64_t content = 0;
  std::string bytes;
};

template <typename Archive>
void transfer(Archive& archive, StoredState& stored)
{
  archive.value("cell", stored.cell);
  archive.value("content", stored.content);
  archive.text("bytes", stored.bytes);
}
} // namespace

std::string Rve::state() const
{
  return of->alone([](const auto& cell) {
    const std::string bytes = to_bytes(cell.state());
    return to_bytes(StoredState{fingerprint_of(cell.network()), fingerprint_of(bytes), bytes});
  });
}

void Rve::restore(const std::string& state)
{
  of->alone([&]<int dim>(Cell<dim>& cell) {
    const auto stored = from_bytes<StoredState>(state);
    if (fingerprint_of(stored.bytes) != stored.content)
      throw InputError("a stored state was changed since it was stored");
    if (fingerprint_of(cell.network()) != stored.cell)
      throw InputError("a stored state is of another cell");
    cell.restore(from_bytes<NetworkState<dim>>(stored.bytes));
  });
}

namespace
{
/// All volumes at one moment. Of an intact one its strain says everything.
template <int dim>
struct Moment
{
  std::vector<std::shared_ptr<const NetworkState<dim>>> damaged; ///< null: intact; [n], or none where all are
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
                       const std::span<double> stresses, const std::span<double> tangents, const Check& check)
  {
    constexpr std::size_t n = n_voigt<dim>;
    if (strains.size() != n * size() || stresses.size() != n * size() ||
        (!tangents.empty() && tangents.size() != n * n * size()))
      throw InputError(fmt::format("{} volumes in {} dimensions have {} x {} strains and stresses and {} x {} x {} "
                                   "tangents; {}, {} and {} numbers were given",
                                   size(), dim, size(), n, size(), n, n, strains.size(), stresses.size(),
                                   tangents.size()));
    const Moment<dim>& from = moment(parent);
    Moment<dim> outcome{std::vector<std::shared_ptr<const NetworkState<dim>>>(size()), parent};
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
              auto trial = answer<dim>(cell, strain, Bonds::may_break, !tangents.empty(), check);
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
          std::copy(stress.begin(), stress.end(), stresses.begin() + std::ptrdiff_t(n * k));
        }
    });
    if (first_failure < size())
      throw InputError(fmt::format("volume {} finds no equilibrium at its strain; take a smaller step", first_failure));
    if (std::none_of(outcome.damaged.begin(), outcome.damaged.end(), [](const auto& state) { return bool(state); }))
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
      throw InputError(
        fmt::format("token {} is not known: it was never handed out, or a later state has taken its place", token));
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
      throw InputError(
        fmt::format("{} volumes have {} specimens assigned to them; there must be one each", n, assigned.size()));
    std::vector<std::size_t> of_volumes(assigned.begin(), assigned.end());
    of_volumes.resize(n, 0);
    if (std::any_of(of_volumes.begin(), of_volumes.end(), [&](const std::size_t k) { return k >= specimens.size(); }))
      throw InputError(
        fmt::format("a volume has a specimen that is not there; they are numbered from 0 to {}", specimens.size() - 1));
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
                              const std::span<double> stresses, const std::span<double> tangents, const Check& check)
{
  const std::lock_guard lock(of->one_at_a_time);
  return guarded([&] {
    return std::visit([&](auto& answers) { return answers.update(strains, parent, stresses, tangents, check); },
                      of->answers);
  });
}

std::vector<std::size_t> Volumes::n_broken(const std::uint64_t token) const
{
  const std::lock_guard lock(of->one_at_a_time);
  return guarded([&] { return std::visit([&](const auto& answers) { return answers.n_broken(token); }, of->answers); });
}
} // namespace feldspar::v1
