// What Python sees: components/python/insonify/__init__.py makes a friendlier face of it.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>

#include "components/deployer/Simulation.hpp"
#include "components/log/Reader.hpp"
#include "components/python/Arrays.hpp"
#include "types/ConfigError.hpp"
#include "types/RequireSound.hpp"

namespace insonify::python {
namespace {

using deployer::Simulation, deployer::SimulationOptions, deployer::SteppedPing;

/** A name of an enumeration as its value. */
template <class Enum>
Enum valueOf(const std::string& name, const char* what) {
    const auto& names = types::EnumNames<Enum>::names;
    const auto found = std::ranges::find(names, name);
    if (found != std::end(names)) return static_cast<Enum>(found - std::begin(names));
    std::string known;
    for (const std::string_view each : names) known += (known.empty() ? "" : ", ") + std::string(each);
    throw types::ConfigError("", what, "is " + name + "; it may be " + known);
}

struct PyPing {
    types::SonarPtr ping;
    types::SonarTruthPtr truth;
};

py::object pingOrNone(const SteppedPing& made) {
    return made.ping ? py::cast(PyPing{made.ping, made.truth}) : py::none();
}

void addPing(py::module_& module) {
    py::class_<PyPing>(module, "Ping", "One ping: echoes of each beam by slant range, beam-first")
        .def_property_readonly("time", [](const PyPing& self) { return self.ping->time.seconds(); })
        .def_property_readonly("bins", [](const PyPing& self) { return binsOf(self.ping); })
        .def_property_readonly("bearings", [](const PyPing& self) { return bearingsOf(*self.ping); })
        .def_property_readonly("ranges", [](const PyPing& self) { return rangesOf(*self.ping); })
        .def_property_readonly("speed_of_sound", [](const PyPing& self) { return self.ping->speed_of_sound; })
        .def_property_readonly("beam_width", [](const PyPing& self) { return self.ping->beam_width.rad; })
        .def_property_readonly("beam_height", [](const PyPing& self) { return self.ping->beam_height.rad; })
        .def_property_readonly("bin_length", [](const PyPing& self) { return self.ping->binStart(1); })
        .def_property_readonly(
            "_truth",
            [](const PyPing& self) -> py::object { return self.truth ? py::object(truthOf(self.truth)) : py::none(); })
        .def("_fan", [](const PyPing& self, uint32_t width, double dynamic_range_db, std::optional<double> reference_db,
                        const std::string& colour_map, const std::string& scale, int code_bits) {
            return fanOf(*self.ping,
                         {width, dynamic_range_db, reference_db, valueOf<output::ColourMap>(colour_map, "colour_map"),
                          valueOf<output::BinScale>(scale, "scale"), code_bits});
        });
}

void addSimulation(py::module_& module) {
    py::class_<Simulation>(module, "Simulation")
        .def(py::init([](const std::string& deployment, uint64_t seed, std::vector<std::string> overrides, bool truth,
                         std::optional<double> period) {
            const py::gil_scoped_release others;
            return std::make_unique<Simulation>(deployment, SimulationOptions{seed, overrides, truth, period, {}});
        }))
        .def_property_readonly("poses", &Simulation::poses)
        .def_property_readonly("pings", &Simulation::pings)
        .def_property_readonly("period", &Simulation::period)
        .def_property_readonly("time", &Simulation::time)
        .def("step",
             [](Simulation& self, const std::map<std::string, std::pair<Numbers, Numbers>>& given,
                std::optional<double> time) {
                 std::map<std::string, types::Pose> poses;
                 for (const auto& [port, pose] : given) poses[port] = poseOf(pose.first, pose.second);
                 std::vector<SteppedPing> made;
                 {
                     const py::gil_scoped_release others;
                     made = self.step(std::move(poses), time);
                 }
                 py::list pings;
                 for (const SteppedPing& each : made) pings.append(pingOrNone(each));
                 return pings;
             })
        .def("reset", &Simulation::reset, py::call_guard<py::gil_scoped_release>());
}

/** The samples of one stream of a log, read when asked for. */
struct PyStream {
    std::shared_ptr<log::Reader> log;
    size_t stream;
    std::vector<size_t> samples;  ///< Places in Reader::samples().

