#!/usr/bin/env python3
"""Runs one laboratory test for an hour and watches the memory of the process.

    python3 benchmarks/soak.py build/release/app/feldspar            # an hour; writes results/soak.json
    python3 benchmarks/soak.py build/release/app/feldspar 36000 F    # a night; writes the file F

A specimen of Beishan granite (2 000 grains, one thread) is compressed so slowly that the test does not end: through its
peak, where contacts open and close and neighbours are searched anew, and on. It writes a checkpoint after every row of
the curve. At the end the run is interrupted, as by Ctrl-C.

Expected: after a warm-up of a sixth of the time the resident memory of the process stays within 1 % of its mean.
"""

import csv
import datetime
import json
import os
import signal
import subprocess
import sys
import tempfile
import time

from on_ranks import committed_version

HERE = os.path.dirname(os.path.abspath(__file__))
SECONDS_BETWEEN_LOOKS = 5.0
# The peak lies at a strain of some 0.3 %; a step takes some 0.05 µs of the rock's time. Rows of the curve and cracks are kept
# until the end and would be memory that grows: there are few rows.
INPUT = """subsection Tests
  set List                        = uniaxial_compression
  set Compression strain rate     = 2e-2 1/s
  set Compression sampling strain = 1e-5
  set Stop strain                 = 0.5
end
"""


def resident_memory(pid):
    """[bytes]"""
    with open(f"/proc/{pid}/status", encoding="utf-8") as file:
        for line in file:
            if line.startswith("VmRSS:"):
                return 1024 * int(line.split()[1])
    raise RuntimeError("the process has no memory any more")


def newest(folder):
    """Returns when the last file of the folder was written; none where there is none. Files come and go meanwhile."""
    times = []
    if os.path.isdir(folder):
        for name in os.listdir(folder):
            try:
                times.append(os.stat(os.path.join(folder, name)).st_mtime_ns)
            except FileNotFoundError:
                continue
    return max(times, default=None)


def main():
    feldspar = os.path.abspath(sys.argv[1])
    seconds = float(sys.argv[2]) if len(sys.argv) > 2 else 3600.0
    result_file = sys.argv[3] if len(sys.argv) > 3 else os.path.join(HERE, "results", "soak.json")
    version = committed_version(feldspar)
    with tempfile.TemporaryDirectory(prefix="soak-") as folder:
        with open(os.path.join(folder, "soak.prm"), "w", encoding="utf-8") as file:
            file.write(INPUT)
        process = subprocess.Popen(
            [feldspar, "lab", "soak.prm", "--output", "out", "--quiet", "--threads", "1"],
            cwd=folder,
            stdout=subprocess.DEVNULL,
        )
        begin = time.monotonic()
        looks = []
        n_checkpoints = 0
        last_checkpoint = None
        while time.monotonic() - begin < seconds:
            time.sleep(SECONDS_BETWEEN_LOOKS)
            if process.poll() is not None:
                raise RuntimeError(f"the test ended after {time.monotonic() - begin:.0f} s with {process.returncode}")
            looks.append((time.monotonic() - begin, resident_memory(process.pid)))
            checkpoints = os.path.join(folder, "out", "checkpoints")
            written = newest(checkpoints)
            n_checkpoints += written != last_checkpoint
            last_checkpoint = written
        process.send_signal(signal.SIGTERM)
        process.wait()
        with open(os.path.join(folder, "out", "summary.json"), encoding="utf-8") as file:
            summary = json.load(file)
        test = summary["tests"][0]
        with open(os.path.join(folder, "out", "curves", test["name"] + ".csv"), encoding="utf-8") as file:
            rows = list(csv.DictReader(file))

    warm = [memory for at, memory in looks if at > seconds / 6]
    mean = sum(warm) / len(warm)
    half = len(warm) // 2
    result = {
        "feldspar_version": version,
        "date": datetime.date.today().isoformat(),
        "machine": summary["host"],
        "seconds": round(looks[-1][0]),
        "steps": int(rows[-1]["step"]),
        "last_strain": abs(float(rows[-1]["axial_strain"])),
        "rows": len(rows),
        "broken_segments": test["n_tension_cracks"] + test["n_shear_cracks"],
        "checkpoints_seen": n_checkpoints,
        "looks_after_warm_up": len(warm),
        "least_bytes": min(warm),
        "mean_bytes": round(mean),
        "most_bytes": max(warm),
        "largest_deviation_from_mean": round(max(max(warm) - mean, mean - min(warm)) / mean, 5),
        "second_half_over_first_less_1": round(sum(warm[half:]) / len(warm[half:]) / (sum(warm[:half]) / half) - 1, 5),
        "bytes_every_minute": [m for k, (_, m) in enumerate(looks) if k % round(60 / SECONDS_BETWEEN_LOOKS) == 0],
    }
    with open(result_file, "w", encoding="utf-8") as file:
        json.dump(result, file, indent=1)
        file.write("\n")
    print(json.dumps({key: value for key, value in result.items() if key != "bytes_every_minute"}, indent=1))
    if result["largest_deviation_from_mean"] > 0.01:
        sys.exit("memory is not flat to 1 %")


main()
