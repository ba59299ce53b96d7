#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

/// The readers of files that come from outside, as one list for libFuzzer (fuzz_main.cc) and for the replay of its corpora
/// (replay_test.cc).
namespace feldspar::tests
{
struct FuzzedReader
{
  std::string name; ///< and of its folder in tests/fuzz/corpus
  /// Reads a content, by way of files in a folder that is its own. Throws InputError for what it refuses.
  std::function<void(const std::string& content, const std::filesystem::path& folder)> read;
};

const std::vector<FuzzedReader>& fuzzed_readers();

/// Outcome of reading a content.
struct Reading
{
  bool accepted;
  std::string words; ///< of the refusal
  /// Rule for words that the refusal breaks (one line, printable, not longer than a message); empty if it keeps all.
  std::string objection;
};

/// Lets every exception but InputError through.
Reading read(const FuzzedReader& reader, const std::string& content, const std::filesystem::path& folder);
} // namespace feldspar::tests
