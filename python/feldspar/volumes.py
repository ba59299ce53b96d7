"""Representative volumes in this process: one, and many at once."""

from collections.abc import Sequence
from typing import Union

import numpy
from numpy.typing import ArrayLike, NDArray

from feldspar import _core
from feldspar.bodies import Numbers, Specimen
from feldspar.inputs import Input, InputLike, as_input, whole

Trial = _core.Trial


class Rve:
    """A representative volume: a periodic specimen that answers a strain by a stress, without time.

    Strains and stresses are arrays in Voigt's order, xx, yy, xy or xx, yy, zz, yz, xz, xy, tension positive, with
    engineering shear. Trying changes nothing; accept() does.

    >>> rve = Rve(Input({"Specimen/Shape": "periodic"}))
    >>> rve.relax([0, 1e-4, 0]).stress
    >>> rve.accept()
    """

    def __init__(self, body: Union[InputLike, Specimen, None] = None, seed: int = 1) -> None:
        """`body`: an input, of which a specimen is made with the seed, or a periodic specimen. None: Beishan granite."""
        if not isinstance(body, Specimen):
            body = Specimen(as_cell(body if body is not None else {"Specimen/Shape": "periodic"}), seed)
        self.specimen = body
        self.core = _core.Rve(body.core, body.input.core)
        self._last: Union[Trial, None] = None

    def copy(self) -> "Rve":
        """Returns another volume in the same state, which shares the grains at rest."""
        other = Rve.__new__(Rve)
        other.specimen = self.specimen
        other.core = _core.Rve(self.core)
        other._last = None
        return other

    def __copy__(self) -> "Rve":
        return self.copy()

    def __deepcopy__(self, memo: object) -> "Rve":
        return self.copy()

    def __repr__(self) -> str:
        return f"<Rve of {len(self.specimen.grains)} grains, {self.n_broken} broken segments>"

    def trial(self, strain: ArrayLike, tangent: bool = False) -> Trial:
        """Returns the response to a strain from the accepted state, with all bonds kept."""
        self._last = None
        self._last = self.core.trial(strain, tangent)
        return self._last

    def relax(self, strain: ArrayLike, tangent: bool = False) -> Trial:
        """Returns the response to a strain from the accepted state; bonds break until none is overloaded."""
        self._last = None
        self._last = self.core.relax(strain, tangent)
        return self._last

    def accept(self, trial: Union[Trial, None] = None) -> None:
        """Makes a trial, by default the last one, the state of the volume. Raises Error where it found no equilibrium."""
        chosen = trial if trial is not None else self._last
        if chosen is None:
            raise _core.Error("nothing has been tried since the last accepted state; call trial() or relax() first")
        self.core.accept(chosen)
        self._last = None

    def reject(self) -> None:
        """Forgets the last trial."""
        self._last = None

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return self.core.dimension

    @property
    def stiffness(self) -> Numbers:
        """Stiffness of the intact volume [Pa]; [n, n]."""
        return self.core.stiffness

    @property
    def tangent(self) -> Numbers:
        """At the accepted state, with bonds and contacts as they are [Pa]; [n, n]."""
        tangent = self.core.trial(self.strain, True).tangent
        if tangent is None:
            raise _core.Error("the volume has no tangent here")
        return tangent

    @property
    def strain(self) -> Numbers:
        """Strain of the accepted state; [n]."""
        return self.core.strain

    @property
    def stress(self) -> Numbers:
        """Stress of the accepted state [Pa]; [n]."""
        return self.core.stress

    @property
    def is_intact(self) -> bool:
        """True while nothing has broken and no pair of grains has come into contact."""
        return self.core.is_intact

    @property
    def n_broken(self) -> int:
        """Broken segments."""
        return self.core.n_broken

    def first_break(self, direction: ArrayLike) -> float:
        """Returns the factor of a direction of strain at which the first segment of the intact volume breaks, in closed
        form."""
        return self.core.first_break(direction)

    @property
    def state(self) -> bytes:
        """The accepted state, for restore() of the same version and the same grains."""
        return self.core.state()

    def restore(self, state: bytes) -> None:
        """Takes a state as accepted."""
        self.core.restore(state)
        self._last = None


def as_cell(input: InputLike) -> Input:
    """Returns the input of a periodic cell. Raises Error for one of a specimen between walls."""
    cell = as_input(input)
    if cell["Specimen/Shape"] != "periodic" and cell["Specimen/Specimen file"] == "none":
        raise _core.Error("a representative volume needs Specimen/Shape = periodic")
    return cell


class Volumes:
    """Many representative volumes, answered on all threads by one call.

    `specimens`: an input, of which `realisations` specimens are made with seeds from `seed` on, or specimens made already.
    The volumes are assigned to them by turns, or as `assigned` says.
    """

    def __init__(
        self,
        specimens: Union[InputLike, Specimen, Sequence[Specimen]],
        n: int,
        seed: int = 1,
        realisations: int = 1,
        assigned: Union[Sequence[int], None] = None,
    ) -> None:
        n = whole(n, "the number of volumes", most=10**9)
        if isinstance(specimens, Specimen):
            made = [specimens]
        elif isinstance(specimens, Sequence) and not isinstance(specimens, str):
            made = list(specimens)
        else:
            cell = as_cell(specimens)
            seeds = range(whole(seed, "a seed"), seed + whole(realisations, "the number of realisations", least=1))
            made = [Specimen(cell, one) for one in seeds]
        if not made or not all(isinstance(one, Specimen) for one in made):
            raise _core.Error("volumes need an input or at least one specimen")
        which = [k % len(made) for k in range(n)]
        if assigned is not None:
            which = [whole(one, "the number of a specimen", most=len(made) - 1) for one in assigned]
        self.specimens = made
        self.core = _core.Volumes([one.core for one in made], made[0].input.core, n, which)

    def __len__(self) -> int:
        return len(self.core)

    def update(
        self, strains: ArrayLike, parent: int = 0, tangent: bool = False, bonds_break: bool = True
    ) -> tuple[int, Numbers, Union[Numbers, None]]:
        """Returns a token, the stresses [n, n_voigt] and, if asked for, the tangents [n, n_voigt, n_voigt] at strains
        [n, n_voigt].

        The volumes start from the state of the token `parent`; 0: at rest. The outcome is kept under the token returned. A
        token given as parent is accepted by that: what came before it, and its siblings, are forgotten. Raises Error, and
        keeps nothing, where a volume finds no equilibrium. Bonds break until none is overloaded; `bonds_break=False` keeps
        all, as Newton's method needs it.
        """
        return self.core.update(strains, whole(parent, "a token"), tangent, bonds_break)

    def n_broken(self, token: int) -> NDArray[numpy.int64]:
        """Returns the broken segments of each volume in the state of a token; [n]."""
        return numpy.array(self.core.n_broken(whole(token, "a token")), dtype=numpy.int64)

    def __repr__(self) -> str:
        return f"<{len(self)} Volumes of {len(self.specimens)} specimens>"
