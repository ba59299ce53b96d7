#include "interfaces/points.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <sstream>
#include <string_view>

#include <dlfcn.h>

/// Abaqus' interface of user materials, UMAT, as CalculiX calls it too: the material's name is that of an input of Feldspar.
/// docs/material.md has the conventions.
namespace feldspar::interfaces
{
namespace
{
/// Ends the job with one line in its log.
[[noreturn]] void end_job(const std::string& sentence)
{
  std::printf("\n *ERROR in FELDSPAR: %s\n", sentence.c_str());
  std::fflush(stdout);
  std::_Exit(201); // as CalculiX ends on an error
}

std::string trimmed(const std::string_view text)
{
  const std::size_t end = text.find_last_not_of(std::string_view(" \0", 2));
  return std::string(text.substr(0, end == std::string_view::npos ? 0 : end + 1));
}

/// The part of a name such as @ABAQUS_FELDSPAR@BEISHAN that is the material's.
std::string material_of(const std::string_view name)
{
  const std::string whole = trimmed(name.substr(0, name.find(' ')));
  return whole.substr(whole.rfind('@') + 1);
}

/// Folder and name of the job: Abaqus' own functions say them, in CalculiX the command line does.
std::string job_name()
{
  using Ask = void(char*, int*, int);
  const auto ask = [](const char* const function) {
    std::array<char, 256> text{};
    int length = 0;
    if (auto* const found = reinterpret_cast<Ask*>(dlsym(RTLD_DEFAULT, function)))
      found(text.data(), &length, int(text.size()));
    return std::string(text.data(), std::size_t(std::max(0, length)));
  };
  if (const std::string name = ask("getjobname_"); !name.empty())
    return (std::filesystem::path(ask("getoutdir_")) / name).string();
  std::ifstream file("/proc/self/cmdline");
  std::stringstream whole;
  whole << file.rdbuf();
  std::vector<std::string> words;
  for (std::string word; std::getline(whole, word, '\0');)
    words.push_back(word);
  for (std::size_t k = 1; k + 1 < words.size(); ++k)
    if (words[k] == "-i" || words[k] == "-jobname" || words[k] == "-o")
      return words[k + 1];
  return words.size() > 1 ? words.back() : "job";
}

/// Points of a material, made at the first call that names it.
Points& points_of(const std::string_view name, const Breaking breaking)
{
  static thread_local std::pair<std::string, Points*> last;
  if (last.second != nullptr && last.first == name)
    return *last.second;
  static std::mutex one_at_a_time;
  static std::map<std::string, std::unique_ptr<Points>> all;
  const std::lock_guard lock(one_at_a_time);
  const std::string material = material_of(name);
  auto& points = all[material];
  if (!points)
    {
      const std::string input = input_file_of(material);
      points = std::make_unique<Points>(
        input, job_name() + "." + std::filesystem::path(input).stem().string() + ".feldspar", breaking);
    }
  last = {std::string(name), points.get()};
  return *points;
}

/// The places of Feldspar's components among the caller's: direct ones first, then shears xy, xz, yz. -1: none.
std::array<int, 6> places_of(const int n_direct, const int n_shear)
{
  return {0, 1, n_direct > 2 ? 2 : -1, n_shear > 2 ? n_direct + 2 : -1, n_shear > 1 ? n_direct + 1 : -1, n_direct};
}

/// A call of UMAT, in the names of Abaqus' manual.
struct Call
{
  double* stress;
  double* statev;
  double* ddsdde;
  const double* stran;
  const double* dstran;
  int ndi;
  int nshr;
  int ntens;
  int nstatv;
  double* pnewdt;
};

/// Across the plane a volume of discs is free: its own stress there is none, and a foreign code that expands plane elements
/// into space finds a stiffness that nothing loads.
void add_free_directions(const Call& call, const std::array<int, 6>& places, const double stiffness)
{
  for (const int component : {2, 3, 4})
    if (const int at = places[std::size_t(component)]; at >= 0)
      {
        const double modulus = component == 2 ? stiffness : 0.5 * stiffness;
        call.stress[at] = modulus * (call.stran[at] + call.dstran[at]);
        call.ddsdde[at + call.ntens * at] = modulus;
      }
}

void respond(Points& points, const PointName name, const Call& call)
{
  const bool is_plane = points.dimension() == 2;
  if (!is_plane && (call.ndi < 3 || call.nshr < 1))
    end_job(
      "a volume of spheres needs elements in space, of plane strain or with an axis; plane stress is that of discs");
  const auto places = places_of(call.ndi, call.nshr);
  const std::array<int, 6> in_plane{places[0], places[1], places[5], -1, -1, -1};
  const auto& own = is_plane ? in_plane : places;
  const std::size_t n = is_plane ? 3 : 6;
  std::array<double, 6> before{}, strain{};
  for (std::size_t c = 0; c < n; ++c)
    if (own[c] >= 0)
      {
        before[c] = call.stran[own[c]];
        strain[c] = call.stran[own[c]] + call.dstran[own[c]];
      }
  const Answer& answer =
    points.respond(name, std::uint64_t(call.statev[0]), std::span(before).first(n), std::span(strain).first(n));
  std::fill_n(call.ddsdde, call.ntens * call.ntens, 0.0);
  for (std::size_t a = 0; a < n; ++a)
    if (own[a] >= 0)
      {
        call.stress[own[a]] = answer.stress[a];
        for (std::size_t b = 0; b < n; ++b)
          if (own[b] >= 0)
            call.ddsdde[own[a] + call.ntens * own[b]] = answer.tangent[n * a + b];
      }
  if (is_plane)
    add_free_directions(call, places, answer.tangent[0]);
  if (!answer.in_equilibrium)
    {
      std::printf(" FELDSPAR: element %u, point %u finds no equilibrium; the increment is cut to a quarter\n",
                  name.element, name.point);
      *call.pnewdt = 0.25;
      return;
    }
  std::copy_n(answer.states.begin(), std::min(std::size_t(call.nstatv), n_state_variables), call.statev);
}
} // namespace
} // namespace feldspar::interfaces

