"""The commands from Python: the same folders to the bit, the same errors."""

import filecmp
import inspect
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import feldspar

ENTRIES = {
    "Specimen/Width": "12 mm",
    "Specimen/Height": "24 mm",
    "Tests/List": "direct_tension, uniaxial_compression",
    "Seeds/Seeds": "1, 2",
}


class Commands(unittest.TestCase):
    def test_write_the_folder_of_the_command(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "rock.json").write_text(feldspar.Input(ENTRIES).to_json())
            program = os.environ["FELDSPAR_PROGRAM"]
            subprocess.run(
                [program, "lab", "rock.json", "--output", "by_command", "--quiet"],
                cwd=folder, check=True, capture_output=True,
            )
            run = feldspar.lab(feldspar.Input(ENTRIES), folder / "by_python")
            files = sorted(
                one.relative_to(run.folder)
                for kind in ("curves/*.csv", "grains/*.csv", "cracks.csv", "emission.csv")
                for one in run.folder.glob(kind)
            )
            self.assertEqual(len(files), 4 + 4 + 2)
            equal, unequal, failed = filecmp.cmpfiles(folder / "by_command", run.folder, map(str, files), shallow=False)
            self.assertEqual((unequal, failed), ([], []))
            self.assertEqual(len(equal), len(files))
            self.assertEqual(len(run.tests), 4)
            self.assertEqual(set(run.curves), set(run.grains))
            self.assertTrue(run.page.is_file())
            page = feldspar.report(run, output=folder / "report", film=True)
            self.assertTrue(page.is_file())
            film = page.with_name("film.webp").read_bytes()
            self.assertEqual((film[:4], film.count(b"ANMF")), (b"RIFF", 38))  # 32 steps, the last of which stands for a while
            self.assertEqual(run.figure().get_ylabel(), "axial stress [MPa]")

    def test_write_the_folders_of_paths_and_samples(self):
        cell = {"Specimen/Shape": "periodic", "Specimen/Width": "8 mm", "Specimen/Height": "8 mm"}
        path = {"Strain path/Direction": "free, 1, free", "Strain path/Size": "3e-4", "Strain path/Largest step": "2e-5"}
        sample = {"Sample/Width": "8 mm", "Sample/Height": "8 mm", "Sample/Elements across": 1, "Sample/Elements along": 1,
                  "Sample/Tension step": "2e-5", "Tests/List": "direct_tension", "Tests/Stop strain": "3e-4"}
        for command, function, more in (("rve", feldspar.rve_path, path), ("multiscale", feldspar.multiscale, sample)):
            with self.subTest(command), tempfile.TemporaryDirectory() as name:
                folder = Path(name)
                (folder / "rock.json").write_text(feldspar.Input({**cell, **more}).to_json())
                subprocess.run(
                    [os.environ["FELDSPAR_PROGRAM"], command, "rock.json", "--output", "by_command", "--quiet"],
                    cwd=folder, check=True, capture_output=True,
                )
                run = function({**cell, **more}, folder / "by_python", threads=1)
                (file,) = [str(one.relative_to(run.folder)) for one in run.folder.glob("curves/*.csv")]
                self.assertTrue(filecmp.cmp(folder / "by_command" / file, run.folder / file, shallow=False))
                self.assertGreater(len(run.curves.popitem()[1]), 10)

    def test_draw_the_charts_of_the_page(self):
        with tempfile.TemporaryDirectory() as name:
            run = feldspar.lab(feldspar.Input(ENTRIES), Path(name) / "run")
            for chart in run.charts:
                run.figure(chart)
            axes = run.figure("uniaxial_compression_stress")
            self.assertEqual(axes.get_ylabel(), "axial stress [MPa], compression positive")
            highest = {round(max(line.get_ydata()), 1) for line in axes.lines if len(line.get_ydata())}
            for curve in run.curves.values():  # thin lines are single tests, to five digits
                if curve["axial_stress_Pa"].max() > 50e6:
                    self.assertIn(round(curve["axial_stress_Pa"].max() / 1e6, 1), highest)
            with self.assertRaisesRegex(feldspar.Error, "there are .*uniaxial_compression_stress"):
                run.figure("zzz")

    def test_make_no_film_without_a_browser(self):
        with tempfile.TemporaryDirectory() as name:
            run = feldspar.lab({**ENTRIES, "Seeds/Seeds": 1, "Tests/List": "direct_tension"}, Path(name) / "run")
            with mock.patch.dict(os.environ, {"PATH": name}):
                with self.assertRaisesRegex(feldspar.Error, "^feldspar: --film: Chromium, .* is not installed"):
                    feldspar.report(run, output=Path(name) / "report", film=True)
            self.assertFalse((Path(name) / "report").exists())

    def test_change_entries_of_a_file(self):
        with tempfile.TemporaryDirectory() as name:
            file = Path(name) / "rock.json"
            file.write_text(feldspar.Input(ENTRIES).to_json())
            rock = feldspar.Input(file, {"Tests/List": "direct_tension"})
            del rock["Seeds/Seeds"]
            run = feldspar.lab(rock, Path(name) / "run")
            self.assertEqual(len(run.tests), 1)

    def test_take_entries_and_go_on_with_a_run(self):
        with tempfile.TemporaryDirectory() as name:
            run = feldspar.lab({**ENTRIES, "Seeds/Seeds": 1}, Path(name) / "run")
            again = feldspar.lab({**ENTRIES, "Seeds/Seeds": 1}, Path(name) / "run", resume=True)
            self.assertEqual(len(again.tests), len(run.tests))
            page = feldspar.report(run, run.folder)
            self.assertTrue(page.is_file())
            self.assertNotEqual(page, run.page)
            shutil.rmtree(page.parent)

    def test_raise_the_line_of_the_command(self):
        with tempfile.TemporaryDirectory() as name:
            with self.assertRaisesRegex(feldspar.Error, "needs Shape = periodic"):
                feldspar.rve_path(feldspar.Input(ENTRIES), Path(name) / "run")
            with self.assertRaisesRegex(feldspar.Error, "no such folder"):
                feldspar.open(Path(name) / "none")
            with self.assertRaisesRegex(feldspar.Error, "did not write one"):
                feldspar.open(name).summary


class Types(unittest.TestCase):
    """The package is checked as a caller's type checker sees it."""

    def test_explain_themselves(self):
        """Each public name has a docstring, and so has each public member of a class."""
        silent = []
        for name in (*feldspar.__all__, "open"):
            one = getattr(feldspar, name)
            members = [member for member in vars(one) if not member.startswith("_")] if isinstance(one, type) else []
            silent += [name] * (not inspect.getdoc(one))
            silent += [f"{name}.{member}" for member in members if not inspect.getdoc(getattr(one, member))]
        self.assertEqual(silent, [])

    def test_are_strict(self):
        package = Path(feldspar.__file__).parent
        checked = subprocess.run(
            ["/usr/bin/mypy", "--strict", "--ignore-missing-imports", "--cache-dir", "/dev/null", "--package", "feldspar"],
            cwd=package.parent, env={**os.environ, "MYPYPATH": str(package.parent)}, capture_output=True, text=True,
        )
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)

    def test_stub_is_current(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run(["/usr/bin/stubgen", "--quiet", "--module", "feldspar._core", "--output", folder], check=True)
            made = (Path(folder) / "feldspar" / "_core.pyi").read_text()
        kept = (Path(feldspar.__file__).parent / "_core.pyi").read_text()
        names = lambda text: {word for line in text.splitlines() for word in line.split("(")[0].split() if "def " in line}
        self.assertEqual(names(made), names(kept))


if __name__ == "__main__":
    unittest.main()
