#pragma once

#include <string>
#include <vector>

namespace feldspar::tests
{
/// A command of a page that the tests do not run, and why. A batch script is named by its first line.
struct NotRun
{
  std::string page;    ///< below the root of the tree
  std::string command; ///< as it is printed, without its comment
  std::string why;
};

inline const std::vector<NotRun> commands_not_run{
  {"README.md", "./bootstrap.sh demo", "installs packages and builds the program; minutes"},
  {"README.md", "./bootstrap.sh test", "is what runs this test"},
  {"README.md", "./bootstrap.sh install", "installs packages and the program on this system"},
  {"CONTRIBUTING.md", "cmake --preset release && cmake --build --preset release && ctest --preset release",
   "is what runs this test"},
  {"CONTRIBUTING.md", "scripts/compare-bits.py OLD/feldspar NEW/feldspar", "needs another build of the program"},
  {"CONTRIBUTING.md", "scripts/compare-speed.py OLD_BUILD NEW_BUILD", "needs another build of the program"},
  {"CONTRIBUTING.md", "scripts/compare-builds.sh OLD_COMMIT NEW_COMMIT", "builds the program twice; an hour"},
  {"docs/library.md", "cmake -S examples/library -B build/examples -DCMAKE_PREFIX_PATH=/usr/local",
   "needs an installed library; tests/library/installed.sh runs it"},
  {"docs/library.md", "cmake --build build/examples", "needs that configuration"},
  {"docs/library.md", "build/examples/uniaxial_compression", "needs that build"},
  {"examples/other-codes/README.md", "python3 examples/other-codes/getfem_sample.py",
   "is run by tests/python/materials_test.py"},
  {"examples/other-codes/README.md", "python3 examples/other-codes/dolfinx_sample.py", "needs python3-dolfinx-real"},
  {"examples/other-codes/README.md", "run-escript examples/other-codes/escript_sample.py", "needs python3-escript"},
  {"examples/other-codes/README.md", "scripts/build-calculix.sh calculix", "builds another program; minutes"},
  {"examples/other-codes/README.md", "python3 examples/other-codes/calculix_sample.py calculix/ccx",
   "needs that build"},
  {"examples/other-codes/README.md", "python3 examples/other-codes/calculix_sample.py calculix/ccx cost", "the same"},
  {"examples/other-codes/README.md", "python3 examples/other-codes/calculix_element.py calculix/ccx", "the same"},
  {"examples/other-codes/README.md", "python3 examples/other-codes/calculix_plate.py calculix/ccx", "the same"},
  {"docs/cluster.md",
   "cmake -S . -B build/cluster -G Ninja -DBUILD_TESTING=OFF -DFELDSPAR_LEVEL=x86-64-v3 -DDEAL_II_DIR=DEALII "
   "-DCMAKE_PREFIX_PATH=LIBRARIES",
   "needs the libraries of a cluster"},
  {"docs/cluster.md", "cmake --build build/cluster --parallel 4", "builds the program; minutes"},
  {"docs/cluster.md", "cmake --install build/cluster --prefix DIR --strip", "needs that build"},
  {"docs/cluster.md", "#!/bin/bash", "is run by SeveralRanks.FollowEachOtherUnderSlurm"},
  {"examples/calibrate-hidden-rocks/README.md",
   "python3 examples/calibrate-hidden-rocks/study.py build/release/app/feldspar FOLDER",
   "an hour and a half; Calibrate.* run a calibration"},
  {"examples/calibrate-hidden-rocks/README.md",
   "python3 examples/calibrate-hidden-rocks/verdicts.py build/release/app/feldspar FOLDER",
   "a quarter of an hour; Calibrate.* run a calibration"},
  {"examples/multiscale-and-grains/README.md",
   "python3 examples/multiscale-and-grains/study.py build/release/app/feldspar all",
   "an hour; ReducedStudy runs pieces of it"},
  {"examples/plate-with-hole/README.md", "python3 examples/plate-with-hole/study.py build/release/app/feldspar all",
   "twenty minutes; the commands above it begin its runs, and PlateWithHole makes its tables"},
  {"examples/rve-beishan/README.md", "examples/rve-beishan/free-sides-study.sh build/release/app/feldspar",
   "refuses a tree with changes; ten minutes"},
  {"examples/rve-beishan/README.md", "examples/rve-beishan/size-study.sh build/release/app/feldspar",
   "refuses a tree with changes; minutes"},
  {"benchmarks/README.md", "python3 benchmarks/whole_tests.py OLD_BUILD NEW_BUILD --of samples",
   "needs another build of the program"},
  {"benchmarks/README.md", "python3 benchmarks/whole_tests.py OLD_BUILD NEW_BUILD --of packings",
   "needs another build of the program"},
  {"benchmarks/README.md", "build/release/benchmarks/dynamics_benchmark", "measures an idle machine; minutes"},
  {"benchmarks/README.md", "FELDSPAR_THREADS=2 build/release/benchmarks/dynamics_benchmark --benchmark_filter=200000",
   "measures an idle machine; minutes"},
  {"benchmarks/README.md", "python3 benchmarks/whole_tests.py OLD_BUILD NEW_BUILD",
   "needs another build of the program"},
  {"benchmarks/README.md", "benchmarks/profile.sh build/release/app/feldspar",
   "needs perf, which is in no package of the tests"},
  {"benchmarks/README.md", "python3 benchmarks/shared_body.py build/release", "measures an idle machine; minutes"},
  {"benchmarks/README.md", "python3 benchmarks/load.py build/release/app/feldspar", "half an hour, 9 GB"},
  {"benchmarks/README.md", "python3 benchmarks/soak.py build/release/app/feldspar", "an hour"},
  {"benchmarks/README.md", "python3 benchmarks/fuzz.py", "an hour; the integration fuzzes for a minute"},
  {"benchmarks/README.md", "apt-get install --no-install-recommends yade esys-particle", "changes the system"},
  {"benchmarks/README.md", "python3 benchmarks/peers/peers.py build/release", "needs yade and esys-particle"},
  {"benchmarks/README.md", "python3 benchmarks/plain.py build/release",
   "minutes; PlainLaboratory runs its plain code beside the engine"},
  {"benchmarks/README.md", "build/release/benchmarks/rve_costs > benchmarks/results/rve-costs.json",
   "measures an idle machine; a minute"},
  {"benchmarks/README.md", "python3 benchmarks/rank_queue.py", "minutes; RankQueue runs a piece of it"},
  {"benchmarks/README.md", "build/release/benchmarks/space_benchmark", "measures an idle machine; minutes"},
  {"benchmarks/README.md", "FELDSPAR_THREADS=2 build/release/benchmarks/space_benchmark",
   "measures an idle machine; minutes"},
};
} // namespace feldspar::tests
