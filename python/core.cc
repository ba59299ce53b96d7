#include <feldspar/feldspar.h>

#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

/// The compiled part of the Python module: the face of the library, with NumPy arrays for its vectors. The modules beside it
/// make the objects that users meet.
namespace
{
namespace py = pybind11;
using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
using WithoutInterpreter = py::call_guard<py::gil_scoped_release>;

/// Lets Python handle its signals ten times a second while the library works without the interpreter; ends the work where
/// one of them raises, as Ctrl-C does.
feldspar::Check signals()
{
  using Clock = std::chrono::steady_clock;
  constexpr Clock::duration between = std::chrono::milliseconds(100);
  const auto next = std::make_shared<std::atomic<Clock::rep>>((Clock::now() + between).time_since_epoch().count());
  return [=] {
    const Clock::rep now = Clock::now().time_since_epoch().count();
    Clock::rep due = *next;
    if (now < due || !next->compare_exchange_strong(due, now + between.count()))
      return false;
    const py::gil_scoped_acquire interpreter;
    return PyErr_CheckSignals() != 0;
  };
}

/// An array that takes the numbers of a vector, without a copy.
py::array_t<double> array_of(std::vector<double>&& values)
{
  auto kept = std::make_unique<std::vector<double>>(std::move(values));
  const double* const data = kept->data();
  const std::size_t n = kept->size();
  const py::capsule owner(kept.release(), [](void* const vector) { delete static_cast<std::vector<double>*>(vector); });
  return {{n}, {sizeof(double)}, data, owner};
}

py::array matrix_of(std::vector<double>&& values, const std::size_t n)
{
  return array_of(std::move(values)).reshape({py::ssize_t(n), py::ssize_t(n)});
}

py::dict dict_of(feldspar::Table&& table)
{
  py::dict columns;
  for (feldspar::Column& column : table)
    if (column.is_count)
      columns[py::str(column.name)] = py::array_t<std::int64_t>(array_of(std::move(column.values)));
    else
      columns[py::str(column.name)] = array_of(std::move(column.values));
  return columns;
}

/// The outcome of work that may have to wait for another thread, which needs the interpreter.
template <typename Work>
auto waiting(const Work& work)
{
  const py::gil_scoped_release released;
  return work();
}

std::span<const double> span_of(const Array& array) { return {array.data(), std::size_t(array.size())}; }

std::size_t n_voigt(const int dimension) { return dimension == 2 ? 3 : 6; }

py::tuple update(feldspar::Volumes& volumes, const Array& strains, const std::uint64_t parent, const bool with_tangent,
                 const bool bonds_break)
{
  const auto n = py::ssize_t(volumes.size());
  const auto m = py::ssize_t(n_voigt(volumes.dimension()));
  if (strains.ndim() != 2 || strains.shape(0) != n || strains.shape(1) != m)
    throw feldspar::Error("strains must have the shape (" + std::to_string(n) + ", " + std::to_string(m) + ")");
  py::array_t<double> stresses({n, m});
  py::array_t<double> tangents(with_tangent ? std::vector<py::ssize_t>{n, m, m} : std::vector<py::ssize_t>{0});
  const std::span<double> stress(stresses.mutable_data(), std::size_t(stresses.size()));
  const std::span<double> tangent(tangents.mutable_data(), std::size_t(tangents.size()));
  const std::span<const double> strain = span_of(strains);
  const std::uint64_t token =
    waiting([&] { return volumes.update(strain, parent, stress, tangent, bonds_break, signals()); });
  return py::make_tuple(token, stresses, with_tangent ? py::object(tangents) : py::none());
}
} // namespace

