// A notched plate of rock pulled apart, in the manner of deal.II's step-8: plane elements whose material is a representative
// volume of grains at every quadrature point.
//
//   top, pulled up by u
//   +-----------+
//   |           |      60 x 60 mm, 6 x 6 elements; the notch is the bottom side of the three elements
//   |-----      |      on the left of the middle row, which the elements below do not share
//   |           |
//   +-----------+
//   bottom, held

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparse_direct.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>
#include <deal.II/numerics/vector_tools.h>
#include <feldspar/feldspar.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <vector>

using namespace dealii;

class NotchedPlate
{
public:
  NotchedPlate();
  void run();

private:
  static constexpr unsigned int dim = 2;
  static constexpr unsigned int n_voigt = 3;
  static constexpr unsigned int top = 3, bottom = 2; // boundary numbers of a coloured rectangle

  void make_grid();
  void set_up();
  void assemble();                  // residual and tangent at the stresses of the volumes
  double solve_step(double pulled); // Newton's method; returns the force on the top [N per metre of thickness]
  void update_volumes();            // strains of all points to the volumes, stresses back

  Triangulation<dim> mesh;
  FESystem<dim> element{FE_Q<dim>(1), dim};
  QGauss<dim> quadrature{2};
  DoFHandler<dim> dofs{mesh};
  AffineConstraints<double> fixed;
  SparsityPattern pattern;
  SparseMatrix<double> tangent;
  Vector<double> displacement, residual, reaction;

  std::unique_ptr<feldspar::Volumes> volumes;
  std::uint64_t accepted = 0, tried = 0; // tokens of the states of all volumes
  std::vector<double> strains, stresses, tangents;
  unsigned int n_iterations = 0; // of the last step
};

NotchedPlate::NotchedPlate()
{
  make_grid();
  set_up();
}

void NotchedPlate::make_grid()
{
  Triangulation<dim> lower, upper;
  const double edge = 0.06;
  GridGenerator::subdivided_hyper_rectangle(lower, {6, 3}, Point<dim>(0, 0), Point<dim>(edge, edge / 2), true);
  GridGenerator::subdivided_hyper_rectangle(upper, {6, 3}, Point<dim>(0, edge / 2), Point<dim>(edge, edge), true);
  // Vertices of the notch, x < edge / 2, are moved a little apart, so that merging joins the halves on the right alone.
  const double open = 1e-5;
  for (auto* half : {&lower, &upper})
    for (const auto& cell : half->active_cell_iterators())
      for (const unsigned int v : cell->vertex_indices())
        if (Point<dim>& p = cell->vertex(v); std::abs(p[1] - edge / 2) < 1e-9 && p[0] < edge / 2 - 1e-9)
          p[1] += half == &upper ? open : -open;
  GridGenerator::merge_triangulations(lower, upper, mesh, 1e-9);
  for (const auto& face : mesh.active_face_iterators())
    if (face->at_boundary())
      face->set_boundary_id(face->center()[1] > edge - 1e-9 ? top : face->center()[1] < 1e-9 ? bottom : 0);
}

void NotchedPlate::set_up()
{
  dofs.distribute_dofs(element);
  DynamicSparsityPattern growing(dofs.n_dofs());
  DoFTools::make_sparsity_pattern(dofs, growing);
  pattern.copy_from(growing);
  tangent.reinit(pattern);
  for (Vector<double>* vector : {&displacement, &residual, &reaction})
    vector->reinit(dofs.n_dofs());

  // Corrections of Newton's method vanish where displacements are prescribed.
  for (const unsigned int side : {top, bottom})
    VectorTools::interpolate_boundary_values(dofs, side, Functions::ZeroFunction<dim>(dim), fixed);
  fixed.close();

  // The material: periodic cells of grains, four realisations for the points in turn.
  feldspar::Input rock;
  rock.set("Specimen/Shape", "periodic");
  rock.set("Specimen/Width", "10 mm");
  rock.set("Specimen/Height", "10 mm");
  std::vector<feldspar::Specimen> cells;
  for (std::uint64_t seed = 1; seed <= 4; ++seed)
    cells.emplace_back(rock, seed);
  const std::size_t n_points = mesh.n_active_cells() * quadrature.size();
  std::vector<std::size_t> assigned(n_points);
  for (std::size_t q = 0; q < n_points; ++q)
    assigned[q] = q % cells.size();
  volumes = std::make_unique<feldspar::Volumes>(cells, rock, n_points, assigned);
  strains.resize(n_points * n_voigt);
  stresses.resize(n_points * n_voigt);
  tangents.resize(n_points * n_voigt * n_voigt);
}