    const log::Stream& declared() const { return log->streams()[stream]; }
};

py::object sampleOf(const PyStream& stream, size_t index) {
    const log::SampleRef& at = stream.log->samples()[stream.samples[index]];
    if (log::holdsPings(stream.declared())) {
        auto ping = std::make_shared<types::Sonar>();
        log::readPing(*stream.log, at, *ping);
        types::requireSound<types::ConfigError>(*ping, "a sample of the log", "", "");
        return py::cast(PyPing{std::move(ping), nullptr});
    }
    if (stream.declared().holds<types::SonarTruth>()) {
        auto truth = std::make_shared<types::SonarTruth>();
        stream.log->read(at, *truth);
        types::requireSound<types::ConfigError>(*truth, "a sample of the log", "", "");
        return truthOf(truth);
    }
    return std::visit(
        [](const auto* sample) -> py::object {
            using T = std::remove_cvref_t<decltype(*sample)>;
            if constexpr (std::is_same_v<T, types::Pose>)
                return py::make_tuple(sample->time.seconds(),
                                      py::make_tuple(sample->position.x, sample->position.y, sample->position.z),
                                      py::make_tuple(sample->orientation.w, sample->orientation.x,
                                                     sample->orientation.y, sample->orientation.z));
            else if constexpr (std::is_same_v<T, types::Image>)
                return pixelsOf(*sample);
            else if constexpr (types::Scalar<T>)
                return py::cast(types::numberOf(*sample));
            else if constexpr (std::is_same_v<T, std::string>)
                return py::cast(*sample);
            else
                throw py::type_error("samples of this type are not read from Python; insonify log export writes them");
        },
        stream.log->sampleAt(at));
}

std::vector<PyStream> streamsOf(const std::string& path) {
    const std::shared_ptr<log::Reader> log = log::openLog(path);
    std::vector<PyStream> streams;
    for (size_t i = 0; i < log->streams().size(); ++i) streams.push_back({log, i, {}});
    for (size_t i = 0; i < log->samples().size(); ++i) streams[log->samples()[i].stream].samples.push_back(i);
    return streams;
}

void addLog(py::module_& module) {
    py::class_<PyStream>(module, "Stream")
        .def_property_readonly("name", [](const PyStream& self) { return self.declared().name; })
        .def_property_readonly("type", [](const PyStream& self) { return self.declared().type; })
        .def_property_readonly("metadata", [](const PyStream& self) { return self.declared().metadata; })
        .def_property_readonly("times",
                               [](const PyStream& self) {
                                   py::array_t<double> times(static_cast<py::ssize_t>(self.samples.size()));
                                   for (size_t i = 0; i < self.samples.size(); ++i)
                                       times.mutable_data()[i] = self.log->samples()[self.samples[i]].time.seconds();
                                   return times;
                               })
        .def("__len__", [](const PyStream& self) { return self.samples.size(); })
        .def("_sample", [](const PyStream& self, size_t index) {
            if (index >= self.samples.size()) throw py::index_error();
            return sampleOf(self, index);
        });
    module.def("streams", &streamsOf);
}

/** ConfigError of the C++ side as insonify.ConfigError, with its diagnostics. */
void addErrors(py::module_& module) {
    static PyObject* const error = PyErr_NewException("insonify.ConfigError", PyExc_ValueError, nullptr);
    module.attr("ConfigError") = py::handle(error);
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            if (thrown) std::rethrow_exception(thrown);
        } catch (const types::ConfigError& wrong) {
            py::object made = py::handle(error)(wrong.what());
            py::list diagnostics;
            for (const types::Diagnostic& each : wrong.diagnostics()) {
                py::dict told;
                told["file"] = each.file;
                told["line"] = each.line;
                told["column"] = each.column;
                told["path"] = each.path;
                told["message"] = each.message;
                diagnostics.append(told);
            }
            made.attr("diagnostics") = diagnostics;
            for (const char* key : {"file", "line", "column"})
                made.attr(key) = diagnostics.empty() ? py::none() : py::object(diagnostics[0][key]);
            PyErr_SetObject(error, made.ptr());
        }
    });
}

}  // namespace
}  // namespace insonify::python

PYBIND11_MODULE(_insonify, module) {
    module.doc() = "Imaging sonar from a 3-D scene: the part that is C++";
    insonify::python::addErrors(module);
    insonify::python::addPing(module);
    insonify::python::addSimulation(module);
    insonify::python::addLog(module);
}
