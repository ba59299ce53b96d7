"""Bodies in this process: specimens, laboratory tests, representative volumes."""

import json
import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, NoReturn, Self, Union

import numpy
import pandas
from numpy.typing import ArrayLike, NDArray

from feldspar import _core
from feldspar.inputs import Input, InputLike, Quantity, as_input, in_si, number, whole

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Numbers = NDArray[numpy.float64]
Trial = _core.Trial


class Specimen:
    """A specimen of grains and joints, free of stress. Nothing changes it; tests work on copies.

    The same input and seed give the same bits. Raises Error where the specimen cannot be made.
    """

    def __init__(self, input: InputLike, seed: int = 1) -> None:
        self.input = Input(as_input(input))
        self.core = _core.Specimen(self.input.core, whole(seed, "a seed"))

    @classmethod
    def load(cls, file: Union[str, "os.PathLike[str]"], input: Union[InputLike, None] = None) -> "Specimen":
        """Reads a specimen.h5 that save() or a run wrote; `input` has the entries of the tests on it."""
        specimen = cls.__new__(cls)
        specimen.input = Input(input)
        specimen.core = _core.Specimen.load(os.fspath(file))
        return specimen

    def save(self, file: Union[str, "os.PathLike[str]"]) -> None:
        """Writes the specimen as a specimen.h5."""
        self.core.save(os.fspath(file))

    @property
    def dimension(self) -> int:
        return self.core.dimension

    @property
    def seed(self) -> int:
        return self.core.seed

    @property
    def size(self) -> Numbers:
        """Width, (depth,) height [m]."""
        return self.core.size()

    @property
    def grains(self) -> pandas.DataFrame:
        """Positions and radii [m], a row a grain."""
        return pandas.DataFrame(self.core.grains())

    @property
    def joints(self) -> pandas.DataFrame:
        """Grains (as rows of `grains`), half length, gap [m] and stiffnesses [Pa/m], a row a joint."""
        return pandas.DataFrame(self.core.joints())

    @property
    def report(self) -> dict[str, float]:
        """Counts, porosity, coordination and installation gap, by their names in summary.json."""
        return {name: int(one) if name.startswith("n_") else one for name, one in self.core.report()}

    def test(self, kind: str, confinement: Quantity = 0.0) -> "Test":
        """Returns a laboratory test, ready to run: direct_tension, uniaxial_compression, triaxial_compression, brazilian, …

        `confinement`: the confining pressure, compression positive [Pa].
        """
        if not isinstance(kind, str):
            raise _core.Error(f"the kind of a test must be a name, not {kind!r}")
        return Test(_core.Test(self.core, self.input.core, kind, in_si(confinement, "stress")), kind)

    def press(self, confinement: Quantity = 0.0) -> "Press":
        """Returns a press of your own protocol: platens, and side walls that hold the confining pressure [Pa]."""
        return Press(self, in_si(confinement, "stress"))

    def figure(self, axes: Union["Axes", None] = None) -> "Axes":
        """Draws the grains of a specimen in the plane."""
        from feldspar.figures import grains_figure

        return grains_figure(self.grains, None, axes)

    def __repr__(self) -> str:
        size = " x ".join(f"{1e3 * one:g}" for one in self.size)
        return f"<Specimen of {len(self.grains)} grains, {size} mm, seed {self.seed}>"


Each = Union[Callable[["Test"], object], None]


