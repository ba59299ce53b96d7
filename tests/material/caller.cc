#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

/// Calls UMAT as CalculiX 2.20 does, of which this program has the order of calls: four a point and increment, each with the
/// state variables that were accepted; those of the last one of an increment that converged come back. After a restart they are
/// zero, and the strains are there.
///
///     caller -i JOB MATERIAL MODE FIRST LAST OF THREADS [cut] [nlgeom] [far]
///
/// runs the increments FIRST to LAST of so many; FIRST above 1: after a restart. cut: each fifth increment is
/// begun twice as long, and cut by the program. far: the numbers of the elements begin at two thousand million. Writes a row
/// for each increment and point: its stresses, bit by bit, and the state variables but for the token.
extern "C" void umat_(double* stress, double* statev, double* ddsdde, double* sse, double* spd, double* scd,
                      double* rpl, double* ddsddt, double* drplde, double* drpldt, const double* stran,
                      const double* dstran, const double* time, const double* dtime, const double* temp,
                      const double* dtemp, const double* predef, const double* dpred, const char* cmname,
                      const int* ndi, const int* nshr, const int* ntens, const int* nstatv, const double* props,
                      const int* nprops, const double* coords, const double* drot, double* pnewdt, const double* celent,
                      const double* dfgrd0, const double* dfgrd1, const int* noel, const int* npt, const int* layer,
                      const int* kspt, const int* jstep, const int* kinc, int cmname_length);

namespace
{
constexpr int n_tensor = 6;
constexpr int n_states = 11;
constexpr int n_points = 4;
using Components = std::array<double, n_tensor>;
using States = std::array<double, n_states>;

/// Strains at the end of the path: xx, yy, zz, xy, xz, yz.
constexpr std::array<Components, n_points> ends{Components{-3e-5, 3e-4, 0, 0, 0, 0},
                                                Components{1e-4, -1.2e-3, 0, 0, 0, 0}, Components{0, 0, 0, 8e-4, 0, 0},
                                                Components{3e-4, -3e-5, 0, 1e-4, 0, 0}};

struct Point
{
  Components stress{};
  Components strain{};
  States states{};
};

/// One call; returns the state variables and leaves the accepted ones.
States called(const std::string& material, const double mode, const bool large, const int element, const Point& point,
              const Components& wanted, Components& stress)
{
  States states = point.states;
  Components increment;
  for (int c = 0; c < n_tensor; ++c)
    increment[std::size_t(c)] = wanted[std::size_t(c)] - point.strain[std::size_t(c)];
  std::array<char, 80> name;
  name.fill(' ');
  const std::string whole = "@ABAQUS_FELDSPAR@" + material;
  std::copy(whole.begin(), whole.end(), name.begin());
  std::array<double, 36> tangent{};
  stress = point.stress;
  double pnewdt = 1.0;
  const int ndi = 3, nshr = 3, ntens = n_tensor, nstatv = n_states, nprops = 1, npt = 1, none = 0;
  const std::array<int, 4> jstep{1, 1, large ? 1 : 0, 0};
  umat_(stress.data(), states.data(), tangent.data(), nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr,
        point.strain.data(), increment.data(), nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, name.data(), &ndi,
        &nshr, &ntens, &nstatv, &mode, &nprops, nullptr, nullptr, &pnewdt, nullptr, nullptr, nullptr, &element, &npt,
        &none, &none, jstep.data(), &none, int(name.size()));
  return states;
}
} // namespace

int main(int n_words, char** words)
{
  n_words -= 2; // -i JOB, which the material reads
  words += 2;
  if (n_words < 7)
    return 2;
  const std::string material = words[1];
  const double mode = std::atof(words[2]);
  const int first = std::atoi(words[3]), last = std::atoi(words[4]), of = std::atoi(words[5]);
  const std::size_t n_threads = std::size_t(std::atoi(words[6]));
  bool cuts = false, large = false;
  int first_element = 1;
  for (int k = 7; k < n_words; ++k)
    {
      cuts = cuts || std::strcmp(words[k], "cut") == 0;
      large = large || std::strcmp(words[k], "nlgeom") == 0;
      if (std::strcmp(words[k], "far") == 0)
        first_element = 2000000000;
    }
  const auto strain_at = [&](const std::size_t p, const double increment) {
    Components strain = ends[p];
    for (double& component : strain)
      component *= increment / of;
    return strain;
  };
  std::array<Point, n_points> points;
  if (first > 1)
    for (std::size_t p = 0; p < n_points; ++p)
      points[p].strain = strain_at(p, first - 1);
  for (int k = first; k <= last; ++k)
    {
      const auto of_thread = [&](const std::size_t thread) {
        for (std::size_t p = thread; p < n_points; p += n_threads)
          {
            Point& point = points[p];
            const int element = first_element + int(p);
            Components stress;
            if (cuts && k % 5 == 0)
              called(material, mode, large, element, point, strain_at(p, k + 1), stress);
            States states{};
            for (const double share : {0.9, 1.0, 1.0, 1.0})
              states = called(material, mode, large, element, point, strain_at(p, k - 1 + share), stress);
            point = {stress, strain_at(p, k), states};
          }
      };
      std::vector<std::thread> threads;
      for (std::size_t thread = 0; thread < n_threads; ++thread)
        threads.emplace_back(of_thread, thread);
      for (std::thread& thread : threads)
        thread.join();
      for (std::size_t p = 0; p < n_points; ++p)
        {
          std::printf("%d %d", k, int(p) + 1);
          for (const double component : points[p].stress)
            std::printf(" %a", component);
          for (int s = 1; s < n_states; ++s)
            std::printf(" %.6g", points[p].states[std::size_t(s)]);
          std::printf("\n");
        }
    }
  return 0;
}
