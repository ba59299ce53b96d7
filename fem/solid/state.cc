#include "fem/solid/state.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace feldspar::fem
{
using namespace dealii;

namespace
{
/// PointPlace::side_normal.
template <int dim, typename Cell>
std::vector<double> side_normal(const Discretisation<dim>& elements, const Cell& cell)
{
  FEFaceValues<dim> values(elements.mapping, elements.fe, QMidpoint<dim - 1>(), update_normal_vectors);
  for (const unsigned int face : cell->face_indices())
    {
      const auto& boundaries = elements.mesh.boundaries;
      const auto is_no_side = [&](const auto& boundary) {
        return boundary.second == cell->face(face)->boundary_id() &&
               (boundary.first == "bottom" || boundary.first == "top" || boundary.first == "axis");
      };
      if (!cell->face(face)->at_boundary() || std::ranges::any_of(boundaries, is_no_side))
        continue;
      values.reinit(cell, face);
      const Tensor<1, dim>& normal = values.normal_vector(0);
      return {normal.begin_raw(), normal.end_raw()};
    }
  return {};
}
} // namespace

template <int dim, int material_dim>
SolidPoints<material_dim> make_points(const Discretisation<dim>& elements, const Material<material_dim>& material)
{
  SolidPoints<material_dim> points;
  FEValues<dim> values(elements.mapping, elements.fe, elements.quadrature,
                       update_quadrature_points | update_JxW_values);
  for (const auto& cell : elements.dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
      {
        values.reinit(cell);
        const std::vector<double> normal = side_normal(elements, cell);
        const double measure = std::accumulate(values.get_JxW_values().begin(), values.get_JxW_values().end(), 0.0);
        for (const unsigned int q : values.quadrature_point_indices())
          {
            const Point<dim>& position = values.quadrature_point(q);
            PointPlace place{
              cell->id().to_string(), number_of(cell), q, {}, std::pow(measure, 1.0 / dim) / elements.order, normal};
            for (unsigned int component = 0; component < dim; ++component)
              place.position.push_back(position[component]);
            points.materials.add(material.make_point(place));
            points.places.push_back(std::move(place));
            points.volumes.push_back(values.JxW(q) * weight(elements.kinematics, position[0]));
          }
      }
  return points;
}

template <int dim, int material_dim>
SolidState<material_dim> state_at_rest(const Discretisation<dim>& elements,
                                       const MaterialPoints<material_dim>& materials)
{
  SolidState<material_dim> state{
    elements.ghosted_vector(), elements.owned_vector(), elements.owned_vector(), {}, {}, {}, {}};
  state.strains.assign(materials.size(), StrainVector<material_dim>::Zero());
  state.responses = materials.trial(state.strains);
  return state;
}

template <int dim, int material_dim>
std::vector<StrainVector<material_dim>> strains_of(const Discretisation<dim>& elements, const NodalVector& displacement)
{
  FEValues<dim> values(elements.mapping, elements.fe, elements.quadrature,
                       update_values | update_gradients | update_quadrature_points);
  const FEValuesExtractors::Vector displacements(0);
  std::vector<Tensor<1, dim>> u(elements.quadrature.size());
  std::vector<Tensor<2, dim>> gradients(elements.quadrature.size());
  std::vector<StrainVector<material_dim>> strains;
  for (const auto& cell : elements.dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
      {
        values.reinit(cell);
        values[displacements].get_function_values(displacement, u);
        values[displacements].get_function_gradients(displacement, gradients);
        for (const unsigned int q : values.quadrature_point_indices())
          {
            StrainVector<material_dim> strain = StrainVector<material_dim>::Zero();
            for (unsigned int component = 0; component < dim; ++component)
              strain += strain_of<dim, material_dim>(elements.kinematics, component, u[q][component],
                                                     gradients[q][component], values.quadrature_point(q)[0]);
            strains.push_back(strain);
          }
      }
  return strains;
}

template SolidPoints<2> make_points(const Discretisation<2>&, const Material<2>&);
template SolidPoints<3> make_points(const Discretisation<2>&, const Material<3>&);
template SolidPoints<3> make_points(const Discretisation<3>&, const Material<3>&);
template SolidState<2> state_at_rest(const Discretisation<2>&, const MaterialPoints<2>&);
template SolidState<3> state_at_rest(const Discretisation<2>&, const MaterialPoints<3>&);
template SolidState<3> state_at_rest(const Discretisation<3>&, const MaterialPoints<3>&);
template std::vector<StrainVector<2>> strains_of<2, 2>(const Discretisation<2>&, const NodalVector&);
template std::vector<StrainVector<3>> strains_of<2, 3>(const Discretisation<2>&, const NodalVector&);
template std::vector<StrainVector<3>> strains_of<3, 3>(const Discretisation<3>&, const NodalVector&);
} // namespace feldspar::fem
