#pragma once
// What the elements of an array heard of a ping: insonify_msgs, messages of our own.
#include <vector>

#include "components/ros/GeometryMessages.hpp"

namespace insonify::ros {

/** Complex baseband of a straight array: sample i of element m stands at [m * sample_count + i]. */
struct SonarElements {
    static constexpr const char* type_name = "insonify_msgs/msg/SonarElements";
    static constexpr const char* type_hash = "RIHS01_4eccd6f1ed32d36fa56a2a55210b36158a616926e5e197ef069d433b385c33c7";
    Header header;
    double sound_speed = 0;
    double wavelength = 0;
    double first_range = 0;
    double sample_spacing = 0;
    uint32_t sample_count = 0;
    std::vector<double> positions;
    std::vector<double> weights;
    std::vector<float> in_phase;
    std::vector<float> quadrature;

    friend bool operator==(const SonarElements&, const SonarElements&) = default;
    template <class Self, class V>
    static void describe(Self& self, V& visit) {
        visit(Field{"header"}, self.header);
        visit(Field{"sound_speed", "m/s"}, self.sound_speed);
        visit(Field{"wavelength", "m"}, self.wavelength);
        visit(Field{"first_range", "m", "of the first sample"}, self.first_range);
        visit(Field{"sample_spacing", "m"}, self.sample_spacing);
        visit(Field{"sample_count", "1", "of each element"}, self.sample_count);
        visit(Field{"positions", "m", "of each element, positive to port"}, self.positions);
        visit(Field{"weights", "1", "of each element"}, self.weights);
        visit(Field{"in_phase", "1/m"}, self.in_phase);
        visit(Field{"quadrature", "1/m"}, self.quadrature);
    }
};

}  // namespace insonify::ros
