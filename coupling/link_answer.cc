#include "coupling/link_answer.h"

namespace feldspar
{
namespace
{
template <int dim>
double shear_squared(const std::array<double, dim - 1>& shear)
{
  double sum = 0.0;
  for (const double component : shear)
    sum += component * component;
  return sum;
}

/// The part of a segment's face that presses.
struct Pressing
{
  double share;  ///< of its area
  double offset; ///< of its centroid from the segment's, along t [m]
};

Pressing pressing_part(const flat_joint::Segment<2, double>& face, const double gap, const double slope)
{
  const double length = flat_joint::closed_part(face, gap, slope).length;
  return {length / face.length, (slope < 0.0 ? -0.5 : 0.5) * (face.length - length)};
}
} // namespace

template <int dim>
LinkAnswer<dim> answer(const Network<dim>& network, const ActiveLink<dim>& active, const Motion<dim>& motion)
{
  static_assert(dim == 2);
  const Link<dim>& link = network.links()[active.link];
  const double k_n = link.normal_stiffness;
  const double k_s = link.shear_stiffness;
  // A pair without a face touches at a point: no slope, no moment.
  const FaceElement<dim> point{{}, 2.0, 0.0};
  const double slope = link.has_face ? motion[2] : 0.0;

  LinkAnswer<dim> result;
  result.segments.resize(link.n_segments);
  for (std::uint32_t i = 0; i < link.n_segments; ++i)
    {
      const FaceElement<dim>& element = link.has_face ? network.elements()[i] : point;
      const double r = link.half_length;
      const flat_joint::Segment<2, double> face{k_n, k_s, element.area * r, network.thickness(), link.friction};
      const double area = face.area();
      const auto rows = element_rows(element, r);
      const Vector<dim> now = rows * motion;
      const Vector<dim> before = rows * active.motion;
      const SegmentHistory<dim>& old = active.segments[i];
      SegmentAnswer<dim>& segment = result.segments[i];

      if (old.bonded)
        {
          segment.normal_stress = k_n * now[0]; // (10)
          for (int c = 0; c < dim - 1; ++c)
            segment.shear_stress[c] = -k_s * now[c + 1]; // (13), the whole way since rest
          const auto stiffness =
            bonded_element_stiffness(link, rows, area, element.second_moment * r * r * r * network.thickness());
          result.forces += stiffness * motion;
          result.tangent += stiffness;
          result.stored_energy += 0.5 * motion.dot(stiffness * motion);
          continue;
        }

      flat_joint::SegmentMotion<dim, double> step;
      step.gap_before = link.opening + before[0];
      step.gap = link.opening + now[0];
      step.slope = slope;
      for (int c = 0; c < dim - 1; ++c)
        step.shear_increment[c] = now[c + 1] - before[c + 1];
      const auto update = flat_joint::update<dim, double>(face, {0.0, 0.0, 0.0}, {old.shear_stress, false}, step);
      segment.normal_stress = mean_stress(face, update.normal);
      segment.shear_stress = update.state.shear_stress;

      Vector<dim> force;
      force[0] = -update.normal.force;
      for (int c = 0; c < dim - 1; ++c)
        force[c + 1] = -segment.shear_stress[c] * area;
      result.forces += rows.transpose() * force;
      if (link.has_face)
        result.forces[2] -= update.normal.moment;
      result.stored_energy += flat_joint::normal_energy(face, step.gap, step.slope, false) +
                              0.5 * shear_squared<dim>(segment.shear_stress) * area / k_s;
      bool sticks = true;
      const double share = flat_joint::closed_share(step.gap_before, step.gap);
      for (int c = 0; c < dim - 1; ++c)
        {
          const double trial = old.shear_stress[c] - k_s * share * step.shear_increment[c];
          segment.slip[c] = (trial - segment.shear_stress[c]) / k_s;
          sticks = sticks && trial == segment.shear_stress[c];
        }

      const Pressing part = pressing_part(face, step.gap, step.slope);
      if (part.share == 0.0)
        continue;
      FaceElement<dim> pressing = element;
      pressing.offset[0] += part.offset / r;
      const auto part_rows = element_rows(pressing, r);
      const double part_length = part.share * face.length;
      const double second_moment =
        link.has_face ? part_length * part_length * part_length * network.thickness() / 12.0 : 0.0;
      result.tangent += k_n * part.share * area * part_rows.row(0).transpose() * part_rows.row(0);
      result.tangent(2, 2) += k_n * second_moment;
      if (sticks && step.gap < 0.0)
        result.tangent += k_s * area * rows.bottomRows(dim - 1).transpose() * rows.bottomRows(dim - 1);
    }
  return result;
}

template LinkAnswer<2> answer<2>(const Network<2>&, const ActiveLink<2>&, const Motion<2>&);
} // namespace feldspar
