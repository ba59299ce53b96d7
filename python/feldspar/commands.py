"""The commands of feldspar, as functions, and the folders that they write."""

import json
import os
import re
import shutil
import signal
import subprocess
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any, Union

import pandas

from feldspar import _core
from feldspar.inputs import Input, InputLike, as_input

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PathLike = Union[str, "os.PathLike[str]"]


class Run:
    """The folder of results that a command wrote. Tables are read when they are asked for."""

    def __init__(self, folder: PathLike) -> None:
        self.folder = Path(folder)
        if not self.folder.is_dir():
            raise _core.Error(f"{self.folder}: there is no such folder")

    @property
    def summary(self) -> dict[str, Any]:
        """summary.json"""
        return self._json("summary.json")

    @property
    def calibration(self) -> dict[str, Any]:
        """calibration.json of a calibration"""
        return self._json("calibration.json")

    @property
    def tests(self) -> pandas.DataFrame:
        """A row a test, with its quantities: tests.csv."""
        return self._csv("tests.csv")

    @property
    def curves(self) -> dict[str, pandas.DataFrame]:
        """The curve of each test or path."""
        return self._tables("curves")

    @property
    def cracks(self) -> pandas.DataFrame:
        """Broken segments of all tests in the order of breaking: cracks.csv."""
        return self._csv("cracks.csv")

    @property
    def emission(self) -> pandas.DataFrame:
        """Events of acoustic emission of all tests: emission.csv."""
        return self._csv("emission.csv")

    @property
    def grains(self) -> dict[str, pandas.DataFrame]:
        """The grains of each test on grains, before and after."""
        return self._tables("grains")

    @property
    def page(self) -> Path:
        """The report, report.html."""
        return self.folder / "report.html"

    @property
    def charts(self) -> dict[str, dict[str, Any]]:
        """The data of the charts of the page, with five digits, by the names that their pictures have in figures/."""
        chart = re.compile(r'class="live-data">({"what":"chart".*?)</script>.*?href="figures/(.*?)\.svg"', re.DOTALL)
        figures = self._file("report.html").read_text(encoding="utf-8").split("</figure>")
        return {found[2]: json.loads(found[1]) for found in map(chart.search, figures) if found}

    def figure(self, name: Union[str, None] = None, axes: Union["Axes", None] = None) -> "Axes":
        """Draws a figure of the page, one of `charts`; by default stress over strain of all tests."""
        from feldspar.figures import chart_figure, curve_figure

        if name is not None:
            charts = self.charts
            if name not in charts:
                raise _core.Error(f"{name} is no chart of {self.page}; there are {', '.join(charts) or 'none'}")
            return chart_figure(charts[name], axes)
        tests = {name: curve for name, curve in self.curves.items() if "axial_strain" in curve}
        if not tests:
            raise _core.Error(f"{self.folder}: has no curve of a test; `curves` has what there is")
        return curve_figure(tests, axes)

    def _json(self, name: str) -> dict[str, Any]:
        content: dict[str, Any] = json.loads(self._file(name).read_text(encoding="utf-8"))
        return content

    def _csv(self, name: str) -> pandas.DataFrame:
        return _read_csv(self._file(name))

    def _tables(self, folder: str) -> dict[str, pandas.DataFrame]:
        return {file.stem: _read_csv(file) for file in sorted(self.folder.glob(f"{folder}/*.csv"))}

    def _file(self, name: str) -> Path:
        file = self.folder / name
        if not file.is_file():
            raise _core.Error(f"{self.folder}: has no {name}; this run did not write one")
        return file

    def __repr__(self) -> str:
        return f"Run({str(self.folder)!r})"


def _read_csv(file: Path) -> pandas.DataFrame:
    return pandas.read_csv(file, float_precision="round_trip")  # to the bits that were written


def open(folder: PathLike) -> Run:
    """Returns the results of a run that stand in a folder."""
    return Run(folder)


def lab(
    input: InputLike, output: PathLike, force: bool = False, resume: bool = False, threads: Union[int, None] = None
) -> Run:
    """Makes the specimens and tests of an input as `feldspar lab` does, into a folder.

    `force` replaces an older run there, `resume` goes on with one that was interrupted. Raises Error with the program's
    line where it ends by one; what it wrote until then stands in the folder.
    """
    return _run("lab", input, output, force, resume, threads)


