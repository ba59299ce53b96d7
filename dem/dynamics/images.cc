#include "dem/dynamics/images.h"

namespace feldspar
{
template <int dim>
std::uint32_t Images<dim>::number_of(const PeriodicImage<dim>& image, Grains<dim>& grains)
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

template <int dim>
void Images<dim>::add_within(const double reach, Grains<dim>& grains)
{
  Grains<dim> own;
  own.radius.assign(grains.radius.begin(), grains.radius.begin() + std::ptrdiff_t(own_grains));
  for (int c = 0; c < dim; ++c)
    own.position[c].assign(grains.position[c].begin(), grains.position[c].begin() + std::ptrdiff_t(own_grains));
  for (const auto& image : images_within(own, edges, reach))
    number_of(image, grains);
}

template <int dim>
void Images<dim>::move(const double dt, Grains<dim>& grains)
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

template class Images<2>;
template class Images<3>;
} // namespace feldspar
