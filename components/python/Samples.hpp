#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "components/console/Json.hpp"
#include "components/log/Reader.hpp"
#include "components/output/tasks/PictureConfig.hpp"
#include "types/samples/Sonar.hpp"
#include "types/samples/SonarTruth.hpp"

namespace insonify::python {

/** Numbers owned by a handle, row by row. */
struct Array {
    const char* name;
    const char* type;  ///< In numpy's notation: "f4".
    const void* numbers;
    uint64_t shape[3];
    uint32_t dimensions;
};

/** An object held by Python: facts and arrays. */
class Handle {
public:
    virtual ~Handle() = default;
    virtual console::Json facts() const = 0;
    virtual std::vector<Array> arrays() const { return {}; }
};

/** Makes a handle of a ping: facts `{kind: ping, time, ...}`, arrays `bins` [beams, bins], `bearings` [rad] and
 *  `ranges` [m], which is the slant range at the middle of each bin.
 *  @param truth null: none; otherwise its arrays are there as well, and its `objects` among the facts. */
std::unique_ptr<Handle> pingHandle(types::SonarPtr ping, types::SonarTruthPtr truth);
/** Joins pings of one shape: arrays `bins` [pings, beams, bins], `times` [s] of each, `bearings` and `ranges` of the
 *  first. */
std::unique_ptr<Handle> pingsHandle(const std::vector<types::SonarPtr>& pings,
                                    const std::vector<types::SonarTruthPtr>& truths);
/** Renders the ping of a handle from pingHandle() as a fan. Throws types::ConfigError for an impossible picture. */
std::unique_ptr<Handle> fanHandle(const Handle& ping, const output::DisplayConfig& display);

/** Reads a sample of a log; its kind is ping, truth, pose, picture, number, integer or text. Throws UnreadableType for
 *  others. */
std::unique_ptr<Handle> sampleHandle(log::Reader& log, const log::SampleRef& at);

class UnreadableType : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace insonify::python
