"""How the scripts here start the command on several ranks."""

import os

ENVIRONMENT = os.environ | {
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "HWLOC_COMPONENTS": "-gl",
    "OMPI_MCA_mpi_yield_when_idle": "1",
}


def launcher(n_ranks):
    return ["mpirun", "-np", str(n_ranks), "--oversubscribe"] if n_ranks > 1 else []