class Test:
    """A laboratory test, run row by row of its curve. Stress and strain are positive in the sense of the test."""

    __test__ = False  # pytest collects classes of this name

    def __init__(self, core: _core.Test, kind: str) -> None:
        self.kind = kind
        self._started = core
        self._columns = core.columns()

    @property
    def core(self) -> _core.Test:
        return self._started

    def advance(self) -> bool:
        """Runs to the next row of the curve. Returns False once the test has ended."""
        return self.core.advance()

    def __copy__(self) -> NoReturn:
        raise _core.Error("a running test cannot be copied; make another one of the specimen")

    def __deepcopy__(self, memo: object) -> NoReturn:
        self.__copy__()

    def run(self, until: Union[float, None] = None, each: Each = None) -> Self:
        """Runs the test to its end, to the axial strain `until`, or to where `each(test)`, called after each row, returns
        what is true. Ctrl-C ends it at the step it stands at; a later run() goes on from there. Returns the test."""
        goes_on = not self.has_ended
        while goes_on and not (until is not None and self.n_rows > 0 and self.strain >= until):
            goes_on = self.advance()
            if each is not None and each(self):
                break
        return self

    @property
    def has_ended(self) -> bool:
        """True once the test, or the last stage of a press, has ended."""
        return self.core.has_ended

    @property
    def n_rows(self) -> int:
        """Rows of the curve so far."""
        return self.core.n_rows

    def last(self, column: str) -> float:
        """Returns a number of the last row of the curve; NaN before the first."""
        if column not in self._columns:
            raise _core.Error(f"{column} is no column of a curve; they are {', '.join(self._columns)}")
        row = self.core.last_row()
        return float(row[self._columns.index(column)]) if len(row) else numpy.nan

    @property
    def strain(self) -> float:
        """Axial strain of the last row."""
        return self.last("axial_strain")

    @property
    def stress(self) -> float:
        """Axial stress of the last row [Pa]."""
        return self.last("axial_stress_Pa")

    @property
    def n_cracks(self) -> int:
        """Broken segments."""
        return int(self.last("n_tension_cracks") + self.last("n_shear_cracks")) if self.n_rows else 0

    @property
    def curve(self) -> pandas.DataFrame:
        """The curve, with the columns of curves/*.csv."""
        return pandas.DataFrame(self.core.curve(0))

    @property
    def cracks(self) -> pandas.DataFrame:
        """Broken segments in the order of breaking, with the columns of cracks.csv."""
        table = pandas.DataFrame(self.core.cracks())
        kind = numpy.where(table.pop("in_tension") == 1.0, "tension", "shear")
        table.insert(0, "kind", kind)
        return table

    @property
    def grains(self) -> pandas.DataFrame:
        """Positions of the grains when the loading began and now, with the columns of grains/*.csv."""
        return pandas.DataFrame(self.core.grains())

    @property
    def summary(self) -> dict[str, Any]:
        """The quantities of the test as in summary.json: SI, None with a `…_reason` where one could not be had."""
        summary: dict[str, Any] = json.loads(self.core.summary())
        return summary

    def figure(self, axes: Union["Axes", None] = None) -> "Axes":
        """Draws stress over strain, with the number of cracks."""
        from feldspar.figures import curve_figure

        return curve_figure({self.kind: self.curve}, axes)

    def crack_figure(self, axes: Union["Axes", None] = None) -> "Axes":
        """Draws the grains and cracks of a test in the plane, as they are now."""
        from feldspar.figures import grains_figure

        return grains_figure(self.grains, self.cracks, axes)

    def __repr__(self) -> str:
        if not self.n_rows:
            return f"<Test {self.kind}, not begun>"
        return f"<Test {self.kind} at a strain of {self.strain:.3g}, {1e-6 * self.stress:.4g} MPa, {self.n_cracks} cracks>"