void NotchedPlate::update_volumes()
{
  FEValues<dim> values(element, quadrature, update_gradients);
  std::vector<SymmetricTensor<2, dim>> at_points(quadrature.size());
  auto next = strains.begin();
  for (const auto& cell : dofs.active_cell_iterators())
    {
      values.reinit(cell);
      values[FEValuesExtractors::Vector(0)].get_function_symmetric_gradients(displacement, at_points);
      for (const auto& strain : at_points)
        for (const double component : {strain[0][0], strain[1][1], 2.0 * strain[0][1]})
          *next++ = component;
    }
  tried = volumes->update(strains, accepted, stresses, tangents);
}

void NotchedPlate::assemble()
{
  tangent = 0.0;
  residual = 0.0;
  reaction = 0.0;
  FEValues<dim> values(element, quadrature, update_gradients | update_JxW_values);
  const FEValuesExtractors::Vector displacements(0);
  const unsigned int n = element.n_dofs_per_cell();
  FullMatrix<double> of_cell(n, n);
  Vector<double> forces(n);
  std::vector<types::global_dof_index> numbers(n);
  std::size_t point = 0;
  for (const auto& cell : dofs.active_cell_iterators())
    {
      values.reinit(cell);
      of_cell = 0.0;
      forces = 0.0;
      for (unsigned int q = 0; q < quadrature.size(); ++q, ++point)
        {
          const double* const stress = &stresses[point * n_voigt];
          const double* const stiffness = &tangents[point * n_voigt * n_voigt];
          const auto strain_of = [&](const unsigned int i) {
            const auto strain = values[displacements].symmetric_gradient(i, q);
            return std::array<double, n_voigt>{{strain[0][0], strain[1][1], 2.0 * strain[0][1]}};
          };
          for (unsigned int i = 0; i < n; ++i)
            {
              const auto own = strain_of(i);
              for (unsigned int a = 0; a < n_voigt; ++a)
                forces[i] += own[a] * stress[a] * values.JxW(q);
              for (unsigned int j = 0; j < n; ++j)
                {
                  const auto other = strain_of(j);
                  for (unsigned int a = 0; a < n_voigt; ++a)
                    for (unsigned int b = 0; b < n_voigt; ++b)
                      of_cell(i, j) += own[a] * stiffness[a * n_voigt + b] * other[b] * values.JxW(q);
                }
            }
        }
      cell->get_dof_indices(numbers);
      for (unsigned int i = 0; i < n; ++i)
        reaction[numbers[i]] += forces[i];
      forces *= -1.0;
      fixed.distribute_local_to_global(of_cell, forces, numbers, tangent, residual);
    }
}

double NotchedPlate::solve_step(const double pulled)
{
  AffineConstraints<double> prescribed;
  VectorTools::interpolate_boundary_values(
    dofs, top, Functions::ConstantFunction<dim>(std::vector<double>{0.0, pulled}), prescribed);
  prescribed.close();
  prescribed.distribute(displacement);

  constexpr double tolerance = 1e-6;  // of the forces on the sides, which no longer tell of a plate that has come apart
  constexpr double least_force = 1.0; // [N/m]
  for (n_iterations = 0;; ++n_iterations)
    {
      update_volumes();
      assemble();
      if (residual.l2_norm() < std::max(tolerance * reaction.l2_norm(), least_force))
        break;
      if (n_iterations == 50)
        throw feldspar::Error("no equilibrium was found at this displacement; pull in smaller steps");
      SparseDirectUMFPACK solver;
      solver.initialize(tangent);
      Vector<double> correction(residual);
      solver.vmult(correction, residual);
      fixed.distribute(correction);
      displacement += correction;
    }
  accepted = tried;

  const ComponentMask upward(std::vector<bool>{false, true});
  double force = 0.0;
  for (const auto number : DoFTools::extract_boundary_dofs(dofs, upward, {top}))
    force += reaction[number];
  return force;
}

void NotchedPlate::run()
{
  std::printf("displacement_um,force_kN_per_m,broken_segments,iterations\n");
  for (unsigned int step = 1; step <= 12; ++step)
    {
      const double pulled = 1e-6 * step;
      const double force = solve_step(pulled);
      std::size_t n_broken = 0;
      for (const std::size_t n : volumes->n_broken(accepted))
        n_broken += n;
      std::printf("%.1f,%.4f,%zu,%u\n", 1e6 * pulled, force / 1e3, n_broken, n_iterations);
    }
}

int main()
{
  try
    {
      NotchedPlate plate;
      plate.run();
    }
  catch (const feldspar::Error& error)
    {
      std::fprintf(stderr, "%s\n", error.what());
      return 2;
    }
}
