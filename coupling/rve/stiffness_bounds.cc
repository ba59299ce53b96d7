#include "coupling/rve/stiffness_bounds.h"

#include "base/disjoint_sets.h"

#include <Eigen/LU>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

namespace feldspar
{
namespace
{
/// Of the diagonal, lent to each motion: grains without joints would move freely.
constexpr double regularity = 1e-10;

using Sparse = Eigen::SparseMatrix<double>;
using Entries = std::vector<Eigen::Triplet<double>>;
constexpr Eigen::Index held = -1; // the row of a motion that is not free

/// The inverse of a stiffness times a few columns.
Eigen::MatrixXd solved(Entries entries, const Eigen::Index n, const Eigen::MatrixXd& right)
{
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(n);
  for (const auto& entry : entries)
    if (entry.row() == entry.col())
      diagonal[entry.row()] += entry.value();
  for (Eigen::Index i = 0; i < n; ++i)
    entries.emplace_back(int(i), int(i), diagonal[i] > 0.0 ? regularity * diagonal[i] : 1.0);
  Sparse stiffness(n, n);
  stiffness.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Sparse> factor(stiffness);
  if (factor.info() != Eigen::Success)
    throw std::runtime_error("the open network has no factor");
  return factor.solve(right);
}

/// Adds gᵀ K g of a joint between two places, [n_motions] rows each.
template <int dim>
void add_joint(Entries& entries, const Network<dim>& network, const std::size_t joint,
               const std::array<Eigen::Index, 2 * n_motions<dim>>& rows)
{
  const auto& gradient = network.links()[joint].by_grains;
  const Eigen::Matrix<double, 2 * n_motions<dim>, 2 * n_motions<dim>> stiffness =
    gradient.transpose() * network.bonded_stiffness(joint) * gradient;
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (rows[i] != held && rows[k] != held)
        entries.emplace_back(int(rows[i]), int(rows[k]), stiffness(Eigen::Index(i), Eigen::Index(k)));
}

/// The images that joints lead to, numbered behind the grains.
template <int dim>
std::map<PeriodicImage<dim>, std::uint32_t> images_of_joints(const Network<dim>& network)
{
  std::map<PeriodicImage<dim>, std::uint32_t> images;
  for (std::size_t j = 0; j < network.n_joints(); ++j)
    if (const auto& boxes = network.boxes_crossed()[j]; boxes != std::array<int, dim>{})
      images.try_emplace(PeriodicImage<dim>{network.links()[j].grain_2, boxes}, 0);
  std::uint32_t number = std::uint32_t(network.n_grains());
  for (auto& image : images)
    image.second = number++;
  return images;
}

/// The axis whose side such an image lies behind; none behind an edge or a corner.
template <int dim>
int side_of(const std::array<int, dim>& boxes)
{
  int axis = -1;
  for (int c = 0; c < dim; ++c)
    if (boxes[c] != 0)
      {
        if (axis >= 0 || std::abs(boxes[c]) > 1)
          return -1;
        axis = c;
      }
  return axis;
}

template <int dim>
Stiffness<dim> minimal_kinematic(const Network<dim>& network)
{
  constexpr int n = n_motions<dim>;
  const auto images = images_of_joints(network);
  const std::size_t n_places = network.n_grains() + images.size();
  const auto second_of = [&](const std::size_t joint) {
    const auto& boxes = network.boxes_crossed()[joint];
    const std::uint32_t owner = network.links()[joint].grain_2;
    return boxes == std::array<int, dim>{} ? owner : images.at({owner, boxes});
  };

  // Chips that only joints over the sides held float now: a traction on them would do no work.
  DisjointSets groups(n_places);
  for (std::size_t j = 0; j < network.n_joints(); ++j)
    groups.merge(network.links()[j].grain_1, second_of(j));
  const auto sizes = groups.sizes();
  const auto body = std::uint32_t(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());

  // One grain of the body is held: the strain does not see how it moves as a whole.
  const auto row_of = [&](const std::uint32_t place, const int motion) {
    return place == body ? held : n * Eigen::Index(place < body ? place : place - 1) + motion;
  };
  Entries entries;
  for (std::size_t j = 0; j < network.n_joints(); ++j)
    {
      std::array<Eigen::Index, 2 * n> rows;
      for (int motion = 0; motion < n; ++motion)
        {
          rows[std::size_t(motion)] = row_of(network.links()[j].grain_1, motion);
          rows[std::size_t(n + motion)] = row_of(second_of(j), motion);
        }
      add_joint(entries, network, j, rows);
    }

  // A: a share of the strain for each pair, in proportion to the section of its grain. The sum of edge ⊗ row of the
  // inverse over the edges of the cell is the identity.
  const Tensor<dim> inverse = network.cell().inverse();
  std::array<double, dim> sections{};
  const auto section = [&](const PeriodicImage<dim>& image, const std::uint32_t number) {
    const bool hangs_on = groups.root(number) == body && groups.root(image.owner) == body;
    return side_of<dim>(image.boxes) >= 0 && hangs_on ? std::pow(network.radii()[image.owner], dim - 1) : 0.0;
  };
  for (const auto& [image, number] : images)
    if (const double size = section(image, number); size > 0.0)
      sections[std::size_t(side_of<dim>(image.boxes))] += size;
  if (std::any_of(sections.begin(), sections.end(), [](const double sum) { return sum == 0.0; }))
    return Stiffness<dim>::Zero();
  const Eigen::Index n_rows = n * Eigen::Index(n_places - 1);
  Eigen::MatrixXd transposed = Eigen::MatrixXd::Zero(n_rows, n_voigt<dim>); // Aᵀ
  for (const auto& [image, number] : images)
    if (const double size = section(image, number); size > 0.0)
      {
        const int axis = side_of<dim>(image.boxes);
        const Vector<dim> area = size / sections[std::size_t(axis)] * image.boxes[std::size_t(axis)] *
                                 inverse.row(axis).transpose(); // over the volume
        for (int c = 0; c < dim; ++c)
          {
            const Tensor<dim> gradient = Vector<dim>::Unit(c) * area.transpose();
            const Voigt<dim> strain = strain_voigt<dim>(Tensor<dim>(0.5 * (gradient + gradient.transpose())));
            if (const Eigen::Index row = row_of(number, c); row != held)
              transposed.row(row) += strain.transpose();
            if (const Eigen::Index row = row_of(image.owner, c); row != held)
              transposed.row(row) -= strain.transpose();
          }
      }
  const Stiffness<dim> compliance = network.volume() * transposed.transpose() * solved(entries, n_rows, transposed);
  const Stiffness<dim> stiffness = compliance.inverse();
  return 0.5 * (stiffness + stiffness.transpose());
}

template <int dim>
Stiffness<dim> affine(const Network<dim>& network)
{
  constexpr int n = n_motions<dim>;
  std::vector<bool> is_displaced(network.n_grains(), false); // as the strain says: no motion of its own
  for (const auto& [image, number] : images_of_joints(network))
    is_displaced[image.owner] = true;
  std::vector<Eigen::Index> rows(n * network.n_grains(), held);
  Eigen::Index n_rows = 0;
  for (std::size_t i = 0; i < network.n_grains(); ++i)
    for (int motion = is_displaced[i] ? dim : 0; motion < n; ++motion)
      rows[n * i + std::size_t(motion)] = n_rows++;

  Entries entries;
  Eigen::MatrixXd coupling = Eigen::MatrixXd::Zero(n_rows, n_voigt<dim>); // of motions and strain
  Stiffness<dim> of_strain = Stiffness<dim>::Zero();
  for (std::size_t j = 0; j < network.n_joints(); ++j)
    {
      const Link<dim>& link = network.links()[j];
      std::array<Eigen::Index, 2 * n> of_joint;
      for (int motion = 0; motion < n; ++motion)
        {
          of_joint[std::size_t(motion)] = rows[n * link.grain_1 + std::size_t(motion)];
          of_joint[std::size_t(n + motion)] = rows[n * link.grain_2 + std::size_t(motion)];
        }
      add_joint(entries, network, j, of_joint);
      const LinkStrainGradient<dim> forces = network.bonded_stiffness(j) * link.by_strain;
      of_strain += link.by_strain.transpose() * forces;
      const auto of_grains = (link.by_grains.transpose() * forces).eval();
      for (std::size_t i = 0; i < of_joint.size(); ++i)
        if (of_joint[i] != held)
          coupling.row(of_joint[i]) += of_grains.row(Eigen::Index(i));
    }
  const Stiffness<dim> stiffness =
    (of_strain - coupling.transpose() * solved(entries, n_rows, coupling)) / network.volume();
  return 0.5 * (stiffness + stiffness.transpose());
}
} // namespace

template <int dim>
StiffnessBounds<dim> stiffness_bounds(const Network<dim>& network)
{
  return {minimal_kinematic(network), affine(network)};
}

template StiffnessBounds<2> stiffness_bounds(const Network<2>&);
template StiffnessBounds<3> stiffness_bounds(const Network<3>&);
} // namespace feldspar
