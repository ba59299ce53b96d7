#include "tests/fuzz/readers.h"
#include "tests/temporary_folder.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace
{
using namespace feldspar::tests;

const FuzzedReader& wanted_reader()
{
  const char* const name = std::getenv("FELDSPAR_FUZZED_READER");
  for (const FuzzedReader& reader : fuzzed_readers())
    if (name && reader.name == name)
      return reader;
  std::fputs("FELDSPAR_FUZZED_READER must be one of:", stderr);
  for (const FuzzedReader& reader : fuzzed_readers())
    std::fprintf(stderr, " %s", reader.name.c_str());
  std::fputs("\n", stderr);
  std::exit(2);
}
} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* const data, const std::size_t size)
{
  static const FuzzedReader& reader = wanted_reader();
  static const TemporaryFolder folder;
  const Reading reading = read(reader, std::string(data, data + size), folder.path());
  if (!reading.objection.empty())
    {
      std::fprintf(stderr, "%s: %s\n", reading.objection.c_str(), reading.words.c_str());
      std::abort();
    }
  return 0;
}
