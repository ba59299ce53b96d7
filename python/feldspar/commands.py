"""The commands of feldspar, as functions, and the folders that they write."""

import json
import os
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any, Union

import pandas

from feldspar import _core
from feldspar.inputs import Input

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
        return {file.stem: pandas.read_csv(file) for file in sorted(self.folder.glob("curves/*.csv"))}

    @property
    def cracks(self) -> pandas.DataFrame:
        """Broken segments of all tests in the order of breaking: cracks.csv."""
        return self._csv("cracks.csv")

    @property
    def grains(self) -> dict[str, pandas.DataFrame]:
        """The grains of each test on grains, before and after."""
        return {file.stem: pandas.read_csv(file) for file in sorted(self.folder.glob("grains/*.csv"))}

    @property
    def page(self) -> Path:
        """The report, report.html."""
        return self.folder / "report.html"

    def figure(self, axes: Union["Axes", None] = None) -> "Axes":
        """Draws stress over strain of all tests."""
        from feldspar.figures import curve_figure

        return curve_figure(self.curves, axes)

    def _json(self, name: str) -> dict[str, Any]:
        content: dict[str, Any] = json.loads(self._file(name).read_text(encoding="utf-8"))
        return content

    def _csv(self, name: str) -> pandas.DataFrame:
        return pandas.read_csv(self._file(name))

    def _file(self, name: str) -> Path:
        file = self.folder / name
        if not file.is_file():
            raise _core.Error(f"{self.folder}: has no {name}; this run did not write one")
        return file

    def __repr__(self) -> str:
        return f"Run({str(self.folder)!r})"


def open(folder: PathLike) -> Run:
    """Returns the results of a run that stand in a folder."""
    return Run(folder)


def lab(input: Union[Input, PathLike], output: PathLike, force: bool = False, threads: Union[int, None] = None) -> Run:
    """Makes the specimens and tests of an input as `feldspar lab` does, into a folder; `force` replaces an older run there."""
    return _run("lab", input, output, force, threads)


def rve_path(
    input: Union[Input, PathLike], output: PathLike, force: bool = False, threads: Union[int, None] = None
) -> Run:
    """Leads representative volumes along the path of an input, as `feldspar rve` does."""
    return _run("rve", input, output, force, threads)


def multiscale(
    input: Union[Input, PathLike], output: PathLike, force: bool = False, threads: Union[int, None] = None
) -> Run:
    """Tests samples of finite elements with a representative volume at every point, as `feldspar multiscale` does."""
    return _run("multiscale", input, output, force, threads)


def contact(input: Union[Input, PathLike], output: PathLike, force: bool = False) -> Run:
    """Leads one contact along a path of displacements, as `feldspar contact` does."""
    return _run("contact", input, output, force, None)


def calibrate(
    input: Union[Input, PathLike], output: PathLike, force: bool = False, threads: Union[int, None] = None
) -> Run:
    """Finds the micro-parameters of a rock, as `feldspar calibrate` does."""
    return _run("calibrate", input, output, force, threads)


def report(*folders: Union[Run, PathLike], output: Union[PathLike, None] = None) -> Path:
    """Makes the report of one run anew, or compares several in the folder `output`. Returns its page."""
    names = [os.fspath(one.folder if isinstance(one, Run) else one) for one in folders]
    where = [] if output is None else ["--output", os.fspath(output)]
    _call(["report", *names, *where])
    return (Path(output) if output is not None else Path(names[0])) / "report.html"


def _run(
    command: str, input: Union[Input, PathLike], output: PathLike, force: bool, threads: Union[int, None]
) -> Run:
    options = ["--quiet", "--output", os.fspath(output)]
    options += ["--force"] if force else []
    options += [] if threads is None else ["--threads", str(threads)]
    if not isinstance(input, Input):
        _call([command, os.fspath(input), *options])
    elif input.file is not None:
        of_file = Input(input.file)
        differing = [name for name in {**of_file, **input} if of_file[name] != input[name]]
        settings = [part for name in differing for part in ("--set", f"{name} = {input[name]}")]
        _call([command, os.fspath(input.file), *settings, *options])
    else:
        # In the current folder, to which the files that it names refer.
        with tempfile.NamedTemporaryFile("w", suffix=".json", dir=".", encoding="utf-8") as file:
            file.write(input.to_json())
            file.flush()
            _call([command, file.name, *options])
    return Run(output)


def _call(arguments: list[str]) -> None:
    """Runs the program. Raises Error with its line where it ends by one, KeyboardInterrupt where it was interrupted."""
    beside = Path(__file__).parents[3] / "bin" / "feldspar"
    program = os.environ.get("FELDSPAR_PROGRAM") or shutil.which("feldspar") or str(beside)
    try:
        ended = subprocess.run([program, *arguments], capture_output=True, text=True, check=False)
    except FileNotFoundError:
        raise _core.Error(f"{program}: the program is not there; install it, or set FELDSPAR_PROGRAM to its path") from None
    if ended.returncode == 130:
        raise KeyboardInterrupt
    not_failures = (0, 4, 5)  # a calibration that missed its targets, or did not decide
    if ended.returncode not in not_failures:
        raise _core.Error(ended.stderr.strip() or f"feldspar {arguments[0]} ended with code {ended.returncode}")
