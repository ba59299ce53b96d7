"""Bodies in this process: that they are those of the command, to the last bit, and that nothing a caller does breaks them."""

import copy
import gc
import os
import pickle
import signal
import tempfile
import threading
import unittest
from pathlib import Path

import feldspar
import numpy
import pandas
from numpy.testing import assert_allclose, assert_array_equal

ROCK = feldspar.Input({"Specimen/Width": "12 mm", "Specimen/Height": "24 mm"})
CELL = feldspar.Input({"Specimen/Shape": "periodic", "Specimen/Width": "8 mm", "Specimen/Height": "8 mm"})


def error_of(work) -> str:
    """Returns the one line of the error that the work raises."""
    try:
        work()
    except feldspar.Error as error:
        assert "\n" not in str(error)
        return str(error)
    raise AssertionError("no error")


class Inputs(unittest.TestCase):
    def test_is_a_mapping_with_presets(self):
        rock = feldspar.Input(ROCK, {"Flat joint/Modulus": "70 GPa"})
        self.assertEqual(list(rock), ["Specimen/Width", "Specimen/Height", "Flat joint/Modulus"])
        self.assertEqual(rock["Specimen/Dimension"], "2")
        self.assertEqual(feldspar.Input(dict(rock)), rock)
        del rock["Flat joint/Modulus"]
        self.assertEqual(rock, ROCK)
        self.assertEqual(len(ROCK), 2)

    def test_is_copied_and_pickled(self):
        rock = feldspar.Input(ROCK)
        for other in (copy.copy(rock), copy.deepcopy(rock), pickle.loads(pickle.dumps(rock))):
            self.assertEqual(other, rock)
            other["Specimen/Width"] = "30 mm"
            self.assertEqual(rock["Specimen/Width"], "12 mm")

    def test_takes_numbers_and_lists(self):
        rock = feldspar.Input({"Seeds/Seeds": [1, 2, 3], "Flat joint/Friction": 0.5, "Tests/Confinements": "5, 10 MPa"})
        self.assertEqual(rock["Seeds/Seeds"], "1, 2, 3")
        self.assertEqual(rock["Flat joint/Friction"], "0.5")
        rock["Tests/Confinements"] = ["5 MPa", "10 MPa"]
        self.assertEqual(rock["Tests/Confinements"], "5, 10 MPa")
        rock["Specimen/Dimension"] = numpy.int64(3)
        self.assertEqual(rock["Specimen/Dimension"], "3")

    def test_refuses_by_one_line(self):
        self.assertIn("a unit is missing", error_of(lambda: feldspar.Input({"Flat joint/Modulus": 70})))
        self.assertIn('did you mean "Modulus"', error_of(lambda: feldspar.Input({"Flat joint/Modulu": "70 GPa"})))
        self.assertIn("Section/Entry", error_of(lambda: feldspar.Input({"Modulus": "70 GPa"})))
        self.assertIn("not a decimal number", error_of(lambda: feldspar.Input({"Flat joint/Friction": float("nan")})))
        self.assertIn("takes text", error_of(lambda: feldspar.Input({"Flat joint/Friction": {}})))
        self.assertIn("cannot be read", error_of(lambda: feldspar.Input("there_is_none.prm")))
        two = {"Specimen/Minimum radius": "20 mm"}
        self.assertIn("there is no room", error_of(lambda: feldspar.Input(ROCK, two).check()))

    def test_has_all_entries_with_their_meaning(self):
        table = feldspar.entries()
        self.assertEqual(table.loc["Flat joint/Modulus", "unit"], "GPa")
        self.assertIn("Flat joint/Modulus", ROCK.help("modulus").index)


