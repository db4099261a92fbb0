#pragma once
// Both ends of a connection, for the test of a lone task.
//
//     Writer<types::SonarPtr> in;
//     in.port.connectTo(task.clean, {});
//     in.port.write(ping);
#include "components/framework/Port.hpp"
#include "components/framework/TaskContext.hpp"

namespace insonify::test {

template <class T>
struct Writer : framework::TaskContext {
    explicit Writer(std::string name = "writer") : TaskContext(std::move(name)) {}
    framework::OutputPort<T> port{this, "port", "written by the test"};
};

template <class T>
struct Reader : framework::TaskContext {
    explicit Reader(std::string name = "reader") : TaskContext(std::move(name)) {}
    framework::InputPort<T> port{this, "port", "read by the test"};
};

}  // namespace insonify::test
