#pragma once

#include "fem/solid/solid.h"

#include <deal.II/grid/grid_generator.h>
#include <deal.II/numerics/vector_tools_integrate_difference.h>

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <vector>

/// Samples and checks that several tests of the solid need.
namespace feldspar::fem
{
/// Quarter of a ring about the origin, in the quadrant x, y > 0.
inline SampleMesh<2> quarter_ring(const MPI_Comm communicator, const double inner, const double outer,
                                  const unsigned int n_refinements)
{
  SampleMesh<2> mesh{std::make_unique<dealii::parallel::distributed::Triangulation<2>>(communicator),
                     {{"inner", 0}, {"outer", 1}, {"x=0", 2}, {"y=0", 3}}};
  dealii::GridGenerator::quarter_hyper_shell(*mesh.triangulation, dealii::Point<2>(), inner, outer, 0, true);
  mesh.triangulation->refine_global(n_refinements);
  return mesh;
}

/// Loads a solid and accepts what was found.
template <int dim, int material_dim>
NewtonReport solve_and_accept(Solid<dim, material_dim>& solid, const Load<dim>& load)
{
  NewtonReport report = solid.solve(load);
  EXPECT_TRUE(report.converged) << report.failure;
  solid.accept();
  return report;
}

template <int dim>
using Field = std::function<dealii::Tensor<1, dim>(const dealii::Point<dim>&)>;

template <int dim>
class FieldFunction : public dealii::Function<dim>
{
public:
  explicit FieldFunction(Field<dim> its_field)
    : dealii::Function<dim>(dim)
    , field(std::move(its_field))
  {
  }
  double value(const dealii::Point<dim>& position, const unsigned int component) const override
  {
    return field(position)[component];
  }

private:
  Field<dim> field;
};

/// |u - u_exact| over the volume (in r-z without its weight), as the L2 norm.
template <int dim, int material_dim>
double displacement_error(const Solid<dim, material_dim>& solid, const Field<dim>& exact)
{
  dealii::Vector<double> of_cells(solid.dofs().get_triangulation().n_active_cells());
  dealii::VectorTools::integrate_difference(solid.geometry(), solid.dofs(), solid.displacement(),
                                            FieldFunction<dim>(exact), of_cells, dealii::QGauss<dim>(5),
                                            dealii::VectorTools::L2_norm);
  return dealii::VectorTools::compute_global_error(solid.dofs().get_triangulation(), of_cells,
                                                   dealii::VectorTools::L2_norm);
}

/// The displacement of a load, one entry a component.
template <int dim>
void prescribe(Load<dim>& load, const std::string& boundary, const Field<dim>& field)
{
  for (unsigned int component = 0; component < dim; ++component)
    load.displacements.push_back(
      {boundary, component, [field, component](const dealii::Point<dim>& x) { return field(x)[component]; }});
}

template <int dim>
std::function<double(const dealii::Point<dim>&)> constant(const double value)
{
  return [value](const dealii::Point<dim>&) { return value; };
}
} // namespace feldspar::fem
