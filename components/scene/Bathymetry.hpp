#pragma once
#include <optional>
#include <string>

#include "components/scene/Scene.hpp"
#include "components/scene/SceneConfig.hpp"
#include "components/scene/Survey.hpp"
#include "types/Geometry.hpp"

namespace insonify::scene {

/** The sea floor of a survey, of which as much is there as lies around the vehicle: an object "bathymetry" of that
 *  material, in the axes of the world, after those of the scene. */
class Bathymetry {
public:
    /** Throws types::ConfigError for whatever is wrong with the file, or when `reach` holds too many posts. */
    Bathymetry(const BathymetryConfig& config, const std::filesystem::path& file);

    /** `rest` and the floor about a place in the world: the one of the call before as long as that reaches far enough
     *  on all sides, else one of whole tiles. `rest` alone where the survey has nothing. Throws SurveyError where the
     *  file cannot be read on. */
    types::GeometryPtr about(const glm::dvec3& place, const types::GeometryPtr& rest);

    /** Begins anew: what is there next follows from the place alone. */
    void forget() { window_.reset(); }

    /** Gives a scene the material that the floor has there. Throws types::ConfigError for one that has an object of the
     *  floor's name. */
    static void addMaterial(Scene& scene);

private:
    PostWindow postsAbout(const glm::dvec3& place) const;
    PostWindow wholeTiles(const PostWindow& posts) const;
    PostWindow clipped(PostWindow posts) const;
    types::Mesh meshOf(const PostWindow& posts) const;

    BathymetryConfig config_;
    Survey survey_;
    glm::dvec2 zero_;  ///< Easting and northing of the world's zero [m].
    std::optional<PostWindow> window_;
    types::GeometryPtr geometry_, rest_;  ///< Of the window, and what it was made with.
};

}  // namespace insonify::scene
