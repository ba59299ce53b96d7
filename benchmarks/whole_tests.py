#!/usr/bin/env python3
"""Compares the speed of two builds in whole tests, by processor time (user).

    benchmarks/whole_tests.py OLD_BUILD NEW_BUILD [--of specimens|packings|samples] [--times N] [--json FILE]

OLD_BUILD and NEW_BUILD: build folders of two trees. Each test of SPECIMENS, of PACKINGS or of SAMPLES of finite elements, packing
and page included, runs in turns, old, new, new, old and so on, on one thread; the least processor time of N runs (3) of each build
counts. Compare within one run only. FILE gets the times, with the strengths and the numbers of cracks of both: of specimens they
are the same to the last bit as long as the order of no sum has changed.
"""

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../scripts"))
compare = __import__("compare-speed")

COMPRESSION = """
subsection Tests
  set List = uniaxial_compression
end
"""
TENSION = """
subsection Tests
  set List = direct_tension
end
"""


def discs(relaxation):
    """Table 1 of the flat-joint paper: some 1 950 discs, 4 100 joints of four segments."""
    return f"""
subsection Specimen
  set Packing relaxation = {relaxation}
end
"""


def spheres(relaxation, width, porosity):
    """A cylinder of this width [mm], twice as high; joints have eight elements. Walls leave more voids in a narrow one."""
    return f"""
subsection Specimen
  set Dimension          = 3
  set Shape              = cylinder
  set Width              = {width} mm
  set Height             = {2 * width} mm
  set Porosity           = {porosity}
  set Packing relaxation = {relaxation}
end
subsection Flat joint
  set Installation gap ratio = 0.05
end
"""


RATE_IN_SPACE = """
subsection Tests
  set Compression strain rate = 2.5 1/s
end
"""
SPECIMENS = {
    "plane": discs("static") + COMPRESSION,
    # Some 1 600 spheres, 4 900 joints.
    "space": spheres("static", 16, 0.39) + RATE_IN_SPACE + COMPRESSION,
}
# Packed by damped motion, which takes most of the time, and pulled.
PACKINGS = {
    "plane": discs("dynamics") + TENSION,
    # Some 650 spheres, 1 900 joints.
    "space": spheres("dynamics", 12, 0.40) + TENSION,
}

EXAMPLES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../examples")
# Inputs of examples, pressed nearly up to their peaks: an avalanche there would take most of the time.
SAMPLES = {
    # 32 cells of some 235 discs.
    "plane": ("multiscale-and-grains/sample.prm", ["Seeds/Seeds = 1", "Tests/Stop strain = 2.2e-3"]),
    # 16 cells of some 100 spheres.
    "section of a cylinder": ("multiscale-beishan-cylinder/compression.prm", ["Tests/Stop strain = 5.1e-3"]),
}


def of_specimen(text):
    """Returns the command for a specimen, and what stands on the line before the output."""

    def arguments(folder):
        path = os.path.join(folder, "test.prm")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return ["lab", path]

    return arguments


def of_sample(path, settings):
    return lambda _: ["multiscale", os.path.join(EXAMPLES, path)] + [
        word for setting in ["Tests/List = uniaxial_compression"] + settings for word in ("--set", setting)
    ]


TESTS = {
    "specimens": {name: of_specimen(text) for name, text in SPECIMENS.items()},
    "packings": {name: of_specimen(text) for name, text in PACKINGS.items()},
    "samples": {name: of_sample(*of) for name, of in SAMPLES.items()},
}


def timed(build, arguments):
    """Processor time [s] of a run, and its test."""
    with tempfile.TemporaryDirectory() as folder:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(
            [os.path.join(build, "app/feldspar")]
            + arguments(folder)
            + ["--output", folder + "/out", "--quiet", "--threads", "1"],
            check=True,
            stdout=subprocess.DEVNULL,
        )
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        with open(folder + "/out/summary.json", encoding="utf-8") as file:
            return after.ru_utime - before.ru_utime, json.load(file)["tests"][0]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--of", choices=TESTS, default="specimens")
    parser.add_argument("--times", type=int, default=3)
    parser.add_argument("--json")
    wanted = parser.parse_args()
    builds = (wanted.old, wanted.new)
    told = {}
    for name, arguments in TESTS[wanted.of].items():
        runs = {build: [] for build in builds}
        for k in range(wanted.times):
            for build in builds if k % 2 == 0 else reversed(builds):
                runs[build].append(timed(build, arguments))
        seconds = [min(run[0] for run in runs[build]) for build in builds]
        tests = [runs[build][0][1] for build in builds]
        told[name] = {
            **{key: tests[1][key] for key in ("n_grains", "n_joints") if key in tests[1]},
            "old_s": seconds[0],
            "new_s": seconds[1],
            "times_as_fast": seconds[0] / seconds[1],
            "old_peak_stress_Pa": tests[0]["peak_stress_Pa"],
            "new_peak_stress_Pa": tests[1]["peak_stress_Pa"],
            "old_n_cracks": tests[0]["n_tension_cracks"] + tests[0]["n_shear_cracks"],
            "new_n_cracks": tests[1]["n_tension_cracks"] + tests[1]["n_shear_cracks"],
        }
        print(f"{name}: {seconds[0]:.1f} s, {seconds[1]:.1f} s; {seconds[0] / seconds[1]:.2f} times as fast", flush=True)
    if wanted.json:
        made = {
            "processor": compare.processor(),
            "vector_instructions": compare.vector_instructions(wanted.new),
            "flags": compare.flags(wanted.new),
            "old": compare.version(wanted.old),
            "feldspar_version": compare.version(wanted.new),
            "times": wanted.times,
        }
        with open(wanted.json, "w", encoding="utf-8") as out:
            json.dump({**made, "tests": told}, out, indent=2)
            out.write("\n")


if __name__ == "__main__":
    main()
