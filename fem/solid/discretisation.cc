#include "fem/solid/discretisation.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>

#include <stdexcept>

namespace feldspar::fem
{
using namespace dealii;

namespace
{
unsigned int n_quadrature_points(const SolidParameters& parameters)
{
  if (parameters.order != 1 && parameters.order != 2)
    throw std::invalid_argument("shape functions have order 1 or 2");
  if (parameters.reduced_quadrature && parameters.order == 1)
    throw std::invalid_argument("order 1 with reduced quadrature lets cells deform without strain");
  return parameters.reduced_quadrature ? parameters.order : parameters.order + 1;
}
} // namespace

template <int dim>
Discretisation<dim>::Discretisation(const SampleMesh<dim>& its_mesh, const SolidParameters& parameters)
  : mesh(its_mesh)
  , kinematics(parameters.kinematics)
  , order(parameters.order)
  , mapping(parameters.reduced_quadrature
              ? 1
              : parameters.order) // reduced: too few points for constant stress in curved cells
  , fe(FE_Q<dim>(parameters.order), dim)
  , quadrature(n_quadrature_points(parameters))
  , face_quadrature(parameters.order + 1)
  , dof_handler(*mesh.triangulation)
{
  distribute();
}

template <int dim>
void Discretisation<dim>::distribute()
{
  dof_handler.distribute_dofs(fe);
  owned = dof_handler.locally_owned_dofs();
  DoFTools::extract_locally_relevant_dofs(dof_handler, relevant);
}

template <int dim>
IndexSet Discretisation<dim>::dofs_on(const std::string& boundary, const unsigned int component) const
{
  return DoFTools::extract_boundary_dofs(dof_handler, only<dim>(component), {mesh.boundary(boundary)});
}

template <int dim>
double Discretisation<dim>::integral(const std::string& boundary, const NodalVector& displacement,
                                     const Integrand& integrand) const
{
  const types::boundary_id wanted = mesh.boundary(boundary);
  FEFaceValues<dim> values(mapping, fe, face_quadrature,
                           update_values | update_normal_vectors | update_quadrature_points | update_JxW_values);
  const FEValuesExtractors::Vector displacements(0);
  std::vector<Tensor<1, dim>> u(face_quadrature.size());
  double sum = 0.0;
  for (const auto& cell : owned_cells())
    for (const auto& face : cell->face_iterators())
      if (face->at_boundary() && face->boundary_id() == wanted)
        {
          values.reinit(cell, face);
          values[displacements].get_function_values(displacement, u);
          for (const unsigned int q : values.quadrature_point_indices())
            sum += integrand(u[q], values.normal_vector(q)) * values.JxW(q) *
                   weight(kinematics, values.quadrature_point(q)[0]);
        }
  return Utilities::MPI::sum(sum, communicator());
}

template <int dim>
double Discretisation<dim>::swept_volume(const std::vector<std::string>& boundaries,
                                         const NodalVector& displacement) const
{
  double swept = 0.0;
  for (const std::string& boundary : boundaries)
    swept += integral(boundary, displacement, [](const auto& u, const auto& normal) { return u * normal; });
  return swept;
}

template struct Discretisation<2>;
template struct Discretisation<3>;
} // namespace feldspar::fem
