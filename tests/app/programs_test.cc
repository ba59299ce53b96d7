// The program of a package for several processors runs the one that fits; and what each program loads.

#include "tests/app/run_command.h"
#include "tests/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace feldspar::tests
{
namespace
{
namespace fs = std::filesystem;

/// Returns whether the kernel says that this processor has these flags.
bool processor_has(const std::string& flags)
{
  std::ifstream info("/proc/cpuinfo");
  std::string line;
  while (std::getline(info, line) && !line.starts_with("flags"))
    ;
  std::istringstream words(line), wanted(flags);
  const std::set<std::string> known{std::istream_iterator<std::string>(words), {}};
  for (std::string flag; wanted >> flag;)
    if (!known.contains(flag))
      return false;
  return true;
}

TEST(Programs, LoadFiniteElementsAndStatisticsWhereTheyAreUsedOnly)
{
  // Libraries that the loader of the system would load.
  const TemporaryFolder folder;
  const auto libraries = [&](const std::string& program) {
    const fs::path place = fs::path(FELDSPAR_COMMAND).replace_filename(program);
    return run_command(folder.path(), fmt::format("LD_TRACE_LOADED_OBJECTS=1 '{}'", place.string())).output;
  };
  const auto loads = [&](const std::string& program, const std::string& library) {
    return libraries(program).find(library) != std::string::npos;
  };
  EXPECT_TRUE(loads("feldspar-multiscale", "libdeal.ii"));
  EXPECT_TRUE(loads("feldspar-calibrate", "libOT.so"));
  EXPECT_FALSE(loads("feldspar-calibrate", "libdeal.ii"));
  EXPECT_FALSE(loads("feldspar-multiscale", "libOT.so"));
  EXPECT_TRUE(loads("feldspar", "libhdf5"));
  for (const char* const library : {"libdeal.ii", "libpetsc", "libOT.so"})
    EXPECT_FALSE(loads("feldspar", library)) << library;
}

/// The folders in which a program's libraries are looked for, as readelf shows its dynamic section: RPATH and RUNPATH.
std::vector<std::string> library_folders(const std::string& dynamic_section)
{
  std::vector<std::string> folders;
  std::istringstream lines(dynamic_section);
  for (std::string line; std::getline(lines, line);)
    if (line.find("(RUNPATH)") != std::string::npos || line.find("(RPATH)") != std::string::npos)
      {
        const std::string path = line.substr(line.find('[') + 1, line.find(']') - line.find('[') - 1);
        for (std::size_t begin = 0; begin <= path.size();)
          {
            const std::size_t end = std::min(path.find(':', begin), path.size());
            folders.push_back(path.substr(begin, end - begin));
            begin = end + 1;
          }
      }
  return folders;
}

/// An empty name is the current folder, where anybody may have put a library.
void expect_whole_library_folders(const fs::path& program)
{
  const TemporaryFolder folder;
  const auto read = run_command(folder.path(), fmt::format("LC_ALL=C readelf -dW '{}'", program.string()));
  EXPECT_NE(read.output.find("(NEEDED)"), std::string::npos) << program << read.error;
  for (const std::string& one : library_folders(read.output))
    EXPECT_TRUE(one.starts_with('/')) << program << " looks for libraries in \"" << one << '"';
}

TEST(Programs, LookForLibrariesInNoFolderThatDependsOnTheCurrentOne)
{
  for (const char* const program : {"feldspar", "feldspar-calibrate", "feldspar-multiscale", "feldspar-launcher"})
    expect_whole_library_folders(fs::path(FELDSPAR_COMMAND).replace_filename(program));
  // Path from before: CMake ended it with an empty element.
  EXPECT_EQ(library_folders(" 0x000000000000001d (RUNPATH)            Library runpath: [/usr/lib:]\n"),
            (std::vector<std::string>{"/usr/lib", ""}));
  EXPECT_EQ(library_folders(" 0x000000000000000f (RPATH)              Library rpath: [:lib]\n"),
            (std::vector<std::string>{"", "lib"}));
}

TEST(Programs, GoOnAsAnotherOfTheSameVersionOrSayWhatIsMissing)
{
  const TemporaryFolder folder;
  const fs::path programs = fs::path(FELDSPAR_COMMAND).parent_path();
  fs::copy_file(FELDSPAR_COMMAND, folder.path() / "feldspar");
  std::ofstream(folder.path() / "rock.prm") << "subsection Specimen\n  set Width = 20 mm\nend\n";
  for (const auto& [words, program] : {std::pair("multiscale rock.prm", "feldspar-multiscale"),
                                       {"parameters --check rock.prm", "feldspar-multiscale"},
                                       {"calibrate rock.prm", "feldspar-calibrate"}})
    {
      const auto alone = run_command(folder.path(), fmt::format("./feldspar {}", words));
      EXPECT_EQ(alone.exit_code, 2);
      EXPECT_NE(alone.error.find(fmt::format("{}: cannot be run", program)), std::string::npos) << alone.error;
    }

  // Files as an installed package has them: the launcher, and the programs of a level.
  const fs::path level = folder.path() / "libexec/feldspar/x86-64-v3";
  fs::create_directories(level);
  fs::create_directory(folder.path() / "bin");
  fs::copy_file(FELDSPAR_LAUNCHER, folder.path() / "bin/feldspar");
  for (const char* const program : {"feldspar", "feldspar-multiscale"})
    fs::copy_file(programs / program, level / program);
  const std::string check = "bin/feldspar parameters --check rock.prm --for lab";
  const auto installed = run_command(folder.path(), check);
  EXPECT_EQ(installed.exit_code, 0) << installed.error;

  const auto of_another = run_command(folder.path(), "FELDSPAR_VERSION_OF_CALLER=0.0.1 " + check);
  EXPECT_EQ(of_another.exit_code, 2);
  EXPECT_NE(of_another.error.find("and feldspar of 0.0.1; build or install both anew"), std::string::npos)
    << of_another.error;
}

class Package
{
public:
  Package()
  {
    fs::create_directory(folder.path() / "bin");
    fs::copy_file(FELDSPAR_LAUNCHER, folder.path() / "bin/feldspar");
  }

  /// A program that says its level and what it was given.
  void add(const std::string& level) const
  {
    const fs::path place = folder.path() / "libexec/feldspar" / level;
    fs::create_directories(place);
    std::ofstream(place / "feldspar") << "#!/bin/sh\necho " << level << " \"$@\"\nexit 7\n";
    fs::permissions(place / "feldspar", fs::perms::owner_all);
  }

  Outcome run() const { return run_command(folder.path(), "bin/feldspar lab 'a rock.prm'"); }

private:
  TemporaryFolder folder;
};

TEST(Launcher, RunsTheProgramOfTheHighestLevelThatTheProcessorHas)
{
  const bool avx2 = processor_has("avx2 bmi1 bmi2 fma");
  const bool avx512 = avx2 && processor_has("avx512f avx512bw avx512cd avx512dq avx512vl");
  const Package package;
  const auto without = package.run();
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_NE(without.error.find("no program for this processor"), std::string::npos) << without.error;

  package.add("x86-64-v4");
  if (!avx512)
    {
      EXPECT_EQ(package.run().exit_code, 2);
    }
  package.add("x86-64-v3");
  const auto both = package.run();
  if (avx2)
    {
      EXPECT_EQ(both.exit_code, 7) << both.error;
      EXPECT_EQ(both.output, fmt::format("{} lab a rock.prm\n", avx512 ? "x86-64-v4" : "x86-64-v3"));
    }
}

TEST(Launcher, TakesALowerLevelWhereTheHigherOneIsNotInstalled)
{
  const Package package;
  package.add("x86-64-v3");
  const auto outcome = package.run();
  if (processor_has("avx2 bmi1 bmi2 fma"))
    {
      EXPECT_EQ(outcome.output, "x86-64-v3 lab a rock.prm\n");
    }
  else
    {
      EXPECT_EQ(outcome.exit_code, 2);
    }
}

// Installation of a build by ./bootstrap.sh install, and the parts of it that a user meets first.
TEST(Installation, HasProgramManualCompletionAndExamples)
{
  const TemporaryFolder folder;
  const Outcome installed =
    run_command(folder.path(), "umask 077; cmake --install '" FELDSPAR_BUILD_DIR "' --prefix usr --strip > installed");
  ASSERT_EQ(installed.exit_code, 0) << installed.error;
  // For everybody, whatever the umask of who installs or packs; bootstrap.sh sees to that of folders.
  EXPECT_EQ(run_command(folder.path(), "find usr -type f ! -perm -444").output, "");
  for (const auto& program : fs::directory_iterator(folder.path() / "usr/bin"))
    expect_whole_library_folders(program.path());
  const Outcome version = run_command(folder.path(), "usr/bin/feldspar version");
  EXPECT_EQ(version.exit_code, 0) << version.error;
  EXPECT_EQ(version.output, run_command(folder.path(), "'" FELDSPAR_COMMAND "' version").output);
  const Outcome checked = run_command(
    folder.path(), "usr/bin/feldspar parameters --check usr/share/doc/feldspar/examples/first-run/granite.prm");
  EXPECT_EQ(checked.exit_code, 0) << checked.error;
  const Outcome page = run_command(folder.path(), "cat usr/share/man/man1/feldspar.1");
  EXPECT_NE(page.output.find("calibrate"), std::string::npos);
  const Outcome completed =
    run_command(folder.path(), "bash -c '. usr/share/bash-completion/completions/feldspar && complete -p feldspar'");
  EXPECT_EQ(completed.exit_code, 0) << completed.error;
}
} // namespace
} // namespace feldspar::tests
