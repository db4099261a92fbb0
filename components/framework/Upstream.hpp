#pragma once
// Properties of the tasks that a task's samples come from.
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "components/framework/Port.hpp"
#include "types/ReturnLevels.hpp"
#include "types/geometry/Mount.hpp"
#include "types/samples/TaskRecord.hpp"

namespace insonify::framework {

/** Returns the value of a property, or of a path such as "head.left_deg" within a block; none: not present. */
std::optional<types::PropertyValue> valueAt(const types::TaskRecord& task, const std::string& path);

/** Returns the first of these properties that the nearest task upstream of the port has, directly or through others;
 *  none: no task has one. */
std::optional<types::PropertyValue> upstreamValue(const InputPortBase& port, std::initializer_list<const char*> paths);

/** As upstreamValue, for a number. */
std::optional<double> upstreamNumber(const InputPortBase& port, std::initializer_list<const char*> paths);

/** Returns how the samples of a port fall with range: after the nearest ReturnSource upstream, and the receiver
 *  between; the defaults where there is no such source.
 *  @param amplified  content of the ports whose samples a receiver has amplified */
types::ReturnRules upstreamReturnRules(const InputPortBase& port, const char* amplified);

/** As upstreamValue, for the property `mount`: the pose on its body of the sensor that made the samples. */
std::optional<types::Mount> upstreamMount(const InputPortBase& port);

/** Returns why the samples of a port are no codes, by the properties of the tasks upstream: none codes them, or one has
 *  another output. Empty: they are codes, or nothing is known. */
std::string whyNoCodes(const InputPortBase& port);

/** The output ports of poses that a port's samples depend on, nearest first. */
std::vector<const OutputPortBase*> upstreamPoses(const InputPortBase& port);

}  // namespace insonify::framework
