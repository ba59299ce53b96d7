#!/usr/bin/env python3
"""The speed-up of two cores over one for a sample that breaks, and the gain by cells that move.

    python3 benchmarks/many_ranks.py build/release/app/feldspar    # writes results/many-ranks.json

Fifty by a hundred millimetres of Beishan granite in 32 elements with 128 RVEs of some 240 discs: pressed until every
one is damaged, on one thread, two threads and two ranks; and pulled until it has torn, on one, two and four ranks. Times
by the clock mean nothing where other work goes on or there are more ranks than cores; processor time is that of all threads
and ranks, also of those that wait.
"""

import csv
import json
import os
import resource
import shutil
import subprocess
import sys
import tempfile

from on_ranks import ENVIRONMENT, committed_version, launcher

HERE = os.path.dirname(os.path.abspath(__file__))
INPUT = """subsection Specimen
  set Shape              = periodic
  set Width              = 25 mm
  set Height             = 25 mm
  set Packing relaxation = dynamics
end
subsection Sample
  set Width            = 50 mm
  set Height           = 100 mm
  set Elements across  = 4
  set Elements along   = 8
  set Realisations     = 4
  set Compression step = 1e-4
  set Tension step     = 1e-5
end
subsection Tests
  set List        = TEST
  set Stop strain = STOP
end
"""
SAMPLES = {"uniaxial_compression": "1.1e-3", "direct_tension": "2.4e-4"}
RUNS = {  # ranks, threads
    "uniaxial_compression": [(1, 1), (1, 2), (2, 1)],
    "direct_tension": [(1, 1), (1, 2), (2, 1), (4, 1)],
}


def run(feldspar, folder, test, n_ranks, n_threads):
    with open(os.path.join(folder, "sample.prm"), "w", encoding="utf-8") as file:
        file.write(INPUT.replace("TEST", test).replace("STOP", SAMPLES[test]))
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(
        launcher(n_ranks)
        + [feldspar, "multiscale", "sample.prm", "--quiet", "--force", "--output", "out", "--threads", str(n_threads)],
        cwd=folder,
        env=ENVIRONMENT,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        check=True,
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    with open(os.path.join(folder, "out", "summary.json"), encoding="utf-8") as file:
        of_test = json.load(file)["tests"][0]
    with open(os.path.join(folder, "out", "cracks.csv"), encoding="utf-8") as file:
        events = [row[:5] for row in csv.reader(file)]
    return events, {
        "test": test,
        "ranks": n_ranks,
        "threads": n_threads,
        "n_events": len(events) - 1,
        "steps": of_test["steps"],
        "clock_s": round(of_test["wall_time_s"], 1),  # without construction of the RVEs and report
        "processor_s": round(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, 1),
        "in_volumes": of_test["ranks"],
    }


def main():
    feldspar = os.path.abspath(sys.argv[1])
    version = committed_version(feldspar)
    folder = tempfile.mkdtemp(prefix="many-ranks-")
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        processor = next(line.split(":")[1].strip() for line in file if line.startswith("model name"))
    result = {"feldspar_version": version, "processor": processor, "n_processors": os.cpu_count(), "runs": []}
    for test, runs in RUNS.items():
        for n_ranks, n_threads in runs:
            events, one = run(feldspar, folder, test, n_ranks, n_threads)
            one["load"] = round(os.getloadavg()[0], 1)
            if n_ranks * n_threads == 1:
                alone, events_alone = one, events
            one["same_events"] = events == events_alone
            if n_ranks * n_threads <= os.cpu_count():
                one["speed_up_by_clock"] = round(alone["clock_s"] / one["clock_s"], 2)
            result["runs"].append(one)
            print(one, flush=True)
    with open(os.path.join(HERE, "results", "many-ranks.json"), "w", encoding="utf-8") as file:
        json.dump(result, file, indent=1)
        file.write("\n")
    shutil.rmtree(folder)


main()
