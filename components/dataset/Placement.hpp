#pragma once
#include "components/dataset/Samples.hpp"

namespace insonify::dataset {

/** Places the objects of one sample clear of each other, group by group. Random words are indexed by number. An object
 *  that finds no free place in 1000 tries is an error, which reports the number of objects that did. */
class Placement {
public:
    /** @param pose number of the pose that selects the random words */
    Placement(const Sweep& sweep, const SceneParts& scene, uint64_t pose, const types::Pose& vehicle);

    /** Adds a group. Throws types::ConfigError. */
    void add(size_t group, const std::vector<std::string>& names);
    const std::vector<PlacedObject>& objects() const { return objects_; }

private:
    /** The base of an upright cylinder, in the world's horizontal plane [m]. */
    struct Circle {
        double x, y, radius;
    };
    /** Chooses at random with equal probability. Takes words from `last_word` downwards. */
    std::vector<bool> chosen(size_t count, size_t wanted, uint64_t last_word) const;
    std::optional<PlacedObject> tryOnce(const ObjectGroup& group, const std::string& name, uint64_t word);
    glm::dquat computeTurn(const ObjectGroup& group, uint64_t word) const;
    bool isFree(const ObjectGroup& group, const Circle& circle) const;
    /** Returns a random number in a span, by the word's number in this sample; the first value if both are the same. */
    double between(const std::vector<double>& span, uint64_t word) const;
    std::optional<double> height(const ObjectGroup& group, const Placeable& object, const Circle& at,
                                 uint64_t word) const;

    const Sweep& sweep_;
    const SceneParts& scene_;
    const uint64_t pose_;
    const types::Pose& vehicle_;
    std::vector<Circle> taken_;
    std::vector<PlacedObject> objects_;
    uint64_t groundless_ = 0;  ///< Tries for the present object at places without ground below.
};

/** Returns the height of the highest triangle above or below a place of the world; none if there is none. */
std::optional<double> highestAt(const std::vector<std::array<glm::dvec3, 3>>& triangles, double x, double y);

}  // namespace insonify::dataset