def rve_path(
    input: InputLike, output: PathLike, force: bool = False, resume: bool = False, threads: Union[int, None] = None
) -> Run:
    """Leads representative volumes along the path of an input, as `feldspar rve` does; options as of lab()."""
    return _run("rve", input, output, force, resume, threads)


def multiscale(
    input: InputLike, output: PathLike, force: bool = False, resume: bool = False, threads: Union[int, None] = None
) -> Run:
    """Tests samples of finite elements with a representative volume at every point, as `feldspar multiscale` does; options
    as of lab()."""
    return _run("multiscale", input, output, force, resume, threads)


def contact(input: InputLike, output: PathLike, force: bool = False) -> Run:
    """Leads one contact along a path of displacements, as `feldspar contact` does."""
    return _run("contact", input, output, force, False, None)


def calibrate(
    input: InputLike, output: PathLike, force: bool = False, resume: bool = False, threads: Union[int, None] = None
) -> Run:
    """Finds the micro-parameters of a rock, as `feldspar calibrate` does; options as of lab()."""
    return _run("calibrate", input, output, force, resume, threads)


def report(*folders: Union[Run, PathLike], output: Union[PathLike, None] = None, film: bool = False) -> Path:
    """Makes the report of one run anew, or compares several, in the folder `output` or a new one. Returns its page.

    `film`: the cracking of the tests as film.webp beside the page, too. Raises Error where there is no Chromium to make it.
    """
    names = [os.fspath(one.folder if isinstance(one, Run) else one) for one in folders]
    where = [] if output is None else ["--output", os.fspath(output)]
    options = ["--quiet"] + (["--film"] if film else [])
    return Path(_call(["report", *names, *where, *options]).splitlines()[0])


def _run(
    command: str, input: InputLike, output: PathLike, force: bool, resume: bool, threads: Union[int, None]
) -> Run:
    options = ["--quiet"] + ([] if threads is None else ["--threads", str(threads)])
    if resume:
        _call([command, "--resume", os.fspath(output), *options])
        return Run(output)
    options += ["--output", os.fspath(output)] + (["--force"] if force else [])
    wanted = as_input(input)
    if wanted.file is not None:
        of_file = Input(wanted.file)
        differing = [name for name in {**of_file, **wanted} if of_file[name] != wanted[name]]
        settings = [part for name in differing for part in ("--set", f"{name} = {wanted[name]}")]
        _call([command, os.fspath(wanted.file), *settings, *options])
        return Run(output)
    # In the current folder, to which the files that it names refer.
    try:
        file = tempfile.NamedTemporaryFile("w", prefix="input_", suffix=".json", dir=".", encoding="utf-8")
    except OSError as error:
        raise _core.Error(f"the current folder takes no file for the input: {error.strerror}") from None
    with file:
        file.write(wanted.to_json())
        file.flush()
        _call([command, os.path.basename(file.name), *options])
    return Run(output)


def _call(arguments: list[str]) -> str:
    """Runs the program and returns what it prints. Raises Error with its line where it ends by one. Ctrl-C is handed on to
    it, so that it keeps what there is."""
    beside = Path(__file__).parent / "../../../../bin/feldspar"
    program = os.environ.get("FELDSPAR_PROGRAM") or shutil.which("feldspar") or str(beside)
    try:
        # In a session of its own, a terminal's Ctrl-C reaches it once, from here.
        running = subprocess.Popen(
            [program, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
        )
    except OSError as error:
        raise _core.Error(
            f"{program}: the program cannot be started ({error.strerror}); install it, or set FELDSPAR_PROGRAM to its path"
        ) from None
    with running:
        try:
            output, errors = running.communicate()
        except KeyboardInterrupt:
            running.send_signal(signal.SIGINT)
            running.communicate()
            raise
    not_failures = (0, 4, 5)  # a calibration that missed its targets, or did not decide
    if running.returncode not in not_failures:
        raise _core.Error(errors.strip() or f"feldspar {arguments[0]} ended with code {running.returncode}")
    return output
