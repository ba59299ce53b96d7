// Names of boundaries are held against where the boundaries lie, in meshes of every geometry.

#include "fem/mesh/sample_mesh.h"
#include "tests/words.h"

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <set>
#include <string>
#include <utility>

namespace feldspar::fem
{
namespace
{
using tests::has;

constexpr double width = 0.05;
constexpr double height = 0.1;
constexpr double thousandth = 1e-3 * width; // to which a place holds

SampleMesh<2> plane() { return plane_sample(MPI_COMM_WORLD, width, height, {4, 8}, 0); }
SampleMesh<2> in_r_z() { return axisymmetric_sample(MPI_COMM_WORLD, 0.5 * width, height, {2, 8}, 0); }
SampleMesh<3> cylinder() { return cylinder_sample(MPI_COMM_WORLD, 0.5 * width, height, {4, 4}, 0); }

/// Message on a mesh; empty where the mesh is accepted.
template <int dim>
std::string complaint(const SampleMesh<dim>& mesh, const bool is_in_r_z = false)
{
  const std::string words = tests::refusal<MeshError>([&] { check_places(mesh, is_in_r_z); });
  EXPECT_FALSE(has(words, "\n"));
  return words;
}

/// With the names of two boundaries exchanged.
template <int dim>
SampleMesh<dim> exchanged(SampleMesh<dim> mesh, const std::string& one, const std::string& other)
{
  std::swap(mesh.boundaries.at(one), mesh.boundaries.at(other));
  return mesh;
}

/// With its nodes elsewhere.
template <int dim>
SampleMesh<dim> moved(SampleMesh<dim> mesh, const std::function<dealii::Point<dim>(dealii::Point<dim>)>& to)
{
  mesh.triangulation->reset_all_manifolds();
  dealii::GridTools::transform([&](const dealii::Point<dim>& node) { return to(node); }, *mesh.triangulation);
  return mesh;
}

/// With the first side of a cell that is chosen under another name.
template <int dim>
SampleMesh<dim> renamed(SampleMesh<dim> mesh, const std::string& name,
                        const std::function<bool(dealii::Point<dim>)>& chosen)
{
  for (const auto& cell : mesh.triangulation->active_cell_iterators())
    for (const auto& face : cell->face_iterators())
      if (face->at_boundary() && chosen(face->center()))
        {
          face->set_boundary_id(mesh.boundary(name));
          return mesh;
        }
  ADD_FAILURE() << "there is no such side";
  return mesh;
}

void expect_words(const std::string& said, const std::string& words) { EXPECT_TRUE(has(said, words)); }
} // namespace

TEST(BoundaryPlaces, AreThoseOfOurOwnMeshes)
{
  EXPECT_EQ(complaint(plane()), "");
  EXPECT_EQ(complaint(in_r_z(), true), "");
  EXPECT_EQ(complaint(cylinder()), "");
}

TEST(BoundaryPlaces, ExchangedNamesAreToldWithTheRemedy)
{
  EXPECT_EQ(
    complaint(exchanged(plane(), "top", "bottom")),
    "top lies below bottom: top at y = 0 m, bottom at y = 0.1 m; y counts upwards, so mirror a depth (y -> -y), or "
    "give each the name of the other");
  expect_words(complaint(exchanged(in_r_z(), "top", "bottom"), true), "top lies below bottom: top at y = 0 m");
  expect_words(complaint(exchanged(cylinder(), "top", "bottom")), "top lies below bottom: top at z = 0 m");
  expect_words(complaint(exchanged(plane(), "left", "right")),
               "right lies to the left of left: right at x = 0 m, left at x = 0.05 m");
  expect_words(complaint(exchanged(in_r_z(), "axis", "side"), true),
               "side lies within axis: side at x = 0 m, axis at x = 0.025 m");
  // An end and a side: neither lies where it should.
  EXPECT_NE(complaint(exchanged(plane(), "left", "top")), "");
  EXPECT_NE(complaint(exchanged(in_r_z(), "axis", "bottom"), true), "");
  EXPECT_NE(complaint(exchanged(cylinder(), "side", "top")), "");
  EXPECT_NE(complaint(exchanged(cylinder(), "side", "bottom")), "");
}

TEST(BoundaryPlaces, EndsAreFlatAndSquareToAThousandthOfTheWidth)
{
  for (const double share : {0.5, 2.0})
    {
      const double slope = share * thousandth / width;
      const auto tilted = complaint(moved<2>(plane(), [=](dealii::Point<2> node) {
        node[1] += slope * node[0] * node[1] / height;
        return node;
      }));
      const auto bent = complaint(moved<3>(cylinder(), [=](dealii::Point<3> node) {
        const double r = std::hypot(node[0], node[1]) / (0.5 * width);
        node[2] += share * thousandth * r * r * (1.0 - node[2] / height);
        return node;
      }));
      if (share < 1.0)
        {
          EXPECT_EQ(tilted, "");
          EXPECT_EQ(bent, "");
        }
      else
        {
          EXPECT_EQ(tilted,
                    "top reaches from y = 0.1 m to y = 0.1001 m; all of it must lie at y = 0.1001 m to within 5e-05 "
                    "m, a thousandth of the width");
          expect_words(bent, "bottom reaches from z = 0 m to z = 0.0001 m");
        }
    }
}

TEST(BoundaryPlaces, WhatLiesAtAnEndHasItsNameAndNoOther)
{
  const auto at_top = [](const dealii::Point<2>& centre) { return centre[1] > 0.999 * height; };
  const auto at_left = [](const dealii::Point<2>& centre) { return centre[0] < 0.001 * width; };
  expect_words(complaint(renamed<2>(plane(), "bottom", at_top)), "bottom reaches from y = 0 m to y = 0.1 m");
  EXPECT_EQ(
    complaint(renamed<2>(plane(), "left", at_top)),
    "the side of a cell at (0.00625, 0.1) m lies where top is and is named left; top must be all that lies there");
  expect_words(complaint(renamed<2>(plane(), "right", at_left)), "lies where left is and is named right");
  auto nameless = plane();
  nameless.boundaries["hole"] = 17;
  expect_words(complaint(renamed<2>(std::move(nameless), "hole", at_top)),
               "lies where top is and has none of these names");
  auto empty = plane();
  empty.boundaries["top"] = 17;
  EXPECT_EQ(complaint(empty), "no outer side of a cell belongs to top");
}

// A waist is a side as any other; what faces the axis is none.
TEST(BoundaryPlaces, SidesMayBendButFaceAwayFromTheAxis)
{
  const auto waist = [](dealii::Point<2> node) {
    const double narrowing = 0.3 * std::sin(std::numbers::pi * node[1] / height);
    node[0] = 0.5 * width + (1.0 - narrowing) * (node[0] - 0.5 * width);
    return node;
  };
  EXPECT_EQ(complaint(moved<2>(plane(), waist)), "");
  const auto barrel = [](dealii::Point<3> node) {
    const double widening = 1.0 + 0.1 * std::sin(std::numbers::pi * node[2] / height);
    node[0] *= widening;
    node[1] *= widening;
    return node;
  };
  EXPECT_EQ(complaint(moved<3>(cylinder(), barrel)), "");

  // A hole whose rim is called left: half of it faces to the right.
  SampleMesh<2> holed{std::make_unique<dealii::parallel::distributed::Triangulation<2>>(MPI_COMM_WORLD),
                      plane().boundaries};
  dealii::Triangulation<2> cells, without_middle;
  dealii::GridGenerator::subdivided_hyper_rectangle(cells, {3, 3}, dealii::Point<2>(), dealii::Point<2>(width, height),
                                                    true);
  std::set<dealii::Triangulation<2>::active_cell_iterator> middle;
  for (const auto& cell : cells.active_cell_iterators())
    if (cell->center().distance(dealii::Point<2>(0.5 * width, 0.5 * height)) < 1e-6)
      middle.insert(cell);
  dealii::GridGenerator::create_triangulation_with_removed_cells(cells, middle, without_middle);
  holed.triangulation->copy_triangulation(without_middle);
  for (const auto& cell : holed.triangulation->active_cell_iterators())
    for (const auto& face : cell->face_iterators())
      if (face->at_boundary())
        {
          const auto centre = face->center();
          const bool outside =
            centre[0] < 1e-9 || centre[0] > width - 1e-9 || centre[1] < 1e-9 || centre[1] > height - 1e-9;
          face->set_boundary_id(!outside                   ? 17
                                : centre[0] < 1e-9         ? 0
                                : centre[0] > width - 1e-9 ? 1
                                : centre[1] < 1e-9         ? 2
                                                           : 3);
        }
  EXPECT_EQ(complaint(holed), "");
  for (const auto& cell : holed.triangulation->active_cell_iterators())
    for (const auto& face : cell->face_iterators())
      if (face->at_boundary() && face->boundary_id() == 17)
        face->set_boundary_id(0);
  expect_words(complaint(holed), "is named left and faces to the right");
}
} // namespace feldspar::fem
