#pragma once
// What a task can know of those from which it hears.
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "components/framework/Port.hpp"
#include "types/Mount.hpp"
#include "types/TaskRecord.hpp"

namespace insonify::framework {

/** The value of a property, or within a block at a path such as "head.left_deg"; none: it is not there. */
std::optional<types::PropertyValue> valueAt(const types::TaskRecord& task, const std::string& path);

/** The first of these properties that the nearest task has from which a port hears, directly or by others; none: no
 *  such task has one. */
std::optional<types::PropertyValue> upstreamValue(const InputPortBase& port, std::initializer_list<const char*> paths);

/** The same for a number. */
std::optional<double> upstreamNumber(const InputPortBase& port, std::initializer_list<const char*> paths);

/** The same for a property `mount`: where in its body the sensor is whose samples these are. */
std::optional<types::Mount> upstreamMount(const InputPortBase& port);

/** The output ports of poses that a port's samples depend on, nearest first. */
std::vector<const OutputPortBase*> upstreamPoses(const InputPortBase& port);

}  // namespace insonify::framework
