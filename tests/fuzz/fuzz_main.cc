#include "tests/fuzz/readers.h"
#include "tests/temporary_folder.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
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

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

/// Now and then repeats a piece of the input very often: what libFuzzer's own steps do not make, depth and length. Else one of
/// its own, which knows the dictionary.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* const data, const std::size_t size,
                                               const std::size_t max_size, const unsigned int seed)
{
  constexpr unsigned int one_in = 64;
  std::mt19937 random(seed);
  if (size == 0 || random() % one_in != 0)
    return LLVMFuzzerMutate(data, size, max_size);
  constexpr std::size_t longest = 40;
  constexpr unsigned int most_doublings = 17;
  const std::string whole(data, data + size);
  const std::size_t at = random() % size;
  const std::string piece = whole.substr(at, 1 + random() % longest);
  const std::size_t n = std::min(std::size_t(1) << random() % most_doublings, (max_size - size) / piece.size());
  std::string longer = whole.substr(0, at);
  for (std::size_t k = 0; k < n; ++k)
    longer += piece;
  longer += whole.substr(at);
  std::copy(longer.begin(), longer.end(), data);
  return longer.size();
}

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
