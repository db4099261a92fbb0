#pragma once
#include "components/dataset/Samples.hpp"

namespace insonify::dataset {

/** Puts the objects of one sample where nothing else stands, group by group, by random words that are asked for by
 *  number. An object that finds no room in 1000 tries is an error that says how many did. */
class Placement {
public:
    /** @param pose number of the pose, which the words belong to */
    Placement(const Sweep& sweep, const SceneParts& scene, uint64_t pose, const types::Pose& vehicle);

    /** Adds a group. Throws types::ConfigError. */
    void add(size_t group, const std::vector<std::string>& names);
    const std::vector<PlacedObject>& objects() const { return objects_; }

private:
    /** Upright, on the ground of the world. */
    struct Circle {
        double x, y, radius;
    };
    /** Chooses at random, each equally likely. Takes words from `last_word` downwards. */
    std::vector<bool> chosen(size_t count, size_t wanted, uint64_t last_word) const;
    std::optional<PlacedObject> tryOnce(const ObjectGroup& group, const std::string& name, uint64_t word);
    glm::dquat turnOf(const ObjectGroup& group, uint64_t word) const;
    bool isFree(const ObjectGroup& group, const Circle& circle) const;
    /** A random number between two by its number in this sample; the first where they are the same. */
    double between(const std::vector<double>& span, uint64_t word) const;
    std::optional<double> heightOf(const ObjectGroup& group, const Placeable& object, const Circle& at,
                                   uint64_t word) const;

    const Sweep& sweep_;
    const SceneParts& scene_;
    const uint64_t pose_;
    const types::Pose& vehicle_;
    std::vector<Circle> taken_;
    std::vector<PlacedObject> objects_;
};

/** The highest of the triangles above or below a place of the world; none where there is none. */
std::optional<double> highestAt(const std::vector<std::array<glm::dvec3, 3>>& triangles, double x, double y);

}  // namespace insonify::dataset