class Specimens(unittest.TestCase):
    def test_come_back_from_their_file(self):
        specimen = feldspar.Specimen(ROCK, seed=3)
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "specimen.h5"
            specimen.save(file)
            again = feldspar.Specimen.load(file, ROCK)
        pandas.testing.assert_frame_equal(again.grains, specimen.grains, check_exact=True)
        pandas.testing.assert_frame_equal(again.joints, specimen.joints, check_exact=True)
        self.assertEqual(again.report["n_grains"], len(specimen.grains))

    def test_stand_in_space_too(self):
        body = feldspar.Specimen(feldspar.Input(ROCK, {"Specimen/Dimension": 3, "Specimen/Minimum radius": "1.2 mm"}))
        self.assertEqual(body.dimension, 3)
        self.assertEqual(list(body.grains), ["x_m", "y_m", "z_m", "radius_m"])
        self.assertGreater(len(body.joints), len(body.grains))

    def test_know_their_minerals(self):
        with tempfile.TemporaryDirectory() as folder:
            table = Path(folder) / "minerals.csv"
            table.write_text("mineral,share [%],size [mm]\nquartz,70,5\nmica,30,5\n")
            grains = feldspar.Specimen(feldspar.Input(ROCK, {"Minerals/Table": str(table)})).grains
        volume = (grains.radius_m**2).groupby(grains.mineral).sum()
        self.assertAlmostEqual(volume[2] / volume.sum(), 0.3, delta=0.03)  # of a few grains
        self.assertTrue((grains.groupby("mineral_grain").mineral.nunique() == 1).all())

    def test_refuses_files_that_are_none(self):
        self.assertIn("no_such", error_of(lambda: feldspar.Specimen.load("no_such.h5")))
        self.assertIn("bodies_test.py", error_of(lambda: feldspar.Specimen.load(__file__)))

    def test_arrays_outlive_their_body(self):
        specimen = feldspar.Specimen(ROCK)
        positions = specimen.core.grains()["x_m"]
        kept = positions.copy()
        del specimen
        gc.collect()
        feldspar.Specimen(ROCK, seed=2)  # takes the memory, if it was given back
        assert_array_equal(positions, kept)


