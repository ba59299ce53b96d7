#!/usr/bin/env python3
"""Runs every number of the input at the ends of its range, one at a time, and says what goes wrong.

    scripts/extremes.py FELDSPAR [COMMAND ...]

COMMAND is contact, rve or lab; without any, all three run. A range that is open or without an end is tried at 5e-324,
1e-300, 1e-9, 1e-3, 1e3, 1e9, 1e300 and 1e308 units. A run is right if it ends with exit code 0 and numbers, or with exit
code 2 and words of one line; one that goes on for 20 s is ended and counted apart. Exit code 1 if any is wrong.
"""

import os
import re
import subprocess
import sys
import tempfile

SECONDS = 20

GRAINS = """subsection Specimen
  set Width = 10 mm
  set Height = {height}
  set Shape = {shape}
end
"""
INPUTS = {
    "contact": "subsection Contact path\n  set File = path.csv\nend\n",
    "rve": GRAINS.format(height="10 mm", shape="periodic")
    + "subsection Strain path\n  set Direction = free, 1, free\n  set Size = 2e-4\n  set Largest step = 1e-5\nend\n",
    "lab": GRAINS.format(height="20 mm", shape="box") + "subsection Tests\n  set List = direct_tension\nend\n",
}
SECTIONS = {
    "contact": ("Contact", "Flat joint"),
    "rve": ("Specimen", "Flat joint", "Particle contact", "Dynamics", "Strain path", "Representative volume"),
    "lab": ("Specimen", "Flat joint", "Particle contact", "Dynamics", "Tests"),
}
PATH = "normal_m,shear_m,rotation_rad\n0,0,0\n1e-6,0,0\n2e-6,1e-6,1e-4\n-1e-6,5e-6,1e-3\n"


def entries(feldspar):
    """Section, entry, unit and range of each line of the tables of parameters."""
    tables = subprocess.run([feldspar, "parameters", "--markdown"], check=True, capture_output=True, text=True).stdout
    section = ""
    for line in tables.splitlines():
        if line.startswith("## "):
            section = line[3:]
        cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
        if section and len(cells) == 5 and cells[0] not in ("entry", "---"):
            yield section, cells[0], "" if cells[1] == "-" else " " + cells[1], cells[3]


def extremes(unit, allowed):
    """Values at the ends of a range; none where it is not one of numbers."""
    if "file" in allowed:
        return []
    if interval := re.search(r"[\[(](-?[\d.e+-]+)[^,]*, (-?[\d.e+-]+)[^\])]*[\])]", allowed):
        return [end if "integer" in allowed else end + unit for end in interval.groups()]
    if ">" in allowed:
        values = ("0", "5e-324", "1e-300", "1e-9", "1e-3", "1e3", "1e9", "1e300", "1e308")
        return [f"{value}{unit}" for value in values]
    return []


def fault(code, words, folder):
    """Returns the fault of the end of a run; empty if there is none."""
    lines = [line for line in words.splitlines() if line.strip()]
    if code not in (0, 2):
        return f"exit code {code}"
    if code == 2 and not lines:
        return "no word"
    if any(len(line) > 600 or not line.isprintable() for line in lines):
        return "words that cannot be read"
    summary = os.path.join(folder, "summary.json")
    if os.path.exists(summary):
        with open(summary, encoding="utf-8") as file:
            if re.search(r"[:\[,]\s*-?(nan|inf)", file.read(), re.IGNORECASE):
                return "a result that is no number"
    return ""


def main():
    feldspar = os.path.realpath(sys.argv[1])
    counts = dict.fromkeys(("runs", "made", "refused or ended in words", "ended after 20 s", "wrong"), 0)
    for command in sys.argv[2:] or INPUTS:
        for section, entry, unit, allowed in entries(feldspar):
            if section not in SECTIONS[command]:
                continue
            for value in extremes(unit, allowed):
                with tempfile.TemporaryDirectory() as folder:
                    for name, text in (("input.prm", INPUTS[command]), ("path.csv", PATH)):
                        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                            file.write(text)
                    setting = f"{section}/{entry} = {value}"
                    call = [feldspar, command, "input.prm", "--output", "out", "--quiet", "--threads", "1"]
                    counts["runs"] += 1
                    try:
                        end = subprocess.run(
                            call + ["--set", setting], cwd=folder, capture_output=True, text=True, timeout=SECONDS
                        )
                    except subprocess.TimeoutExpired:
                        counts["ended after 20 s"] += 1
                        print(f"goes on: {command}, {setting}", flush=True)
                        continue
                    if what := fault(end.returncode, end.stderr, os.path.join(folder, "out")):
                        counts["wrong"] += 1
                        print(f"WRONG: {command}, {setting}: {what}: {end.stderr.strip()[:300]}", flush=True)
                    else:
                        counts["made" if end.returncode == 0 else "refused or ended in words"] += 1
    print(", ".join(f"{n} {what}" for what, n in counts.items()))
    sys.exit(counts["wrong"] > 0)


if __name__ == "__main__":
    main()
