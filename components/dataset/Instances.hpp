#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "components/dataset/Classes.hpp"

namespace insonify::dataset {

/** Names of an object: its own, its node's if that differs, and those of the nodes above up to the root. */
using Lineage = std::vector<std::string>;

/** The instances in a scene: several objects that are parts of one thing are one instance.
 *
 *  An object has the class of the nearest of its names that has a class. It is part of the outermost node of this class
 *  above it. So the arms and legs of a `diver_1` are one instance of `diver_*`, and a `wheel_*` below a `car_*` is a
 *  wheel. */
class Instances {
public:
    /** @param objects one lineage for each object of the scene, in the order of its geometry */
    Instances(const Classes& classes, const std::vector<Lineage>& objects);

    size_t objectCount() const { return instances_.size(); }
    /** Returns the first object of the instance that an object is part of. */
    int32_t of(int32_t object) const { return instances_[static_cast<size_t>(object)].first; }
    /** Takes an instance returned by of(). Returns its name; its class, 0 if none; the class of its shadow, 0 if
     *  none. */
    const std::string& name(int32_t instance) const { return instances_[static_cast<size_t>(instance)].name; }
    uint32_t category(int32_t instance) const { return instances_[static_cast<size_t>(instance)].category; }
    uint32_t shadow(int32_t instance) const { return instances_[static_cast<size_t>(instance)].shadow; }
    /** Returns all objects of an instance, in order. */
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