class Tests(unittest.TestCase):
    def test_are_those_of_the_command(self):
        with tempfile.TemporaryDirectory() as folder:
            rock = feldspar.Input(ROCK, {"Tests/List": "triaxial_compression", "Tests/Confinements": "10 MPa"})
            run = feldspar.lab(rock, Path(folder) / "run")
            test = feldspar.Specimen(rock).test("triaxial_compression", confinement="10 MPa").run()
            (name,) = run.curves
            by_command = pandas.read_csv(run.folder / "curves" / f"{name}.csv", float_precision="round_trip")
            cracks = pandas.read_csv(run.folder / "cracks.csv", float_precision="round_trip")
            [of_command] = run.summary["tests"]
        pandas.testing.assert_frame_equal(test.curve, by_command, check_exact=True, check_dtype=False)
        own = test.cracks
        shared = [column for column in own if column != "on_smooth_joint"]
        pandas.testing.assert_frame_equal(own[shared], cracks[shared], check_exact=True, check_dtype=False)
        summary = test.summary
        differing = [key for key, value in of_command.items() if key in summary and summary[key] != value]
        self.assertLessEqual(set(differing), {"name", "wall_time_s"})

    def test_run_to_a_strain_and_on(self):
        test = feldspar.Specimen(ROCK).test("uniaxial_compression")
        self.assertTrue(numpy.isnan(test.stress))
        test.run(until=5e-4)
        self.assertAlmostEqual(test.strain, 5e-4, delta=2e-5)  # a row of the curve
        self.assertFalse(test.has_ended)
        test.run()
        whole = feldspar.Specimen(ROCK).test("uniaxial_compression").run()
        pandas.testing.assert_frame_equal(test.curve, whole.curve, check_exact=True)
        self.assertEqual(len(test.cracks), test.n_cracks)

    def test_end_where_each_says_so(self):
        seen = []

        def each(test):
            seen.append(test.n_rows)
            return test.n_cracks >= 3

        test = feldspar.Specimen(ROCK).test("direct_tension").run(each=each)
        self.assertGreaterEqual(test.n_cracks, 3)
        self.assertEqual(seen, list(range(2, test.n_rows + 1)))

    def test_go_on_after_an_error_in_each(self):
        test = feldspar.Specimen(ROCK).test("direct_tension")

        def raises(test):
            raise RuntimeError("mine")

        with self.assertRaisesRegex(RuntimeError, "mine"):
            test.run(each=raises)
        test.run()
        whole = feldspar.Specimen(ROCK).test("direct_tension").run()
        pandas.testing.assert_frame_equal(test.curve, whole.curve, check_exact=True)

    def test_go_on_after_an_interrupt(self):
        specimen = feldspar.Specimen(feldspar.Input(ROCK, {"Specimen/Minimum radius": "0.3 mm"}))
        test = specimen.test("uniaxial_compression")
        test.advance()  # a seating cannot be gone on with
        signal.signal(signal.SIGINT, signal.default_int_handler)  # which a shell in the background has ignored
        timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            test.run()
        timer.join()
        test.run(until=4e-4)
        whole = specimen.test("uniaxial_compression").run(until=4e-4)
        n = min(test.n_rows, whole.n_rows)
        pandas.testing.assert_frame_equal(test.curve[:n], whole.curve[:n], check_exact=True)

    def test_of_two_threads_do_not_meet(self):
        alone = [feldspar.Specimen(ROCK, seed).test("direct_tension").run().curve for seed in (1, 2)]
        together = [None, None]

        def work(k):
            together[k] = feldspar.Specimen(ROCK, k + 1).test("direct_tension").run().curve

        threads = [threading.Thread(target=work, args=(k,)) for k in (0, 1)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for one, other in zip(alone, together):
            pandas.testing.assert_frame_equal(one, other, check_exact=True)

    def test_are_refused_by_one_line(self):
        specimen = feldspar.Specimen(ROCK)
        self.assertIn("direct_tension", error_of(lambda: specimen.test("direct_tensio")))
        self.assertIn("no confining pressure", error_of(lambda: specimen.test("direct_tension", confinement="5 MPa")))
        self.assertIn("lie in [0", error_of(lambda: specimen.test("triaxial_compression", confinement=-5e6)))
        self.assertIn("unit", error_of(lambda: specimen.test("triaxial_compression", confinement="5")))
        self.assertIn("needs walls", error_of(lambda: feldspar.Specimen(CELL).test("direct_tension")))
        self.assertIn("needs a confining pressure", error_of(lambda: specimen.test("triaxial_compression")))
        self.assertIn("lie in", error_of(lambda: specimen.test("triaxial_compression", confinement=float("inf"))))
        self.assertIn("not True", error_of(lambda: specimen.test("triaxial_compression", confinement=True)))
        self.assertIn("a seed must be", error_of(lambda: feldspar.Specimen(ROCK, seed=-1)))
        self.assertIn("a seed must be", error_of(lambda: feldspar.Specimen(ROCK, seed=1.5)))
        self.assertIn("no column", error_of(lambda: specimen.test("direct_tension").last("zzz")))

    def test_may_be_read_by_another_thread_while_they_run(self):
        test = feldspar.Specimen(ROCK).test("uniaxial_compression")
        test.advance()
        thread = threading.Thread(target=lambda: test.run(until=1e-3))
        thread.start()
        while thread.is_alive():
            curve, cracks = test.curve, test.cracks
            self.assertGreater(len(curve), 0)
            self.assertLessEqual(len(cracks), test.n_cracks)
        thread.join()
        whole = feldspar.Specimen(ROCK).test("uniaxial_compression").run(until=1e-3)
        pandas.testing.assert_frame_equal(test.curve, whole.curve, check_exact=True)

    def test_end_where_each_returns_what_is_true(self):
        test = feldspar.Specimen(ROCK).test("uniaxial_compression")
        test.run(each=lambda one: one.curve["axial_stress_Pa"].max() > 20e6)  # of NumPy
        self.assertAlmostEqual(test.stress, 20e6, delta=3e6)

    def test_are_not_copied(self):
        test = feldspar.Specimen(ROCK).test("direct_tension")
        self.assertIn("cannot be copied", error_of(lambda: copy.copy(test)))

    def test_are_drawn(self):
        test = feldspar.Specimen(ROCK).test("direct_tension").run()
        axes = test.figure()
        self.assertEqual(len(axes.lines[0].get_xdata()), test.n_rows)
        drawn = sum(len(one.get_segments()) for one in test.crack_figure().collections if hasattr(one, "get_segments"))
        self.assertEqual(drawn, test.n_cracks)


class Envelopes(unittest.TestCase):
    def test_give_back_the_rock_that_the_strengths_were_made_of(self):
        sigma_3 = numpy.array([0, 5, 10, 20, 30, 40]) * 1e6
        sigma_ci, m = 150e6, 22.0
        sigma_1 = sigma_3 + sigma_ci * numpy.sqrt(m * sigma_3 / sigma_ci + 1)
        fit = feldspar.fit_envelopes(sigma_3, sigma_1)["intact"]["without_tension_point"]
        assert_allclose([fit["sigma_ci_Pa"], fit["m"]], [sigma_ci, m], rtol=1e-6)
        self.assertIn("one each", error_of(lambda: feldspar.fit_envelopes([0, 1e6], [1e8])))
        self.assertIn("must be above", error_of(lambda: feldspar.fit_envelopes([0, 5e6], [1e8, float("nan")])))


class Presses(unittest.TestCase):
    def test_follow_stages_as_a_loading_table_does(self):
        """The same stages by a table of the command give the same rows to the last bit."""
        with tempfile.TemporaryDirectory() as folder:
            table = Path(folder) / "stages.csv"
            table.write_text(
                "axial_strain,axial_stress_Pa,hold_s,confining_pressure_Pa\n"
                "4e-4,,,5e6\n,30e6,,5e6\n,,2e-5,8e6\n8e-4,,,8e6\n"
            )
            rock = feldspar.Input(ROCK, {"Tests/List": "own_loading", "Tests/Loading table": str(table)})
            run = feldspar.lab(rock, Path(folder) / "run")
            (by_table,) = [pandas.read_csv(one, float_precision="round_trip") for one in run.folder.glob("curves/*.csv")]
        press = feldspar.Specimen(ROCK).press(confinement="5 MPa")
        press.strain_to(4e-4).stress_to("30 MPa").hold(2e-5, confinement="8 MPa").strain_to(8e-4)
        pandas.testing.assert_frame_equal(press.curve, by_table, check_exact=True, check_dtype=False)

    def test_close_a_loop(self):
        """Cycles whose top grows until the cracks do: no input of the command can say so."""
        press = feldspar.Specimen(ROCK).press()
        top = 2e-4
        while press.n_rows == 0 or press.n_cracks < 20:
            press.strain_to(top).stress_to("5 MPa")
            top += 2e-4
        self.assertGreaterEqual(press.n_cracks, 20)
        self.assertLess(press.stress, 5.5e6)

    def test_stop_in_a_stage_and_turn_round(self):
        press = feldspar.Specimen(ROCK).press(confinement="5 MPa")
        press.strain_to(5e-3, each=lambda test: test.stress > 40e6)
        self.assertAlmostEqual(press.stress, 40e6, delta=3e6)
        press.strain_to(1e-4)
        self.assertAlmostEqual(press.strain, 1e-4, delta=1e-5)
        self.assertEqual([one["reached"] for one in press.summary["stages"]], [False, True])

    def test_change_the_confinement_on_the_way(self):
        """The pressure goes evenly with the strain, from where it was: also in the first stage, and after one that was left."""
        press = feldspar.Specimen(ROCK).press(confinement="5 MPa")
        pressures = []

        def each(test):
            pressures.append((test.strain, test.last("lateral_stress_Pa")))
            return test.strain >= 5e-4

        press.strain_to(1e-3, confinement="25 MPa", each=each)
        for strain, pressure in pressures[5:]:
            self.assertAlmostEqual(pressure, 5e6 + 20e6 * strain / 1e-3, delta=1.5e6)  # the walls follow behind
        reached = press.last("lateral_stress_Pa")
        press.strain_to(6e-4, confinement="15 MPa", each=lambda test: True)  # one row
        self.assertAlmostEqual(press.last("lateral_stress_Pa"), reached, delta=1.5e6)

    def test_are_saved_and_resumed(self):
        """A press that is left in a stage, and a test within its run: both go on to the same bits."""
        specimen = feldspar.Specimen(ROCK)
        press = specimen.press(confinement="5 MPa")
        press.strain_to(1e-3, confinement="9 MPa", each=lambda test: test.strain > 5e-4).strain_to(8e-4)
        test = specimen.test("uniaxial_compression").run(until=1e-3)
        with tempfile.TemporaryDirectory() as folder:
            further = lambda press: press.stress_to("20 MPa").strain_to(2e-3)
            for one, go_on in ((press, further), (test, lambda test: test.run())):
                file = Path(folder) / f"{one.kind}.h5"
                one.save(file)
                again = feldspar.Specimen(ROCK).resume(file)
                self.assertEqual((type(again), again.kind, again.n_rows), (type(one), one.kind, one.n_rows))
                pandas.testing.assert_frame_equal(go_on(again).curve, go_on(one).curve, check_exact=True)
                pandas.testing.assert_frame_equal(again.cracks, one.cracks, check_exact=True)
                self.assertEqual(again.summary.get("stages"), one.summary.get("stages"))
            self.assertIn("of another test", error_of(lambda: feldspar.Specimen(ROCK, seed=2).resume(file)))
            self.assertIn("no row yet", error_of(lambda: specimen.test("direct_tension").save(file)))
            specimen.save(file)
            self.assertIn("a saved test", error_of(lambda: specimen.resume(file)))

    def test_hold_at_rest(self):
        """A body without load has energies of round-off alone, which are no fault."""
        press = feldspar.Specimen(ROCK).press().hold("0.1 ms")
        self.assertLess(abs(press.stress), 1.0)

    def test_are_refused_by_one_line(self):
        press = feldspar.Specimen(ROCK).press()
        self.assertIn("first stage", error_of(lambda: press.curve))
        self.assertIn("[0, 0.2]", error_of(lambda: press.strain_to(-1.0)))
        press.strain_to(1e-4)
        self.assertIn("confining_pressure", error_of(lambda: press.hold(1e-5, confinement="5 MPa")))
        self.assertEqual(press.strain_to(2e-4).n_rows, len(press.curve))


class RepresentativeVolumes(unittest.TestCase):
    def test_answer_as_the_path_of_the_command(self):
        """The path of a command through breaks and back, gone by relax() and accept() or by tokens: the same bits."""
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "path.csv"
            path.write_text("strain_xx,strain_yy,strain_xy\n0,3e-4,0\n1e-4,2e-4,1e-4\n")
            rock = feldspar.Input(CELL, {"Strain path/File": str(path)})
            run = feldspar.rve_path(rock, Path(folder) / "run")
            (curve,) = [pandas.read_csv(one, float_precision="round_trip") for one in run.folder.glob("curves/*.csv")]
        rve = feldspar.Rve(CELL)
        volumes, token = feldspar.Volumes(CELL, 1), 0
        for _, row in curve.iterrows():
            strain = [row["strain_xx"], row["strain_yy"], 2 * row["strain_xy"]]
            stress = [row[f"stress_{k}_Pa"] for k in ("xx", "yy", "xy")]
            intact = rve.is_intact
            trial = rve.relax(strain)
            rve.accept()
            token, stresses, _ = volumes.update([strain], parent=token)
            assert_array_equal(trial.stress, stress)
            assert_array_equal(stresses[0], stress)
            self.assertEqual(rve.n_broken, row["n_tension_cracks"] + row["n_shear_cracks"])
            if intact and trial.n_breaks == 0:
                assert_allclose(trial.stress, rve.stiffness @ strain, rtol=1e-13, atol=1e-6)
        self.assertGreater(rve.n_broken, 20)

    def test_break_first_where_the_closed_form_says(self):
        rve = feldspar.Rve(CELL)
        first = rve.first_break([0, 1, 0])
        self.assertEqual(rve.relax([0, first * (1 - 1e-9), 0]).n_breaks, 0)
        self.assertGreater(rve.relax([0, first * (1 + 1e-9), 0]).n_breaks, 0)

    def test_change_by_accept_alone(self):
        rve = feldspar.Rve(CELL)
        strain = numpy.array([0.0, 1.2 * rve.first_break([0, 1, 0]), 0.0])
        broken = rve.relax(strain, tangent=True)
        self.assertTrue(rve.is_intact)
        rve.reject()
        self.assertIn("nothing has been tried", error_of(rve.accept))
        rve.accept(broken)
        self.assertEqual(rve.n_broken, broken.n_breaks)
        assert_array_equal(rve.stress, broken.stress)
        assert_allclose(rve.tangent, broken.tangent, rtol=1e-9, atol=1e-6 * numpy.abs(broken.tangent).max())
        state = rve.state
        other = feldspar.Rve(CELL)
        other.restore(state)
        assert_array_equal(other.relax(1.2 * strain).stress, rve.copy().relax(1.2 * strain).stress)

    def test_tangent_is_the_derivative(self):
        rve = feldspar.Rve(CELL)
        strain = numpy.array([0.0, 1.5 * rve.first_break([0, 1, 0]), 0.0])
        rve.relax(strain)
        rve.accept()
        tangent = rve.tangent
        step = 1e-9  # small beside the strain of 1e-4, large beside round-off of 1e-6 of the stress
        for k in range(3):
            further = strain.copy()
            further[k] += step
            derivative = (rve.trial(further).stress - rve.stress) / step
            assert_allclose(derivative, tangent[:, k], atol=0.02 * numpy.abs(tangent).max())

    def test_are_refused_by_one_line(self):
        rve = feldspar.Rve(CELL)
        self.assertIn("must be 3: xx, yy, xy", error_of(lambda: rve.trial([0, 0, 0, 0, 0, 0])))
        self.assertIn("not in [-0.1, 0.1]", error_of(lambda: rve.trial([0, float("nan"), 0])))
        self.assertIn("stored state", error_of(lambda: rve.restore(rve.state + b"x")))
        self.assertIn("periodic", error_of(lambda: feldspar.Rve(ROCK)))
        self.assertIn("periodic", error_of(lambda: feldspar.Rve(feldspar.Specimen(ROCK))))
        self.assertIn("finite", error_of(lambda: rve.first_break([float("nan"), 0, 0])))
        with self.assertRaises((TypeError, ValueError)):
            rve.trial(["1", "a", "2"])


    def test_take_states_and_trials_of_their_own_cell_alone(self):
        rve = feldspar.Rve(CELL)
        strain = [0, 1.2 * rve.first_break([0, 1, 0]), 0]
        trial = rve.relax(strain)
        other = feldspar.Rve(CELL, seed=2)
        self.assertIn("another cell", error_of(lambda: other.accept(trial)))
        rve.accept()
        state = rve.state
        self.assertIn("another cell", error_of(lambda: other.restore(state)))
        changed = bytearray(state)
        changed[len(state) // 2] ^= 1
        self.assertIn("was changed", error_of(lambda: other.restore(bytes(changed))))
        feldspar.Rve(CELL).restore(state)

    def test_forget_a_trial_when_the_next_fails(self):
        rve = feldspar.Rve(CELL)
        rve.relax([0, 1e-5, 0])
        error_of(lambda: rve.relax([0, 1.0, 0]))
        self.assertIn("nothing has been tried", error_of(rve.accept))

    def test_are_copied_with_their_state(self):
        rve = feldspar.Rve(CELL)
        rve.relax([0, 1e-5, 0])
        rve.accept()
        other = copy.deepcopy(rve)
        other.relax([0, 2e-5, 0])
        other.accept()
        self.assertAlmostEqual(rve.strain[1], 1e-5, places=15)


class ManyVolumes(unittest.TestCase):
    def test_answer_as_one_does(self):
        n = 30
        volumes = feldspar.Volumes(CELL, n, realisations=2)
        strains = numpy.zeros((n, 3))
        strains[:, 1] = numpy.linspace(1e-5, 5e-4, n)
        token, stresses, tangents = volumes.update(strains, tangent=True)
        for k in range(n):
            rve = feldspar.Rve(volumes.specimens[k % 2])
            trial = rve.relax(strains[k], tangent=True)
            assert_array_equal(trial.stress, stresses[k])
            assert_array_equal(trial.tangent, tangents[k])
            self.assertEqual(trial.n_breaks, volumes.n_broken(token)[k])

    def test_give_the_same_bits_on_any_number_of_threads(self):
        volumes = feldspar.Volumes(CELL, 40)
        strains = numpy.linspace(0, 6e-4, 120).reshape(40, 3)
        feldspar.set_threads(1)
        _, one, _ = volumes.update(strains)
        feldspar.set_threads(0)
        _, all_of_them, _ = volumes.update(strains)
        assert_array_equal(one, all_of_them)

    def test_branch_from_an_accepted_state(self):
        volumes = feldspar.Volumes(CELL, 2)
        first, _, _ = volumes.update([[0, 2e-4, 0], [0, 5e-4, 0]])
        one, a, _ = volumes.update([[0, 3e-4, 0], [0, 6e-4, 0]], parent=first)
        two, b, _ = volumes.update([[0, 3e-4, 0], [0, 6e-4, 0]], parent=first)
        assert_array_equal(a, b)
        volumes.update([[0, 0, 0], [0, 0, 0]], parent=two)
        self.assertIn("not known", error_of(lambda: volumes.update([[0, 0, 0], [0, 0, 0]], parent=one)))
        self.assertIn("not known", error_of(lambda: volumes.update([[0, 0, 0], [0, 0, 0]], parent=0)))

    def test_are_refused_by_one_line(self):
        volumes = feldspar.Volumes(CELL, 2)
        self.assertIn("shape (2, 3)", error_of(lambda: volumes.update([[0, 0, 0]])))
        self.assertIn("not in", error_of(lambda: volumes.update([[0, 0, 1], [0, 0, 0]])))
        self.assertIn("in [0, 0], not 1", error_of(lambda: feldspar.Volumes(CELL, 2, assigned=[0, 1])))
        token, _, _ = volumes.update(numpy.zeros((2, 3)))
        self.assertEqual(token, 1)  # what was refused left nothing


if __name__ == "__main__":
    unittest.main()
