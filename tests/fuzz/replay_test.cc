#include "tests/content.h"
#include "tests/fuzz/readers.h"
#include "tests/mutations.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

/// Contents that libFuzzer found, and those it began with, are read again: each is accepted, or refused in one
/// printable line.
namespace feldspar::tests
{
namespace
{
namespace fs = std::filesystem;

/// Files and contents.
std::map<fs::path, std::string> seeds_of(const FuzzedReader& reader)
{
  std::map<fs::path, std::string> seeds;
  for (const auto& entry : fs::directory_iterator(fs::path(FELDSPAR_SOURCE_DIR) / "tests/fuzz/corpus" / reader.name))
    seeds[entry.path()] = content(entry.path());
  return seeds;
}

class Corpus : public testing::TestWithParam<std::string>
{
};

TEST_P(Corpus, IsReadOrRefusedInOneLine)
{
  const TemporaryFolder folder;
  for (const FuzzedReader& reader : fuzzed_readers())
    if (reader.name == GetParam())
      {
        std::size_t n_accepted = 0;
        std::size_t n_refused = 0;
        for (const auto& [path, content] : seeds_of(reader))
          {
            const Reading reading = read(reader, content, folder.path());
            EXPECT_EQ(reading.objection, "") << path << ": " << reading.words;
            ++(reading.accepted ? n_accepted : n_refused);
          }
        // Seeds that the reader takes lead libFuzzer into it.
        EXPECT_GT(n_accepted, 0u);
        EXPECT_GT(n_refused, 0u);
      }
}

// Without libFuzzer's guidance, but in every build: damage of the seeds. FELDSPAR_MUTATIONS: of each seed, another number.
TEST_P(Corpus, DamagedIsReadOrRefusedInOneLine)
{
  const char* const wanted = std::getenv("FELDSPAR_MUTATIONS");
  const std::uint64_t n_mutations = wanted ? std::strtoull(wanted, nullptr, 10) : 100;
  const TemporaryFolder folder;
  for (const FuzzedReader& reader : fuzzed_readers())
    if (reader.name == GetParam())
      for (const auto& [path, whole] : seeds_of(reader))
        for (std::uint64_t seed = 0; seed < (reader.name == "mesh" ? n_mutations / 5 : n_mutations);
             ++seed) // a process each
          {
            const std::string content = Mutations(seed).of(whole);
            const Reading reading = read(reader, content, folder.path());
            EXPECT_EQ(reading.objection, "") << path << ", mutation " << seed << ": " << reading.words;
          }
}

std::vector<std::string> names()
{
  std::vector<std::string> all;
  for (const FuzzedReader& reader : fuzzed_readers())
    all.push_back(reader.name);
  return all;
}

INSTANTIATE_TEST_SUITE_P(OfEachReader, Corpus, testing::ValuesIn(names()),
                         [](const auto& reader) { return reader.param; });
} // namespace
} // namespace feldspar::tests
