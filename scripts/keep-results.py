#!/usr/bin/env python3
"""Writes committed results: what pages, tests, figures and studies read of a run's summary.json or calibration.json.

    scripts/keep-results.py FILE ...          shortens these files in place
    scripts/keep-results.py FROM --to FILE    writes FILE from FROM
    scripts/keep-results.py --check           fails where a file below examples/ is longer than this script writes it, or all
                                              together are longer than 2 MB

FILE lies in the results/ of an example, whose name decides on ALSO. Values that do not apply are left out, numbers have eight
significant digits, and each test stands on a line of its own. A key that a page comes to need is added here and made by a
new run; nothing brings back what was left out.
"""

import argparse
import functools
import glob
import json
import os
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
MOST_BYTES = 2_000_000  # of all committed results
DIGITS = 8  # tests/app/study_test.cc compares within 1e-6
WHOLE = {"peak_stress_Pa"}  # compared bit by bit with benchmarks

PROVENANCE = "schema_version feldspar_version input file host processor threads"
TESTS = (
    "tests name kind group body seed variant confining_pressure_Pa interrupted came_apart ended_early failure "
    "n_grains n_joints peak_stress_Pa"
)
BODY = "coordination_number_core installation_gap_ratio porosity"
RVES = (
    "rves seed variant n_grains n_joints coordination_number installation_gap_ratio porosity youngs_modulus_Pa "
    "poissons_ratio bulk_modulus_Pa shear_modulus_Pa anisotropy highest_stress lowest_stress yy zz stress_Pa strain at_end "
    "strain_xx strain_yy strain_zz stress_yy_Pa n_tension_cracks n_shear_cracks slip_energy_J released_energy_J "
    "settling_energy_J peak_stress_Pa crack_area_share energy_imbalance hill_mandel_residual ended_early wall_time_s"
)
ELASTIC = "youngs_modulus_initial_Pa youngs_modulus_tangent_Pa poissons_ratio_initial poissons_ratio_secant"
CRACKS = "crack_initiation_stress_Pa crack_damage_stress_Pa n_tension_cracks n_shear_cracks"
FITS = (
    "fits as_paper intact general mohr_coulomb direct_shear with_tension_point without_tension_point sigma_ci_Pa "
    "sigma_ci_confidence_95_Pa m m_confidence_95 s a slope r_squared uniaxial_compressive_strength_Pa tensile_cut_off_Pa "
    "measured_uniaxial_compressive_strength_Pa cohesion_Pa friction_angle_rad"
)
SAMPLE = (
    f"{BODY} strain_at_peak {ELASTIC} {CRACKS} steps solver_work iterations cascades seconds_in_points "
    "energy_imbalance_over_work wall_time_s"
)
ALSO = {  # what the pages of an example read of its tests besides; the longest name that fits
    "beishan-granite/": f"{BODY} strain_at_peak {ELASTIC} {CRACKS} {FITS} shear_share_at_peak residual_deviator_ratio "
    "servo_error energy_imbalance_over_work",
    "beishan-granite/platens": f"{FITS} fits_of_variants variant_values value",
    "beishan-cylinder/": f"{BODY} strain_at_peak {ELASTIC} {FITS} shear_share_at_peak post_peak_drop",
    "calibrate-": ELASTIC,
    "calibrate-lac-du-bonnet/platen": "",
    "contact-models/": f"{BODY} strain_at_peak {ELASTIC} {FITS} shear_share_at_peak smooth_tension_share_at_peak n_clumps "
    "energy_imbalance_over_work",
    "direct-shear/": f"{FITS} normal_stress_at_peak_Pa dilation_angle_rad",
    "emission-beishan/": "n_events_at_peak b_value b_value_error b_positive shear_share_at_peak "
    "crack_initiation_stress_Pa crack_initiation_stress_lateral_Pa crack_initiation_stress_emission_Pa "
    "crack_damage_stress_Pa crack_damage_stress_emission_Pa",
    "flawed-granite/": "crack_initiation_stress_Pa first_cracks test n_of_first_ten n_of_first_ten_in_tension "
    "first_stress_Pa joining segments_1 segments_2 segments_4 stress_Pa strain_over_strain_at_peak n_faces n_tension_cracks "
    "n_shear_cracks",
    "granite-minerals/": f"{ELASTIC} {CRACKS} shear_share_at_peak boundary_crack_share_at_peak",
    "multiscale-": f"{SAMPLE} crack_initiation_stress_lateral_Pa strain_at_end stress_at_end_Pa largest_fall "
    "stress_before_Pa stress_after_Pa n_cracks boundary stress_at_broken_share_Pa after_peak "
    "work_after_peak_J_per_m2 stress_at_end_over_peak band_to_axis_deg",
    "plate-with-hole/": "crack_density map",
    "rve-beishan/": "",
    "toughness/": "fracture_toughness_Pa_sqrt_m fracture_energy_J_per_m2 resolution size_m",
}
CALIBRATION = (
    "rock verdict statement tolerance targets title target reached standard_error deviation n_packings parameters best "
    "lower_90 upper_90 predictions"
)
NAMED_BY_DATA = {"targets", "predictions", "direct_shear", "variant_values", "crack_density", "stress_at_broken_share_Pa"}
NEVER = {"stress_Pa": 0, "strain": 0, "n_tension_cracks": 0, "n_shear_cracks": 0}  # highest stress of what is only pressed
ALL_KEYS = ("calibrate-hidden-rocks/", "beishan-cylinder/full-size.json", "multiscale-beishan/mesh-study.json")  # by their studies