PYBIND11_MODULE(_core, module)
{
  using namespace feldspar;
  module.doc() = "The compiled part of feldspar.";
  py::register_exception<Error>(module, "Error", PyExc_ValueError).attr("__doc__") =
    "The user's mistake, in one line: what is wrong, where, what is allowed.";
  py::register_exception_translator([](std::exception_ptr error) {
    try
      {
        if (error)
          std::rethrow_exception(error);
      }
    catch (const Stopped&)
      {
        if (!PyErr_Occurred()) // what a signal raised stands already
          PyErr_SetNone(PyExc_KeyboardInterrupt);
      }
  });

  module.def("version", &version);
  module.def("set_threads", &set_threads, py::arg("n"));
  module.def("in_si", &in_si, py::arg("text"), py::arg("quantity"));
  py::class_<EntryDescription>(module, "EntryDescription")
    .def_readonly("name", &EntryDescription::name)
    .def_readonly("unit", &EntryDescription::unit)
    .def_readonly("range", &EntryDescription::range)
    .def_readonly("preset", &EntryDescription::preset)
    .def_readonly("meaning", &EntryDescription::meaning);
  module.def("entries", &entries);
  module.def(
    "fit_envelopes",
    [](const Array& sigma_3, const Array& sigma_1, const std::optional<double> tensile_strength) {
      return fit_envelopes(span_of(sigma_3), span_of(sigma_1), tensile_strength);
    },
    py::arg("sigma_3"), py::arg("sigma_1"), py::arg("tensile_strength"));

  py::class_<Input>(module, "Input")
    .def(py::init<>())
    .def(py::init<const std::string&>(), py::arg("file"))
    .def(py::init<const Input&>(), py::arg("other"))
    .def("set", &Input::set, py::arg("entry"), py::arg("value"))
    .def("get", &Input::get, py::arg("entry"))
    .def("unset", &Input::unset, py::arg("entry"))
    .def("given", &Input::given)
    .def("check", &Input::check);

  py::class_<Specimen>(module, "Specimen")
    .def(py::init([](const Input& input, const std::uint64_t seed) { return Specimen(input, seed, signals()); }),
         WithoutInterpreter(), py::arg("input"), py::arg("seed"))
    .def_static(
      "load", [](const std::string& file) { return Specimen::load(file, signals()); }, WithoutInterpreter(),
      py::arg("file"))
    .def("save", &Specimen::save, WithoutInterpreter(), py::arg("file"))
    .def_property_readonly("dimension", &Specimen::dimension)
    .def_property_readonly("seed", &Specimen::seed)
    .def_property_readonly("is_periodic", &Specimen::is_periodic)
    .def("size", [](const Specimen& specimen) { return array_of(specimen.size()); })
    .def("grains", [](const Specimen& specimen) { return dict_of(specimen.grains()); })
    .def("joints", [](const Specimen& specimen) { return dict_of(specimen.joints()); })
    .def("report", &Specimen::report);

  py::class_<Stage>(module, "Stage")
    .def(py::init([](const std::optional<double> axial_strain, const std::optional<double> axial_stress,
                     const std::optional<double> lateral_strain, const std::optional<double> duration,
                     const double confining_pressure, const std::optional<double> strain_rate) {
           return Stage{axial_strain, axial_stress, lateral_strain, duration, confining_pressure, strain_rate};
         }),
         py::kw_only(), py::arg("axial_strain") = py::none(), py::arg("axial_stress") = py::none(),
         py::arg("lateral_strain") = py::none(), py::arg("duration") = py::none(), py::arg("confining_pressure") = 0.0,
         py::arg("strain_rate") = py::none())
    .def_readonly("confining_pressure", &Stage::confining_pressure);

  py::class_<Test>(module, "Test")
    .def(py::init<const Specimen&, const Input&, std::string_view, double>(), WithoutInterpreter(), py::arg("specimen"),
         py::arg("input"), py::arg("kind"), py::arg("confining_pressure"))
    .def(py::init<const Specimen&, const Input&, double, const Stage&>(), WithoutInterpreter(), py::arg("specimen"),
         py::arg("input"), py::arg("confining_pressure"), py::arg("first"))
    .def("follow", &Test::follow, WithoutInterpreter(), py::arg("stage"))
    .def_property_readonly("kind", &Test::kind)
    .def_property_readonly("stages", &Test::stages)
    .def("save", &Test::save, WithoutInterpreter(), py::arg("file"))
    .def_static("load", &Test::load, WithoutInterpreter(), py::arg("specimen"), py::arg("input"), py::arg("file"))
    .def(
      "advance", [](Test& test) { return test.advance(signals()); }, WithoutInterpreter())
    .def_property_readonly("has_ended", [](const Test& test) { return waiting([&] { return test.has_ended(); }); })
    .def_property_readonly("n_rows", [](const Test& test) { return waiting([&] { return test.n_rows(); }); })
    .def("columns", &Test::columns)
    .def("last_row", [](const Test& test) { return array_of(waiting([&] { return test.last_row(); })); })
    .def(
      "curve",
      [](const Test& test, const std::uint64_t first) { return dict_of(waiting([&] { return test.curve(first); })); },
      py::arg("first"))
    .def("cracks", [](const Test& test) { return dict_of(waiting([&] { return test.cracks(); })); })
    .def("grains", [](const Test& test) { return dict_of(waiting([&] { return test.grains(); })); })
    .def("summary", &Test::summary, WithoutInterpreter());

  const auto strain_of = [](const auto& body) { return array_of(body.strain()); };
  const auto stress_of = [](const auto& body) { return array_of(body.stress()); };
  py::class_<Trial>(module, "Trial", "The response of a representative volume to a strain.")
    .def_property_readonly("in_equilibrium", &Trial::in_equilibrium,
                           "False where none was found: stress and strain are where the search ended.")
    .def_property_readonly(
      "strain", [=](const Trial& trial) { return strain_of(trial); }, "Strain, in Voigt's order.")
    .def_property_readonly(
      "stress", [=](const Trial& trial) { return stress_of(trial); }, "Mean stress [Pa].")
    .def_property_readonly("n_breaks", &Trial::n_breaks, "Number of segments that break.")
    .def_property_readonly(
      "tangent",
      [](const Trial& trial) -> py::object {
        auto values = trial.tangent();
        return values.empty() ? py::object(py::none()) : matrix_of(std::move(values), trial.strain().size());
      },
      "Derivative of the stress by the strain [Pa]; None where it was not asked for.");

  const auto asking = [](Trial (Rve::*const ask)(std::span<const double>, bool, const Check&) const) {
    return [ask](const Rve& rve, const Array& strain, const bool tangent) {
      const auto numbers = span_of(strain);
      return waiting([&] { return (rve.*ask)(numbers, tangent, signals()); });
    };
  };
  py::class_<Rve>(module, "Rve")
    .def(py::init<const Specimen&, const Input&>(), WithoutInterpreter(), py::arg("specimen"), py::arg("input"))
    .def(py::init<const Rve&>(), py::arg("other"))
    .def_property_readonly("dimension", &Rve::dimension)
    .def_property_readonly("stiffness",
                           [](const Rve& rve) { return matrix_of(rve.stiffness(), n_voigt(rve.dimension())); })
    .def_property_readonly("strain", [=](const Rve& rve) { return strain_of(rve); })
    .def_property_readonly("stress", [=](const Rve& rve) { return stress_of(rve); })
    .def_property_readonly("is_intact", &Rve::is_intact)
    .def_property_readonly("n_broken", &Rve::n_broken)
    .def("trial", asking(&Rve::trial), py::arg("strain"), py::arg("tangent"))
    .def("relax", asking(&Rve::relax), py::arg("strain"), py::arg("tangent"))
    .def("accept", &Rve::accept, WithoutInterpreter(), py::arg("trial"))
    .def(
      "first_break", [](const Rve& rve, const Array& direction) { return rve.first_break(span_of(direction)); },
      py::arg("direction"))
    .def("state", [](const Rve& rve) { return py::bytes(rve.state()); })
    .def("restore", &Rve::restore, py::arg("state"));

  py::class_<Volumes>(module, "Volumes")
    .def(py::init([](const std::vector<Specimen>& specimens, const Input& input, const std::size_t n,
                     const std::vector<std::size_t>& assigned) { return Volumes(specimens, input, n, assigned); }),
         WithoutInterpreter(), py::arg("specimens"), py::arg("input"), py::arg("n"), py::arg("assigned"))
    .def("__len__", &Volumes::size)
    .def_property_readonly("dimension", &Volumes::dimension)
    .def("update", &update, py::arg("strains"), py::arg("parent"), py::arg("with_tangent"), py::arg("bonds_break"))
    .def("n_broken", &Volumes::n_broken, py::arg("token"));
}
