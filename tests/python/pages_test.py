"""The Python of the pages runs as it is printed, block after block, on small bodies."""

import os
import re
import tempfile
import unittest
from pathlib import Path

import feldspar

ROOT = Path(__file__).parents[2]
BLOCK = re.compile(r"^```(\w+) ?(\S*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
SMALL = {"Specimen/Width": "12 mm", "Specimen/Height": "24 mm"}


class Pages(unittest.TestCase):
    def run_blocks(self, page: str, names: dict) -> dict:
        """Runs the blocks of Python of a page in a folder of their own, in which its files stand. Returns their names."""
        before = os.getcwd()
        blocks = BLOCK.findall((ROOT / page).read_text(encoding="utf-8"))
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            try:
                for language, file, text in blocks:
                    if file:
                        Path(file).write_text(text, encoding="utf-8")
                    if language == "python":
                        exec(compile(text, page, "exec"), names)
            finally:
                os.chdir(before)
        return names

    def test_readme(self):
        names = self.run_blocks("README.md", {})
        self.assertGreater(names["test"].summary["peak_stress_Pa"], 100e6)

    def test_python(self):
        names = self.run_blocks(
            "docs/python.md",
            {"specimen": feldspar.Specimen(feldspar.Input(SMALL)), "more_strains": [[0.0, 2e-5, 0.0]] * 1000,
             "strains": [[0.0, 1e-5, 0.0]] * 1000},
        )
        self.assertGreaterEqual(names["press"].n_cracks, 200)
        self.assertGreater(names["response"].n_breaks, 0)
        self.assertEqual(names["token"], 2)

    def test_material(self):
        names = self.run_blocks("docs/material.md", {})
        self.assertEqual(names["tangents"].shape, (32, 3, 3))


if __name__ == "__main__":
    unittest.main()
