#include "fem/solid/newton.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace feldspar::fem
{
using namespace dealii;

namespace
{
template <int dim, int material_dim>
class NewtonSearch
{
public:
  using State = SolidState<material_dim>;

  NewtonSearch(SolidBody<dim, material_dim>& its_body, const SolidParameters& its_parameters,
               PETScWrappers::MPI::SparseMatrix& its_matrix, const std::function<void()>& its_round_done,
               SolidConstraints its_constraints)
    : body(its_body)
    , elements(body.elements)
    , parameters(its_parameters)
    , matrix(its_matrix)
    , round_done(its_round_done)
    , constraints(std::move(its_constraints))
    , axial(DoFTools::extract_dofs(elements.dof_handler, only<dim>(dim - 1)))
    , right_side(elements.owned_vector())
  {
  }

  NewtonOutcome<material_dim> run(const State& start)
  {
    tried = start;
    tried.stress_drops.assign(tried.responses.size(), StressVector<material_dim>::Zero());
    NewtonReport report;
    const auto failed = [&](const std::string& why) {
      report.failure = why;
      return NewtonOutcome<material_dim>{report, tried};
    };
    const std::vector<bool> held = held_by(constraints.standing);
    BoundaryWork work; // of this rank
    std::optional<PathVertex> vertex = vertex_of(start);
    bool boundary_moves = !constraints.following;
    unsigned int n_iterations_left = parameters.most_iterations;
    const CarriedForce before = carried_by(start);
    for (;;)
      {
        const NodalForces forces = body.forces(tried, constraints.standing);
        tried.internal_force = forces.internal;
        tried.external_force = forces.external;
        right_side = forces.unbalanced;
        if (!vertex)
          vertex = vertex_of(tried);
        const double unbalanced = right_side.l2_norm();
        // The unbalanced force is measured by the forces of this state, never by those of an earlier iterate, which may
        // be far from equilibrium. A body that is being unloaded carries little in the end: the forces of the accepted
        // state before count if they are larger.
        const CarriedForce now = carried_by(tried);
        const CarriedForce carried{std::max(now.norm, before.norm), std::max(now.along_axis, before.along_axis)};
        report.residuals.push_back(carried.norm > 0.0 ? unbalanced / carried.norm : 0.0);
        if (!std::isfinite(unbalanced))
          return failed("the unbalanced force is not finite");

        const bool is_balanced = unbalanced <= parameters.newton_tolerance * carried.norm &&
                                 unbalanced_resultant() <= parameters.newton_tolerance * carried.along_axis;
        if (!boundary_moves && is_balanced && follows())
          {
            work += work_between(*vertex, vertex_of(tried), held);
            vertex.reset();
            // Equilibrium with the structure of every point frozen. Does it hold?
            const auto n_events = relax_points();
            if (!n_events)
              return failed("a material point found no stable structure");
            report.n_events += *n_events;
            if (*n_events == 0)
              {
                report.converged = true;
                tried.work += sum(work, elements.communicator());
                return {report, tried};
              }
            ++report.n_cascades;
            if (report.n_events > parameters.most_events)
              return failed(fmt::format("more than {} events", parameters.most_events));
            if (report.n_cascades >= parameters.most_cascades)
              return failed(fmt::format("still unstable after {} cascades", report.n_cascades));
            const auto responses_before = std::exchange(tried.responses, {});
            if (!update_points())
              return failed("a material point has no response to its strain");
            for (std::size_t i = 0; i < responses_before.size(); ++i)
              tried.stress_drops[i] += responses_before[i].stress - tried.responses[i].stress;
            n_iterations_left = parameters.most_iterations;
            parameters.watch(report);
            continue;
          }

        if (n_iterations_left-- == 0)
          return failed(fmt::format("no equilibrium after {} iterations", parameters.most_iterations));
        const std::optional<NodalVector> correction =
          constraints.following ? following_correction(*constraints.following)
                                : correction_by(boundary_moves ? constraints.first : constraints.standing);
        if (!correction)
          return failed("the tangent is singular or the linear solver did not converge");
        ++report.n_iterations;
        const double share = correct(*correction);
        if (share == 0.0)
          return failed("a material point has no response to its strain");
        if (boundary_moves)
          {
            for (const auto& line : constraints.standing.get_lines())
              constraints.first.set_inhomogeneity(line.index,
                                                  (1.0 - share) * constraints.first.get_inhomogeneity(line.index));
            boundary_moves = share < 1.0;
          }
        parameters.watch(report);
      }
  }

private:
  /// The forces that a state carries, by which those that are unbalanced are measured [N].
  struct CarriedForce
  {
    double norm;       ///< of the internal or external forces, whichever is larger
    double along_axis; ///< from end to end, which is the last coordinate; at least the norm
  };

  CarriedForce carried_by(const State& state) const
  {
    const double norm = std::max(state.internal_force.l2_norm(), state.external_force.l2_norm());
    double of_both_ends = 0.0;
    for (const double force : entries(state.internal_force, axial))
      of_both_ends += std::abs(force);
    return {norm, std::max(norm, 0.5 * Utilities::MPI::sum(of_both_ends, elements.communicator()))};
  }

  /// The sum of the unbalanced forces along the axis: the difference between the forces of the two ends [N].
  double unbalanced_resultant() const
  {
    const std::vector<double> forces = entries(right_side, axial);
    return std::abs(Utilities::MPI::sum(std::accumulate(forces.begin(), forces.end(), 0.0), elements.communicator()));
  }

  PathVertex vertex_of(const State& state) const
  {
    const auto of_rank = [&](const NodalVector& vector) { return entries(vector, elements.owned); };
    return {of_rank(state.displacement), of_rank(state.internal_force), of_rank(state.external_force)};
  }

  /// Returns which degrees of freedom of this rank have a prescribed displacement; those of a free plate have none.
  std::vector<bool> held_by(const AffineConstraints<double>& standing) const
  {
    std::vector<bool> held;
    for (const auto dof : elements.owned)
      {
        const auto* const others = standing.get_constraint_entries(dof);
        held.push_back(others != nullptr && others->empty());
      }
    return held;
  }

  /// Outcome of a round over the points of all ranks: the worst of any, which is the last in this list.
  enum class Round
  {
    answered,
    failed, ///< a point had no response
    left    ///< before all were asked
  };

  template <typename Work>
  Round over_points(const Work& work)
  {
    Round round = Round::answered;
    try
      {
        work();
      }
    catch (const PointFailure&)
      {
        round = Round::failed;
      }
    catch (const GivenUp&)
      {
        round = Round::left;
      }
    round_done();
    round = Round(Utilities::MPI::max(int(round), elements.communicator()));
    if (round == Round::left)
      parameters.watch({});
    return round;
  }

  /// Updates the points; returns false where a point of any rank has no response.
  bool update_points()
  {
    return over_points([&] { tried.responses = body.materials.trial(tried.strains, parameters.gives_up); }) ==
           Round::answered;
  }

  /// Returns the number of events of all ranks; nothing where a point of any found no stable structure.
  std::optional<std::uint64_t> relax_points()
  {
    std::uint64_t n_events = 0;
    if (over_points([&] { n_events = body.materials.relax(tried.strains, parameters.gives_up); }) != Round::answered)
      return {};
    return Utilities::MPI::sum(n_events, elements.communicator());
  }

  bool tangents_are_symmetric() const
  {
    const bool symmetric = std::ranges::all_of(tried.responses, [](const auto& response) {
      constexpr double round_off = 1e-10;
      const auto& C = response.tangent;
      return (C - C.transpose()).cwiseAbs().maxCoeff() <= round_off * C.cwiseAbs().maxCoeff();
    });
    return Utilities::MPI::min(int(symmetric), elements.communicator()) == 1;
  }

  /// Applies as much of a correction as all points have a response to, halved down to a sixteenth. Returns the share; 0
  /// if there is no response.
  double correct(const NodalVector& correction)
  {
    const NodalVector before = tried.displacement;
    for (double share = 1.0; share > 0.05; share *= 0.5)
      {
        NodalVector displacement = elements.owned_vector();
        displacement = before;
        displacement.add(share, correction);
        tried.displacement = displacement;
        tried.strains = body.strains_of(tried.displacement);
        if (update_points())
          return share;
      }
    return 0.0;
  }

  /// Returns the next correction under constraints; empty where there is none.
  std::optional<NodalVector> correction_by(const AffineConstraints<double>& of_correction)
  {
    body.assemble_tangent(tried, of_correction, matrix, right_side);
    NodalVector correction = elements.owned_vector();
    if (!solve_linear(parameters.linear_solver, tangents_are_symmetric(), matrix, correction, right_side, dim,
                      parameters.linear_tolerance))
      return {};
    of_correction.distribute(correction);
    return correction;
  }

  /// Returns the mixture of two corrections, with the plate standing and moved by a metre, for which the boundaries sweep
  /// the wanted amount.
  std::optional<NodalVector> following_correction(const SolidConstraints::Following& following)
  {
    std::optional<NodalVector> standing = correction_by(constraints.standing);
    if (!standing)
      return {};
    std::optional<NodalVector> moved = correction_by(following.unit_of_plate); // adds to the same unbalanced force
    if (!moved)
      return {};
    *moved -= *standing;
    const double missing = following.swept_wanted - swept_by(tried.displacement) - swept_by(*standing);
    const double distance = missing / swept_by(*moved);
    if (!std::isfinite(distance))
      return {};
    standing->add(distance, *moved);
    return standing;
  }

  /// Amount that the following boundaries sweep by a displacement; any vector, with or without ghosts.
  double swept_by(const NodalVector& displacement) const
  {
    NodalVector with_ghosts = elements.ghosted_vector();
    with_ghosts = displacement;
    return elements.swept_volume(constraints.following->boundaries, with_ghosts);
  }

  /// Returns whether the plate that follows has moved as far as wanted.
  bool follows() const
  {
    constexpr double tolerance = 1e-6; // of the way
    const auto& following = constraints.following;
    return !following || std::abs(swept_by(tried.displacement) - following->swept_wanted) <=
                           tolerance * std::abs(following->swept_wanted - following->swept_before);
  }

  SolidBody<dim, material_dim>& body;
  const Discretisation<dim>& elements;
  const SolidParameters& parameters;
  PETScWrappers::MPI::SparseMatrix& matrix;
  const std::function<void()>& round_done;
  SolidConstraints constraints;

  IndexSet axial; ///< the degrees of freedom of this rank along the axis
  State tried;
  NodalVector right_side; ///< unbalanced force on what is free to move
};
} // namespace

template <int dim, int material_dim>
NewtonOutcome<material_dim> find_equilibrium(SolidBody<dim, material_dim>& body, const SolidParameters& parameters,
                                             PETScWrappers::MPI::SparseMatrix& matrix,
                                             const std::function<void()>& round_done, SolidConstraints constraints,
                                             const SolidState<material_dim>& start)
{
  return NewtonSearch<dim, material_dim>(body, parameters, matrix, round_done, std::move(constraints)).run(start);
}

template decltype(find_equilibrium<2, 2>) find_equilibrium<2, 2>;
template decltype(find_equilibrium<2, 3>) find_equilibrium<2, 3>;
template decltype(find_equilibrium<3, 3>) find_equilibrium<3, 3>;
} // namespace feldspar::fem
