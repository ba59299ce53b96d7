#include "dem/dynamics/force_sum.h"

#include "base/parallel.h"

#include <array>

namespace feldspar
{
template <int dim>
void sum_forces(Specimen<dim>& body, const std::size_t n_own, const Incidence& joints_of, const Touches<dim>& touches)
{
  auto& grains = body.grains;
  const auto& joints = body.joints;
  const Incidence& touches_of = touches.incidence();
  for_each_block(n_own, [&](std::size_t, const std::size_t begin, const std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      {
        std::array<double, dim> force{};
        std::array<double, n_rotations<dim>> couple{};
        for (auto e = joints_of.first[i]; e < joints_of.first[i + 1]; ++e)
          {
            // Answers of joints with grains of lower numbers lie far back: asked for some grains ahead.
            if (constexpr std::size_t ahead = 32; e + ahead < joints_of.entries.size())
              {
                const double* const later = joints.answer.at(0, joints_of.entries[e + ahead] / 2);
                __builtin_prefetch(later);
                __builtin_prefetch(later + joints.n_answer_rows - 1);
              }
            const std::uint32_t entry = joints_of.entries[e];
            const std::uint32_t j = entry / 2;
            const bool is_second = entry % 2;
            const double direction = is_second ? 1.0 : -1.0;
            const double* const answer = joints.answer.at(0, j);
            for (int c = 0; c < dim; ++c)
              force[c] += direction * answer[joints.first_force + c];
            for (int c = 0; c < n_rotations<dim>; ++c)
              couple[c] += answer[(is_second ? joints.first_couple_2 : 0) + c];
          }
        for (auto e = touches_of.first[i]; e < touches_of.first[i + 1]; ++e)
          {
            const std::uint32_t entry = touches_of.entries[e];
            if (!touches.is_touching(entry / 2))
              continue;
            const Touch<dim>& touch = touches.list()[entry / 2];
            const double direction = entry % 2 ? 1.0 : -1.0;
            for (int c = 0; c < dim; ++c)
              force[c] += direction * touch.force[c];
            for (int c = 0; c < n_rotations<dim>; ++c)
              couple[c] += (entry % 2 ? touch.couple_2 : touch.couple_1)[c];
          }
        for (int c = 0; c < dim; ++c)
          grains.force[c][i] = force[c];
        for (int c = 0; c < n_rotations<dim>; ++c)
          grains.couple[c][i] = couple[c];
      }
  });
}

template void sum_forces<2>(Specimen<2>&, std::size_t, const Incidence&, const Touches<2>&);
template void sum_forces<3>(Specimen<3>&, std::size_t, const Incidence&, const Touches<3>&);
} // namespace feldspar
