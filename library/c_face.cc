#define FELDSPAR_IMPLEMENTS_FACE
#include <feldspar/feldspar.h>
#pragma GCC visibility push(default)
#include <feldspar/feldspar_c.h>
#pragma GCC visibility pop

#include <span>
#include <string>
#include <type_traits>
#include <vector>

/// The face in C over that in C++: handles are objects, errors a text of their thread.
struct feldspar_input
{
  feldspar::v1::Input input;
};

struct feldspar_specimen
{
  feldspar::v1::Specimen specimen;
};

struct feldspar_volumes
{
  feldspar::v1::Volumes volumes;
};

namespace
{
thread_local std::string last_error;

/// Does work of the face; whatever it throws becomes the last error, and `failed` is returned.
template <typename Work>
auto caught(const std::invoke_result_t<Work> failed, const Work& work)
{
  try
    {
      return work();
    }
  catch (const std::exception& error)
    {
      last_error = error.what();
    }
  catch (...)
    {
      last_error = "the library failed for a reason that it does not know";
    }
  return failed;
}
} // namespace

const char* feldspar_last_error() { return last_error.c_str(); }

feldspar_input* feldspar_input_new(const char* const file)
{
  return caught(
    nullptr, [&] { return new feldspar_input{file ? feldspar::v1::Input(std::string(file)) : feldspar::v1::Input()}; });
}

int feldspar_input_set(feldspar_input* const input, const char* const entry, const char* const value)
{
  return caught(1, [&] {
    input->input.set(entry, value);
    return 0;
  });
}

void feldspar_input_free(feldspar_input* const input) { delete input; }

feldspar_specimen* feldspar_specimen_new(const feldspar_input* const input, const std::uint64_t seed)
{
  return caught(nullptr, [&] { return new feldspar_specimen{feldspar::v1::Specimen(input->input, seed)}; });
}

void feldspar_specimen_free(feldspar_specimen* const specimen) { delete specimen; }

feldspar_volumes* feldspar_volumes_new(const feldspar_specimen* const* const specimens, const std::size_t n_specimens,
                                       const feldspar_input* const input, const std::size_t n,
                                       const std::size_t* const assigned)
{
  return caught(nullptr, [&] {
    std::vector<feldspar::v1::Specimen> bodies;
    for (const feldspar_specimen* const one : std::span(specimens, n_specimens))
      bodies.push_back(one->specimen);
    return new feldspar_volumes{
      feldspar::v1::Volumes(bodies, input->input, n, std::span(assigned, assigned ? n : std::size_t(0)))};
  });
}

int feldspar_volumes_dimension(const feldspar_volumes* const volumes) { return volumes->volumes.dimension(); }

int feldspar_volumes_update(feldspar_volumes* const volumes, const double* const strains, const std::uint64_t parent,
                            const int bonds_break, double* const stresses, double* const tangents,
                            std::uint64_t* const token)
{
  return caught(1, [&] {
    const std::size_t n_voigt = volumes->volumes.dimension() == 2 ? 3 : 6;
    const std::size_t n = volumes->volumes.size() * n_voigt;
    *token = volumes->volumes.update(std::span(strains, n), parent, std::span(stresses, n),
                                     std::span(tangents, tangents ? n * n_voigt : std::size_t(0)), bonds_break != 0);
    return 0;
  });
}

void feldspar_volumes_free(feldspar_volumes* const volumes) { delete volumes; }