def kept(value, names, key=""):
    """The part of a value whose keys are among names; None where nothing of it applies. Without names all, unrounded."""
    if isinstance(value, dict):
        every = names is None or key in NAMED_BY_DATA or (key == "parameters" and "targets" in names)
        parts = {name: kept(part, names, name) for name, part in value.items() if every or name in names}
        return {name: part for name, part in parts.items() if part not in (None, {}, NEVER)} or None
    if isinstance(value, list):
        return [kept(part, names) for part in value]
    if isinstance(value, float) and names is not None and key not in WHOLE:
        value = float(f"{value:.{DIGITS}g}")
        return int(value) if value.is_integer() else value
    return None if key == "interrupted" and not value else value


def text_of(summary):
    """JSON with a line for each test, RVE or other member of a list or group."""
    dump = functools.partial(json.dumps, ensure_ascii=False)
    lines = []
    for key, value in summary.items():
        line = dump(value)
        if isinstance(value, dict) and any(isinstance(part, dict) for part in value.values()):
            line = "{\n" + ",\n".join(f"    {dump(name)}: {dump(part)}" for name, part in value.items()) + "\n  }"
        elif isinstance(value, list) and value and isinstance(value[0], (dict, list)):
            line = "[\n" + ",\n".join(f"    {dump(part)}" for part in value) + "\n  ]"
        lines.append(f"  {dump(key)}: {line}")
    return "{\n" + ",\n".join(lines) + "\n}\n"


def names_of(file, summary):
    """The keys that are kept in a committed file; None: all."""
    path = os.path.abspath(file).split("/examples/")[-1].replace("/results/", "/")
    if path.startswith(ALL_KEYS):
        return None
    if "targets" in summary:
        return {*PROVENANCE.split(), *CALIBRATION.split()}
    also = ALSO.get(max((name for name in ALSO if path.startswith(name)), key=len, default=""), "")
    return {*PROVENANCE.split(), *also.split(), *(RVES if "rves" in summary else TESTS).split()}


def shortened(file, source):
    """The text of a committed file, from that of a run."""
    with open(source, encoding="utf-8") as text:
        summary = json.load(text)
    summary = kept(summary, names_of(file, summary))
    for test in summary.get("tests", ()):
        if test.get("group") == test["name"].rpartition("_seed_")[0]:
            del test["group"]
        if test.get("body") == "grains":
            del test["body"]
    return text_of(summary)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*")
    parser.add_argument("--to")
    parser.add_argument("--check", action="store_true")
    wanted = parser.parse_args()
    files = wanted.files or sorted(glob.glob(os.path.join(ROOT, "examples/*/results/*.json")))
    if not wanted.files and not wanted.check:
        parser.error("no file")
    different = []
    for file in files:
        text = shortened(wanted.to or file, file)
        if not wanted.check:
            with open(wanted.to or file, "w", encoding="utf-8") as out:
                out.write(text)
        elif text != open(file, encoding="utf-8").read():
            different.append(file)
    if different:
        sys.exit("not as scripts/keep-results.py writes them:\n" + "\n".join(different))
    if wanted.check and (size := sum(map(os.path.getsize, files))) > MOST_BYTES:
        sys.exit(f"committed results have {size} bytes; {MOST_BYTES} are the most")


if __name__ == "__main__":
    main()
