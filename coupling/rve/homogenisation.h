#pragma once

#include "coupling/rve/equilibrium.h"
#include "dem/storage/segment_place.h"

#include <cstddef>

/// Transition from grains to the macroscopic scale: mean fields of a network; docs/theory.md §9.5.
namespace feldspar
{
/// σ = (1/V) Σ f ⊗ l over all links [Pa]; symmetric where couples balance (Love 1927, Weber 1966).
template <int dim>
Tensor<dim> branch_stress(const Network<dim>& network, const LinkForces<dim>& forces);

/// The same from what crosses the sides of the cell alone, (1/V) Σ f ⊗ (boxes crossed × edges) over links and the tractions
/// on open sides [Pa]. Equal where forces balance.
template <int dim>
Tensor<dim> boundary_stress(const Network<dim>& network, const BoundaryConditions<dim>& conditions,
                            const LinkForces<dim>& forces);

/// Forces carried by an RVE.
template <int dim>
struct BorneForces
{
  LinkForces<dim> of_links;
  Eigen::VectorXd of_boundary; ///< on grains, by the tractions of an open cell; empty where there are none
};

template <int dim>
BorneForces<dim> borne_forces(const Network<dim>& network, const Equilibrium<dim>& at);

/// Hill and Mandel: |V σ̄ : Δε + r̄·Δu - Σ s̄·Δm| over the sum of the magnitudes, or over `least_work` [J] if that is more,
/// between two states, with the mean of the works that the forces of each would do on the motions m of links as they stand
/// there. The forces r of the boundary do work on the motions u of the grains only where it lets go of a grain between the
/// two. Breaking and sliding do not enter: it only says how well forces balance.
template <int dim>
double hill_mandel_residual(const Network<dim>& network, const NetworkState<dim>& before,
                            const BorneForces<dim>& forces_before, const NetworkState<dim>& after,
                            const BorneForces<dim>& forces_after, double least_work = 0.0);

/// Mean of n ⊗ n over the joints; its trace is 1 (Oda 1982).
template <int dim>
Tensor<dim> fabric(const Network<dim>& network);

/// The place of a segment of a joint, with its grains at rest, in the cell's box or just outside.
template <int dim>
SegmentPlace<dim> segment_place(const Network<dim>& network, std::size_t joint, std::size_t segment);

/// Measures of the broken segments.
template <int dim>
struct CrackMeasures
{
  double area_share;       ///< area of broken segments over that of all
  double density;          ///< area of broken segments over volume [1/m]
  Tensor<dim> orientation; ///< Σ area n ⊗ n over volume [1/m]; its trace is the density (Kachanov 1980, Oda 1982)
};

/// Segments without a bond from the start are no cracks.
template <int dim>
CrackMeasures<dim> crack_measures(const Network<dim>& network, const NetworkState<dim>& state);

/// Number of bodies of two grains or more that are connected by segments with bonds; a body that spans the cell is one.
template <int dim>
std::size_t n_fragments(const Network<dim>& network, const NetworkState<dim>& state);

/// The isotropic stiffness nearest to one, and how far off it is.
struct IsotropicConstants
{
  double bulk_modulus;   ///< [Pa]; in the plane that of plane strain
  double shear_modulus;  ///< [Pa]
  double youngs_modulus; ///< [Pa]; in the plane that of the free plane, 4KG/(K + G)
  double poissons_ratio; ///< in the plane (K - G)/(K + G)
  double anisotropy;     ///< |C - C_iso| over |C|, Frobenius in Mandel's components
};

template <int dim>
IsotropicConstants isotropic_constants(const Stiffness<dim>& stiffness);
} // namespace feldspar
