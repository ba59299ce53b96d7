#include "base/byte_archive.h"
#include "base/checksum/fingerprint.h"
#include "coupling/rve/homogenisation.h"
#include "coupling/rve/state_archive.h"
#include "library/cells.h"

#include <bit>
#include <cmath>
#include <mutex>

namespace feldspar::v1
{
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

Damage Rve::damage() const
{
  return of->alone([]<int dim>(const Cell<dim>& cell) {
    const NetworkState<dim>& state = cell.state();
    if (state.intact)
      return Damage{.crack_orientation = std::vector<double>(n_voigt<dim>, 0.0)};
    const auto n = double(cell.network().n_segments());
    const CrackMeasures<dim> cracks = crack_measures(cell.network(), state);
    return Damage{double(broken(state)) / n, double(state.n_shear_breaks) / n,
                  (state.work.slip + state.work.released + state.work.settled) / cell.network().volume(),
                  cracks.density, values_of(stress_voigt<dim>(cracks.orientation))};
  });
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
    cell.restore(std::get<feldspar::Trial<dim>>(trial.of->trial).state);
  });
}

double Rve::first_break(const std::span<const double> direction) const
{
  return of->alone([&]<int dim>(const Cell<dim>& cell) {
    if (direction.size() != n_voigt<dim> ||
        !std::ranges::all_of(direction, [](const double component) { return std::isfinite(component); }))
      throw InputError("a direction must have {} finite components in {} dimensions", n_voigt<dim>, dim);
    return cell.network().first_break(Eigen::Map<const Voigt<dim>>(direction.data())).factor;
  });
}

namespace
{
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
} // namespace feldspar::v1
