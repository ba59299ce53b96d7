"""Start of the command on several ranks, and choice of the builds for it, for the scripts here."""

import os
import subprocess

ENVIRONMENT = os.environ | {
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "HWLOC_COMPONENTS": "-gl",
    "OMPI_MCA_mpi_yield_when_idle": "1",
}


def launcher(n_ranks):
    return ["mpirun", "-np", str(n_ranks), "--oversubscribe"] if n_ranks > 1 else []


def committed_version(feldspar):
    """Returns the version of a build whose results can be committed; ends the script for others."""
    check = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../scripts/provenance.sh")
    return subprocess.run([check, feldspar], check=True, stdout=subprocess.PIPE, text=True).stdout.strip()
