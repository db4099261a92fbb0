#include "components/scene/Acoustics.hpp"

#include <cmath>
#include <iterator>

namespace insonify::scene {
namespace {

// In the order of the enums.
constexpr double kSedimentLambertDb[] = {-5.0,  -3.7,  -8.1,  -11.7, -14.2, -16.7, -19.3, -20.0,
                                         -20.0, -20.2, -20.4, -23.7, -23.7, -23.7, -23.7, -27.0};
constexpr double kReflection[] = {0.936, 0.936, 0.835, 0.91, 0.93, 0.81,  0.81,  0.69, 0.65,  0.40, 0.355,
                                  0.06,  0.37,  0.35,  0.21, 0.15, -0.02, -0.07, -0.5, -0.94, 0.39, -0.9995};
static_assert(std::size(kSedimentLambertDb) == std::size(types::EnumNames<Sediment>::names));
static_assert(std::size(kReflection) == std::size(types::EnumNames<Matter>::names));

}  // namespace

double lambertDb(Sediment sediment) { return kSedimentLambertDb[static_cast<size_t>(sediment)]; }

double reflection(Matter matter) { return kReflection[static_cast<size_t>(matter)]; }

double lambertDb(Matter matter) { return -9.23 + 20 * std::log10(std::abs(reflection(matter))); }

void Acoustics::applyTo(types::Material& target) const {
    if (sediment) target.lambert_db = static_cast<float>(lambertDb(*sediment));
    if (material) {
        target.lambert_db = static_cast<float>(lambertDb(*material));
        target.reflection = static_cast<float>(scene::reflection(*material));
    }
    if (lambert_db) target.lambert_db = static_cast<float>(*lambert_db);
    if (reflection) target.reflection = static_cast<float>(*reflection);
    if (roughness_slope) target.roughness_slope = static_cast<float>(*roughness_slope);
    if (reflectivity) target.reflectivity = static_cast<float>(*reflectivity);
    target.has_acoustics = true;
}

void Acoustics::check(types::Problems& problems) const {
    if (sediment && material) problems.push_back({"material", "stands beside `sediment`; give one of the two"});
}

}  // namespace insonify::scene
