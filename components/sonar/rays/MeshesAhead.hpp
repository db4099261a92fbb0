#pragma once
#include <memory>
#include <vector>

#include "components/sonar/base/MadeAhead.hpp"
#include "components/sonar/surfaces/MaterialLaws.hpp"
#include "types/geometry/Geometry.hpp"

namespace insonify::sonar {

/** Prepares the expensive data of meshes that a later ping will need, by MadeAhead. */
class MeshesAhead {
public:
    using Meshes = std::shared_ptr<const std::vector<types::MeshPtr>>;

    /** Sets the meshes that will be needed, with these laws; null: none. Does not wait. */
    void take(const Meshes& meshes, const MaterialLaws& laws);

private:
    Meshes taken_;  ///< Argument of the last take().
    MadeAhead ahead_{"meshes ahead"};
};

}  // namespace insonify::sonar
