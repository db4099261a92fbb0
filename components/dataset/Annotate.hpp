#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "components/dataset/Classes.hpp"
#include "components/output/pictures/PlainPicture.hpp"
#include "types/samples/Sonar.hpp"
#include "types/samples/SonarTruth.hpp"

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

/** A box of pixels that begins at (x, y), from the upper left corner. */
struct Box {
    int x = 0, y = 0, width = 0, height = 0;
    bool operator==(const Box&) const = default;
};

/** An instance that a picture shows, its shadow, or a ghost. */
struct Annotation {
    int32_t object = 0;          ///< Its first object, an index into the truth's list; -1 for a ghost.
    std::vector<int32_t> parts;  ///< All of its objects.
    std::string name;
    uint32_t category = 0;                    ///< From 1.
    bool is_shadow = false;                   ///< True for the object's shadow, false for its echo.
    Box box;                                  ///< Contains its pixels and the centre of each of its cells.
    uint32_t area = 0;                        ///< [px]
    uint32_t bins = 0;                        ///< Number of the ping's bins that it dominates.
    double energy = 0;                        ///< Sum of its share of the energy in these bins; linear.
    double range_min = 0, range_max = 0;      ///< [m]
    double bearing_min = 0, bearing_max = 0;  ///< [rad], positive to port; above pi across +-180 degrees.
    std::vector<uint32_t> runs;               ///< Numbers of pixels, column by column, alternately outside and inside.
};

/** The annotations of a picture, and the annotation of each pixel. */
struct Annotated {
    std::vector<Annotation> annotations;  ///< In order of the truth's objects.
    std::vector<uint16_t> labels;         ///< Per pixel, row by row: number of its annotation from 1; 0: none.
};

/** Marks the shadow of an instance in bins that have no shadow yet: bins with an echo of a surface `without` the
 *  instance, by no mirror, and without one `with` it. Both truths have the bins of one ping.
 *  @param hiders for each bin the instance that hides its surface; -1: none */
void addShadow(const types::SonarTruth& with, const types::SonarTruth& without, int32_t instance,
               std::span<int32_t> hiders);

/** Finds the instances in a picture, their shadows, and the ghosts if AnnotationConfig::ghosts is set.
 *
 *  A cell shows the instance whose object contributes the most energy to one of the cell's bins. The object's share of
 *  that bin must be at least `min_share`, it must have a class, and the cell's grey level must be at least `min_level`.
 *  A bin with most of its energy from mirrors belongs to no object: adjacent cells of such bins are a ghost.
 *  Annotations with fewer than `min_pixels` pixels are omitted.
 *  @param picture the picture that shows the ping
 *  @param ranges range of each beam of a range image, which has one bin per beam [m]
 *  @param hiders the instance whose shadow each bin is, by addShadow(); empty: no shadows
 *
 *  Throws std::runtime_error for a truth of another grid. */
Annotated annotate(const types::Sonar& ping, const types::SonarTruth& truth, const output::PlainPicture& picture,
                   const Classes& classes, const Instances& instances, const AnnotationConfig& config,
                   output::BinScale scale, std::span<const float> ranges = {}, std::span<const int32_t> hiders = {});

}  // namespace insonify::dataset
