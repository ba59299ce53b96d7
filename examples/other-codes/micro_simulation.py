"""A volume for the preCICE micro-manager, which makes one object a macro point and calls it once a coupling step.

In the micro-manager's configuration `micro_file_name` is `micro_simulation`. The macro code writes the strains below to the
points of its mesh and reads the stresses; in the plane xx, yy and xy alone. The input is `micro.prm` in the working folder.
"""

from functools import cache

import feldspar

names = {2: ("xx", "yy", "xy"), 3: ("xx", "yy", "zz", "yz", "xz", "xy")}


@cache
def intact() -> feldspar.Rve:
    """Returns the volume at rest, of which the points have copies."""
    rock = feldspar.Input("micro.prm")
    return feldspar.Rve(feldspar.Specimen(rock, seed=int(rock["Seeds/Seeds"])))


class MicroSimulation:
    def __init__(self, sim_id: int) -> None:
        self.sim_id = sim_id
        self.volume = intact().copy()

    def initialize(self) -> dict[str, float]:
        """Returns the fields of a volume at rest."""
        return self.fields()

    def solve(self, macro_data: dict[str, float], dt: float) -> dict[str, float]:
        """Takes a strain, and returns stresses [Pa] and the number of broken segments. Time plays no part."""
        strain = [macro_data["strain_" + name] for name in names[self.volume.dimension]]
        self.volume.relax(strain)
        self.volume.accept()
        return self.fields()

    def get_state(self) -> bytes:
        """Returns the state to which an iteration of an implicit coupling goes back."""
        return self.volume.state

    def set_state(self, state: bytes) -> None:
        self.volume.restore(state)

    def fields(self) -> dict[str, float]:
        stress = zip(names[self.volume.dimension], self.volume.stress)
        return {**{"stress_" + name: float(value) for name, value in stress}, "broken": float(self.volume.n_broken)}
