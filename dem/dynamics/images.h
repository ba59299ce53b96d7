#pragma once

#include "base/input_error.h"
#include "dem/specimen/periodic_images.h"
#include "dem/specimen/specimen.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace feldspar
{
/// The images of a periodic body, which stand behind its own grains and move with them, and the cell that tells where.
/// Other bodies have none.
template <int dim>
class Images
{
public:
  explicit Images(const Specimen<dim>& body)
    : own_grains(body.grains.size())
    , edges(body.cell())
  {
  }

  /// Grains that are not images.
  std::size_t n_own() const { return own_grains; }
  std::uint32_t owner(const std::uint32_t grain) const
  {
    return grain < own_grains ? grain : images[grain - own_grains].owner;
  }
  /// Displacement from the owner of a grain to the grain [m].
  Vector<dim> way_to(const std::uint32_t grain) const
  {
    return grain < own_grains ? Vector<dim>::Zero().eval() : shift(images[grain - own_grains], edges);
  }
  /// Returns whether a contact of these two is the one of its kind that counts.
  bool pair_counts(const std::uint32_t one, const std::uint32_t two) const
  {
    return one < own_grains && (two < own_grains || counts(one, images[two - own_grains]));
  }

  /// The number of an image among the grains; one that is not there yet is put behind them.
  std::uint32_t number_of(const PeriodicImage<dim>& image, Grains<dim>& grains)
  {
    const auto [entry, is_new] = number_of_image.try_emplace(image, std::uint32_t(grains.size()));
    if (is_new)
      {
        images.push_back(image);
        const auto repeat = [&](auto& values) { values.push_back(values[image.owner]); };
        for (auto* values : {&grains.radius, &grains.mass, &grains.moment_of_inertia})
          repeat(*values);
        for (auto* components : {&grains.position, &grains.velocity, &grains.force})
          for (auto& component : *components)
            repeat(component);
        for (auto* components : {&grains.spin, &grains.couple})
          for (auto& component : *components)
            repeat(component);
        set<dim>(grains.position, entry->second, at<dim>(grains.position, image.owner) + shift(image, edges));
      }
    return entry->second;
  }
  /// Gives every grain that could come within `reach` [m] of one of another box its images.
  void add_within(const double reach, Grains<dim>& grains)
  {
    Grains<dim> own;
    own.radius.assign(grains.radius.begin(), grains.radius.begin() + std::ptrdiff_t(own_grains));
    for (int c = 0; c < dim; ++c)
      own.position[c].assign(grains.position[c].begin(), grains.position[c].begin() + std::ptrdiff_t(own_grains));
    for (const auto& image : images_within(own, edges, reach))
      number_of(image, grains);
  }

  /// The rate at which the cell, and with it every image, moves away from the origin [1/s].
  void deform(const Tensor<dim>& wanted) { cell_rate = wanted; }
  const Tensor<dim>& rate() const { return cell_rate; }
  /// Edges of the box, as columns [m].
  const Tensor<dim>& cell() const { return edges; }

  /// Moves the cell over a step [s], and the images after their owners.
  void move(const double dt, Grains<dim>& grains)
  {
    edges += dt * cell_rate * edges;
    for (std::size_t k = 0; k < images.size(); ++k)
      {
        const auto& image = images[k];
        const Vector<dim> way = shift(image, edges);
        const Vector<dim> faster = cell_rate * way;
        for (int c = 0; c < dim; ++c)
          {
            grains.position[c][own_grains + k] = grains.position[c][image.owner] + way[c];
            grains.velocity[c][own_grains + k] = grains.velocity[c][image.owner] + faster[c];
          }
        for (int c = 0; c < n_rotations<dim>; ++c)
          grains.spin[c][own_grains + k] = grains.spin[c][image.owner];
      }
  }

  /// Reading, gives the grains room for the images; their positions and velocities are the grains' own.
  template <typename Archive>
  void transfer(Archive& archive, Grains<dim>& grains)
  {
    archive.array("images", images);
    for (const auto& image : images)
      if (image.owner >= own_grains)
        throw InputError("of another specimen");
    for (int c = 0; c < dim; ++c)
      for (int r = 0; r < dim; ++r)
        {
          archive.value(std::string("cell_") + "xyz"[r] + "xyz"[c], edges(r, c));
          archive.value(std::string("cell_rate_") + "xyz"[r] + "xyz"[c], cell_rate(r, c));
        }
    number_of_image.clear();
    for (std::size_t k = 0; k < images.size(); ++k)
      number_of_image[images[k]] = std::uint32_t(own_grains + k);
    for (auto* values : {&grains.radius, &grains.mass, &grains.moment_of_inertia})
      {
        values->resize(own_grains);
        for (const auto& image : images)
          values->push_back((*values)[image.owner]);
      }
  }

private:
  std::size_t own_grains;
  std::vector<PeriodicImage<dim>> images;
  std::map<PeriodicImage<dim>, std::uint32_t> number_of_image; ///< among all grains
  Tensor<dim> edges;
  Tensor<dim> cell_rate = Tensor<dim>::Zero();
};
} // namespace feldspar
