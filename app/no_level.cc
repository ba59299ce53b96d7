// In the place of the program's library on a processor for which a package has none.

#include <cstdio>

extern "C" int feldspar_main(int /*argc*/, char** /*argv*/)
{
  std::fputs(
    "feldspar: this processor has no AVX2, which the package needs; build Feldspar from source on this machine\n",
    stderr);
  return 2;
}
