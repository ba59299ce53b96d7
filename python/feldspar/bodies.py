"""Bodies in this process: specimens, laboratory tests, their envelopes."""

import json
import os
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NoReturn, Self, Union

import numpy
import pandas
from numpy.typing import ArrayLike, NDArray

from feldspar import _core
from feldspar.inputs import Input, InputLike, Quantity, as_input, in_si, number, whole

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Numbers = NDArray[numpy.float64]


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
        """2 in the plane, 3 in space."""
        return self.core.dimension

    @property
    def seed(self) -> int:
        """Seed of the grains and of the strengths."""
        return self.core.seed

    @property
    def size(self) -> Numbers:
        """Width, (depth,) height [m]."""
        return self.core.size()

    @property
    def grains(self) -> pandas.DataFrame:
        """Positions and radii [m], a row a grain; of a rock of minerals the numbers of its `mineral` and `mineral_grain` too."""
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

    def resume(self, file: Union[str, "os.PathLike[str]"]) -> "Test":
        """Returns the test, or the press, that save() wrote. It goes on to the same bits.

        Raises Error where the file is of another specimen, other entries or another version."""
        core = _core.Test.load(self.core, self.input.core, os.fspath(file))
        if not core.stages:
            return Test(core, core.kind)
        press = Press(self, core.stages[-1].confining_pressure)
        press._begin(core)
        return press

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
        """The test in the compiled part."""
        return self._started

    def advance(self) -> bool:
        """Runs to the next row of the curve. Returns False once the test has ended."""
        return self.core.advance()

    def save(self, file: Union[str, "os.PathLike[str]"]) -> None:
        """Writes the state of the test, for Specimen.resume(); `each` may do so on the way."""
        self.core.save(os.fspath(file))

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
        """The test in the compiled part, from the first stage on."""
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

    def _begin(self, test: _core.Test) -> None:
        self._test = test
        self._columns = test.columns()

    def _load(self, each: Each, confinement: Union[Quantity, None], **stage: Union[float, None]) -> Self:
        pressure = self._confinement if confinement is None else in_si(confinement, "stress")
        target = _core.Stage(confining_pressure=pressure, **stage)
        if self._test is None:
            self._begin(_core.Test(self._specimen.core, self._specimen.input.core, self._confinement, target))
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