class Press(Test):
    """A laboratory test of your own: each call loads the specimen further. Compression positive.

    >>> press = specimen.press(confinement="10 MPa")
    >>> press.strain_to(1e-3).stress_to("40 MPa").strain_to(4e-3, each=lambda test: test.n_cracks > 100)
    """

    def __init__(self, specimen: Specimen, confinement: float) -> None:
        self.kind = "own_loading"
        self._specimen = specimen
        self._confinement = confinement
        self._test: Union[_core.Test, None] = None

    @property
    def core(self) -> _core.Test:
        if self._test is None:
            raise _core.Error("the press has not moved yet; give it a first stage, such as strain_to(1e-3)")
        return self._test

    @property
    def n_rows(self) -> int:
        return self._test.n_rows if self._test else 0

    @property
    def has_ended(self) -> bool:
        """True once the last stage has ended."""
        return self._test.has_ended if self._test else False

    def _load(self, each: Each, confinement: Union[Quantity, None], **stage: Union[float, None]) -> Self:
        pressure = self._confinement if confinement is None else in_si(confinement, "stress")
        target = _core.Stage(confining_pressure=pressure, **stage)
        if self._test is None:
            self._test = _core.Test(self._specimen.core, self._specimen.input.core, self._confinement, target)
            self._columns = self._test.columns()
        else:
            self._test.follow(target)
        self._confinement = pressure
        self.run(each=each)
        return self

    def strain_to(
        self,
        strain: float,
        rate: Union[Quantity, None] = None,
        confinement: Union[Quantity, None] = None,
        each: Each = None,
    ) -> Self:
        """Moves the platens to an axial strain, at `rate` [1/s] (preset: Tests/Compression strain rate); the confining
        pressure goes evenly with it to `confinement`."""
        return self._load(each, confinement, axial_strain=number(strain, "a strain"), strain_rate=_rate(rate))

    def stress_to(self, stress: Quantity, rate: Union[Quantity, None] = None, each: Each = None) -> Self:
        """Moves the platens until the axial stress is `stress` [Pa], or rises no further."""
        return self._load(each, None, axial_stress=in_si(stress, "stress"), strain_rate=_rate(rate))

    def widen_to(self, lateral_strain: float, rate: Quantity, each: Each = None) -> Self:
        """Moves the platens such that the specimen widens at `rate` [1/s] to a lateral strain, which is negative."""
        return self._load(each, None, lateral_strain=number(lateral_strain, "a strain"), strain_rate=_rate(rate))

    def hold(
        self,
        duration: Quantity,
        stress: Union[Quantity, None] = None,
        confinement: Union[Quantity, None] = None,
        each: Each = None,
    ) -> Self:
        """Holds the platens, or the axial stress [Pa], for a time [s], in which the confining pressure goes to
        `confinement`."""
        held = None if stress is None else in_si(stress, "stress")
        return self._load(each, confinement, duration=in_si(duration, "duration"), axial_stress=held)


def _rate(rate: Union[Quantity, None]) -> Union[float, None]:
    return None if rate is None else in_si(rate, "rate")


def fit_envelopes(
    sigma_3: ArrayLike, sigma_1: ArrayLike, tensile_strength: Union[Quantity, None] = None
) -> dict[str, Any]:
    """Returns Hoek–Brown and Mohr–Coulomb envelopes of strengths [Pa], compression positive, as `fits` in summary.json.

    The uniaxial compressive strength is the point at sigma_3 = 0.
    """
    tension = None if tensile_strength is None else in_si(tensile_strength, "stress")
    fits: dict[str, Any] = json.loads(_core.fit_envelopes(sigma_3, sigma_1, tension))
    return fits


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
        self, strains: ArrayLike, parent: int = 0, tangent: bool = False
    ) -> tuple[int, Numbers, Union[Numbers, None]]:
        """Returns a token, the stresses [n, n_voigt] and, if asked for, the tangents [n, n_voigt, n_voigt] at strains
        [n, n_voigt].

        The volumes start from the state of the token `parent`; 0: at rest. The outcome is kept under the token returned. A
        token given as parent is accepted by that: what came before it, and its siblings, are forgotten. Raises Error, and
        keeps nothing, where a volume finds no equilibrium.
        """
        return self.core.update(strains, whole(parent, "a token"), tangent)

    def n_broken(self, token: int) -> NDArray[numpy.int64]:
        """Returns the broken segments of each volume in the state of a token; [n]."""
        return numpy.array(self.core.n_broken(whole(token, "a token")), dtype=numpy.int64)

    def __repr__(self) -> str:
        return f"<{len(self)} Volumes of {len(self.specimens)} specimens>"
