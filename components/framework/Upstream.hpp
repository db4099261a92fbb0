#pragma once
// What a task can know of those from which it hears: the frequency of a sonar, the mount of a scene.
#include <initializer_list>
#include <optional>
#include <string>

#include "components/framework/Port.hpp"
#include "types/TaskRecord.hpp"

namespace insonify::framework {

/** The value of a property, or within a block at a path such as "head.left_deg"; none: it is not there. */
std::optional<types::PropertyValue> valueAt(const types::TaskRecord& task, const std::string& path);

/** The first of these properties that the nearest task has from which a port hears, directly or by others; none: no
 *  such task has one. */
std::optional<types::PropertyValue> upstreamValue(const InputPortBase& port, std::initializer_list<const char*> paths);

/** The frequency of the sonar from which a port hears, else that of its absorption [kHz]; none: it is not given. */
std::optional<double> upstreamFrequency(const InputPortBase& port);

}  // namespace insonify::framework