extern "C" FELDSPAR_PUBLIC void umat_(double* stress, double* statev, double* ddsdde, double* /*sse*/, double* /*spd*/,
                                      double* /*scd*/, double* /*rpl*/, double* /*ddsddt*/, double* /*drplde*/,
                                      double* /*drpldt*/, const double* stran, const double* dstran,
                                      const double* /*time*/, const double* /*dtime*/, const double* /*temp*/,
                                      const double* /*dtemp*/, const double* /*predef*/, const double* /*dpred*/,
                                      const char* cmname, const int* ndi, const int* nshr, const int* ntens,
                                      const int* nstatv, const double* props, const int* nprops,
                                      const double* /*coords*/, const double* /*drot*/, double* pnewdt,
                                      const double* /*celent*/, const double* /*dfgrd0*/, const double* /*dfgrd1*/,
                                      const int* noel, const int* npt, const int* /*layer*/, const int* /*kspt*/,
                                      const int* jstep, const int* /*kinc*/, const int cmname_length)
{
  using namespace feldspar::interfaces;
  try
    {
      const std::string_view name(cmname, std::size_t(cmname_length > 0 ? cmname_length : 80));
      if (jstep[2] != 0)
        end_job("material " + material_of(name) + ": its strains are small; leave out NLGEOM");
      if (*nstatv < 1)
        end_job("material " + material_of(name) + ": needs a state variable for its token; give *DEPVAR 11 (or 1)");
      const bool each_iteration = *nprops > 0 && props[0] != 0.0;
      respond(points_of(name, each_iteration ? Breaking::each_iteration : Breaking::lagged),
              {std::uint32_t(*noel), std::uint32_t(*npt)},
              {stress, statev, ddsdde, stran, dstran, *ndi, *nshr, *ntens, *nstatv, pnewdt});
    }
  catch (const std::exception& error)
    {
      end_job(error.what());
    }
}
