#include "fem/solid/assembly.h"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/sparsity_tools.h>

namespace feldspar::fem
{
using namespace dealii;

namespace
{
template <int dim>
double pressure_on(const types::boundary_id boundary, const std::map<std::string, double>& pressures,
                   const SampleMesh<dim>& mesh)
{
  double pressure = 0.0;
  for (const auto& [name, value] : pressures)
    if (mesh.boundary(name) == boundary)
      pressure += value;
  return pressure;
}
} // namespace

template <int dim, int material_dim>
NodalForces assemble_forces(const Discretisation<dim>& elements, const std::vector<double>& volumes,
                            const SolidState<material_dim>& state, const AffineConstraints<double>& constraints)
{
  const auto& fe = elements.fe;
  FEValues<dim> values(elements.mapping, fe, elements.quadrature,
                       update_values | update_gradients | update_quadrature_points);
  FEFaceValues<dim> face_values(elements.mapping, fe, elements.face_quadrature,
                                update_values | update_normal_vectors | update_quadrature_points | update_JxW_values);
  const unsigned int n_dofs = fe.n_dofs_per_cell();
  Vector<double> internal(n_dofs);
  Vector<double> external(n_dofs);
  std::vector<types::global_dof_index> dofs(n_dofs);
  NodalForces forces{elements.owned_vector(), elements.owned_vector(), elements.owned_vector()};
  std::size_t point = 0;
  for (const auto& cell : elements.dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
      {
        values.reinit(cell);
        internal = 0.0;
        external = 0.0;
        for (const unsigned int q : values.quadrature_point_indices())
          {
            const double radius = values.quadrature_point(q)[0];
            for (const unsigned int i : values.dof_indices())
              internal[i] += strain_of<dim, material_dim>(elements.kinematics, fe.system_to_component_index(i).first,
                                                          values.shape_value(i, q), values.shape_grad(i, q), radius)
                               .dot(state.responses[point].stress) *
                             volumes[point];
            ++point;
          }
        for (const auto& face : cell->face_iterators())
          if (face->at_boundary())
            if (const double pressure = pressure_on(face->boundary_id(), state.pressures, elements.mesh);
                pressure != 0.0)
              {
                face_values.reinit(cell, face);
                for (const unsigned int q : face_values.quadrature_point_indices())
                  for (const unsigned int i : face_values.dof_indices())
                    external[i] -= pressure * face_values.normal_vector(q)[fe.system_to_component_index(i).first] *
                                   face_values.shape_value(i, q) * face_values.JxW(q) *
                                   weight(elements.kinematics, face_values.quadrature_point(q)[0]);
              }
        cell->get_dof_indices(dofs);
        forces.internal.add(dofs, internal);
        forces.external.add(dofs, external);
        external -= internal;
        constraints.distribute_local_to_global(external, dofs, forces.unbalanced);
      }
  for (NodalVector* const sum : {&forces.internal, &forces.external, &forces.unbalanced})
    sum->compress(VectorOperation::add);
  return forces;
}

template <int dim>
void set_pattern(PETScWrappers::MPI::SparseMatrix& matrix, const Discretisation<dim>& elements,
                 const AffineConstraints<double>& constraints)
{
  // A free plate ties nodes to one that may be of another rank.
  IndexSet rows = elements.relevant;
  for (const auto& line : constraints.get_lines())
    for (const auto& entry : line.entries)
      rows.add_index(entry.first);
  const auto n_dofs = elements.dof_handler.n_dofs();
  DynamicSparsityPattern pattern(n_dofs, n_dofs, rows);
  DoFTools::make_sparsity_pattern(elements.dof_handler, pattern, constraints, false);
  SparsityTools::distribute_sparsity_pattern(pattern, elements.owned, elements.communicator(), rows);
  matrix.reinit(elements.owned, elements.owned, pattern, elements.communicator());
}

template <int dim, int material_dim>
void assemble_tangent(const Discretisation<dim>& elements, const std::vector<double>& volumes,
                      const SolidState<material_dim>& state, const AffineConstraints<double>& constraints,
                      PETScWrappers::MPI::SparseMatrix& matrix, NodalVector& right_side)
{
  const auto& fe = elements.fe;
  FEValues<dim> values(elements.mapping, fe, elements.quadrature,
                       update_values | update_gradients | update_quadrature_points);
  const unsigned int n_dofs = fe.n_dofs_per_cell();
  FullMatrix<double> cell_matrix(n_dofs, n_dofs);
  Vector<double> no_force(n_dofs);
  Eigen::Matrix<double, n_voigt<material_dim>, Eigen::Dynamic> B(n_voigt<material_dim>, n_dofs);
  Eigen::MatrixXd stiffness(n_dofs, n_dofs);
  std::vector<types::global_dof_index> dofs(n_dofs);
  matrix = 0.0;
  std::size_t point = 0;
  for (const auto& cell : elements.dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
      {
        values.reinit(cell);
        stiffness.setZero();
        for (const unsigned int q : values.quadrature_point_indices())
          {
            const double radius = values.quadrature_point(q)[0];
            for (const unsigned int i : values.dof_indices())
              B.col(i) = strain_of<dim, material_dim>(elements.kinematics, fe.system_to_component_index(i).first,
                                                      values.shape_value(i, q), values.shape_grad(i, q), radius);
            stiffness.noalias() += B.transpose() * (state.responses[point].tangent * B) * volumes[point];
            ++point;
          }
        for (const unsigned int i : values.dof_indices())
          for (const unsigned int j : values.dof_indices())
            cell_matrix(i, j) = stiffness(i, j);
        cell->get_dof_indices(dofs);
        constraints.distribute_local_to_global(cell_matrix, no_force, dofs, matrix, right_side);
      }
  matrix.compress(VectorOperation::add);
  right_side.compress(VectorOperation::add);
}

template NodalForces assemble_forces(const Discretisation<2>&, const std::vector<double>&, const SolidState<2>&,
                                     const AffineConstraints<double>&);
template NodalForces assemble_forces(const Discretisation<2>&, const std::vector<double>&, const SolidState<3>&,
                                     const AffineConstraints<double>&);
template NodalForces assemble_forces(const Discretisation<3>&, const std::vector<double>&, const SolidState<3>&,
                                     const AffineConstraints<double>&);
template void set_pattern(PETScWrappers::MPI::SparseMatrix&, const Discretisation<2>&,
                          const AffineConstraints<double>&);
template void set_pattern(PETScWrappers::MPI::SparseMatrix&, const Discretisation<3>&,
                          const AffineConstraints<double>&);
template void assemble_tangent(const Discretisation<2>&, const std::vector<double>&, const SolidState<2>&,
                               const AffineConstraints<double>&, PETScWrappers::MPI::SparseMatrix&, NodalVector&);
template void assemble_tangent(const Discretisation<2>&, const std::vector<double>&, const SolidState<3>&,
                               const AffineConstraints<double>&, PETScWrappers::MPI::SparseMatrix&, NodalVector&);
template void assemble_tangent(const Discretisation<3>&, const std::vector<double>&, const SolidState<3>&,
                               const AffineConstraints<double>&, PETScWrappers::MPI::SparseMatrix&, NodalVector&);
} // namespace feldspar::fem
