#!/usr/bin/env python3
"""Makes the figures of docs/figures and the record of how each was made.

    scripts/make-figures.py FELDSPAR [NAME ...]

FELDSPAR: the program, built of a commit. NAME: figures to be made, by their file names; all without one, in some ten
minutes on two cores. docs/figures/figures.json gets for each its commands, the version of the program, the checksum of
the file and, of what was run, the strengths and crack counts that the picture shows; a test compares these with the
committed results, so that a figure cannot grow older than they are.
"""

import argparse
import hashlib
import json
import os
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
FIGURES = os.path.join(ROOT, "docs", "figures")
RECORD = os.path.join(FIGURES, "figures.json")

GRANITE = "examples/beishan-granite/results/ensemble.json"
CONTACT_MODELS = "examples/contact-models/results/"
PLANE_SAMPLE = "examples/multiscale-beishan/results/beishan.json"

# The figure; the run and the picture of it (of its page the first screen), or the series of committed results and the picture
# of their report; the committed results that have the same tests.
FIGURES_OF_RUNS = {
    "beishan-report.png": (
        ["lab", "examples/beishan-granite/demo.prm"],
        "report.html",
        GRANITE,
    ),
    "multiscale-cylinder-tension.svg": (
        ["multiscale", "examples/multiscale-beishan-cylinder/tension.prm"],
        "direct_tension_seed_1_sample.svg",
        "examples/multiscale-beishan-cylinder/results/tension.json",
    ),
    "multiscale-cylinder-rves.png": (
        ["multiscale", "examples/multiscale-beishan-cylinder/tension.prm"],
        "direct_tension_seed_1_rves.png",
        "examples/multiscale-beishan-cylinder/results/tension.json",
    ),
}
FIGURES_OF_RESULTS = {
    "multiscale-envelopes.svg": (
        {"finite elements": PLANE_SAMPLE, "grains": GRANITE},
        "envelopes.svg",
    ),
    "contact-models-envelopes.svg": (
        {
            "flat joint": CONTACT_MODELS + "flat-joint.json",
            "parallel bonds": CONTACT_MODELS + "parallel-bond.json",
            "clumps": CONTACT_MODELS + "clumped.json",
            "grain-based": CONTACT_MODELS + "grain-based.json",
        },
        "envelopes.svg",
    ),
}
# Figures made by a study of its own, which draws from its committed results when no run is named.
FIGURES_OF_STUDIES = {
    "multiscale-and-grains.png": "examples/multiscale-and-grains/study.py",
    "plate-with-hole.png": "examples/plate-with-hole/study.py",
}
SHOWN = ("peak_stress_Pa", "n_tension_cracks", "n_shear_cracks")


def of_run(feldspar, command, work):
    """The folder of a run; one that several figures come from is made once."""
    folder = os.path.join(work, os.path.basename(command[1]).removesuffix(".prm"))
    if not os.path.exists(folder):
        subprocess.run([feldspar, *command, "--output", folder], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    return folder


def shoot(page, target):
    """The first screen of a page, by Chromium."""
    with tempfile.TemporaryDirectory() as profile:
        subprocess.run(
            ["chromium", "--headless=new", "--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader", "--hide-scrollbars"]
            + ["--disable-dev-shm-usage", f"--user-data-dir={profile}", "--window-size=1280,960", f"--screenshot={target}", page],
            check=True,
            stderr=subprocess.DEVNULL,
        )


def of_results(feldspar, series, work):
    """The folder of a report on committed results."""
    folders = []
    for label, results in series.items():
        folder = os.path.join(work, label)
        os.makedirs(folder, exist_ok=True)
        shutil.copyfile(os.path.join(ROOT, results), os.path.join(folder, "summary.json"))
        folders.append(folder)
    report = os.path.join(work, "report")
    # The report says that these series are different rocks and have no curves.
    subprocess.run(
        [feldspar, "report", *folders, "--output", report, "--force"],
        check=True,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    return report


def version(feldspar):
    words = subprocess.run([feldspar, "--version"], check=True, stdout=subprocess.PIPE, text=True).stdout.split()
    found = next(word for word in words if word[0].isdigit())
    if found.endswith(".modified"):
        sys.exit(f"{feldspar} ({found}) is of no commit: commit, build again, and make the figures with that")
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("feldspar")
    parser.add_argument("names", nargs="*")
    wanted = parser.parse_args()
    feldspar = os.path.abspath(wanted.feldspar)
    known = [*FIGURES_OF_RUNS, *FIGURES_OF_RESULTS, *FIGURES_OF_STUDIES]
    for name in wanted.names:
        if name not in known:
            sys.exit(f"{name}: no such figure; there are {', '.join(known)}")

    record = {}
    if os.path.exists(RECORD):
        with open(RECORD, encoding="utf-8") as old:
            record = json.load(old)
    made_by = version(feldspar)
    with tempfile.TemporaryDirectory() as work:
        for name in wanted.names or known:
            entry = {"feldspar_version": made_by}
            picture = None
            if name in FIGURES_OF_STUDIES:
                study = FIGURES_OF_STUDIES[name]
                subprocess.run([sys.executable, os.path.join(ROOT, study), feldspar], check=True, stdout=subprocess.DEVNULL)
                entry["command"] = study
            elif name in FIGURES_OF_RUNS:
                command, picture, results = FIGURES_OF_RUNS[name]
                folder = of_run(feldspar, command, work)
                with open(os.path.join(folder, "summary.json"), encoding="utf-8") as summary:
                    tests = json.load(summary)["tests"]
                entry["command"] = " ".join(["feldspar", *command])
                entry["results"] = results
                entry["tests"] = {test["name"]: {key: test[key] for key in SHOWN} for test in tests}
            else:
                series, picture = FIGURES_OF_RESULTS[name]
                folder = of_results(feldspar, series, work)
                entry["command"] = "feldspar report"
                entry["series"] = series
            target = os.path.join(FIGURES, name)
            if picture == "report.html":
                shoot(os.path.join(folder, picture), target)
            elif picture:
                shutil.copyfile(os.path.join(folder, "figures", picture), target)
            with open(target, "rb") as file:
                entry["sha256"] = hashlib.sha256(file.read()).hexdigest()
            record[name] = entry
            with open(RECORD, "w", encoding="utf-8") as out:
                json.dump(dict(sorted(record.items())), out, indent=2, ensure_ascii=False)
                out.write("\n")
            print(f"{name}: made by {made_by}", flush=True)


if __name__ == "__main__":
    main()
