#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "components/dataset/Classes.hpp"

namespace insonify::dataset {

/** An object's name, that of its node where it differs, and those of the nodes above it up to the root. */
using Lineage = std::vector<std::string>;

/** What the objects of a scene are annotated as: several that are parts of one thing are one instance.
 *
 *  An object is of the class of the nearest of its names that has one. It is part of the outermost node of this class
 *  above it, so that the arms and legs of a `diver_1` are one instance of `diver_*`, and a `wheel_*` below a `car_*` is
 *  a wheel. */
class Instances {
public:
    /** @param objects one for each object of the scene, in the order of its geometry */
    Instances(const Classes& classes, const std::vector<Lineage>& objects);

    size_t objectCount() const { return instances_.size(); }
    /** The first object of the instance that an object is part of. */
    int32_t of(int32_t object) const { return instances_[static_cast<size_t>(object)].first; }
    /** By of(): name of the instance; its class, 0 for none; the class of its shadow, 0 for none. */
    const std::string& name(int32_t instance) const { return instances_[static_cast<size_t>(instance)].name; }
    uint32_t category(int32_t instance) const { return instances_[static_cast<size_t>(instance)].category; }
    uint32_t shadow(int32_t instance) const { return instances_[static_cast<size_t>(instance)].shadow; }
    /** All objects that are part of it, in order. */
    std::vector<int32_t> parts(int32_t instance) const;

private:
    struct Instance {
        int32_t first;
        std::string name;
        uint32_t category, shadow;
    };
    std::vector<Instance> instances_;  ///< One for each object.
};

}  // namespace insonify::dataset
