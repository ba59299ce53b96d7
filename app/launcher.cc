// The program `feldspar` of a package that serves several processors: runs the one of them that this processor is made for.
// Built without any instruction that only some processors have.

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace
{
/// Levels of instructions as compilers name them (psABI of x86-64). Each function asks only for what separates its
/// level from the one before.
bool has_avx2()
{
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") &&
         __builtin_cpu_supports("fma");
}

bool has_avx512()
{
  return has_avx2() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}

struct Level
{
  const char* name;
  bool (*is_known)();
};

constexpr Level levels[] = {{"x86-64-v4", has_avx512}, {"x86-64-v3", has_avx2}};
} // namespace

int main(int, char** arguments)
{
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error)
    {
      std::fprintf(stderr, "feldspar: /proc/self/exe: cannot be read (%s)\n", error.message().c_str());
      return 3;
    }
  const auto folder = self.parent_path().parent_path() / "libexec/feldspar";
  for (const Level& level : levels)
    if (const auto program = folder / level.name / self.filename();
        level.is_known() && std::filesystem::exists(program, error))
      {
        execv(program.c_str(), arguments);
        std::fprintf(stderr, "feldspar: %s: cannot be run (%s)\n", program.c_str(), std::strerror(errno));
        return 3;
      }
  std::fprintf(
    stderr, "feldspar: %s: no program for this processor, which has %s; build Feldspar from source on this machine\n",
    folder.c_str(),
    has_avx512() ? "AVX-512"
    : has_avx2() ? "AVX2"
                 : "no AVX2");
  return 2;
}
