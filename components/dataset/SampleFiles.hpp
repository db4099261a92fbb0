#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "components/dataset/Annotate.hpp"
#include "components/dataset/Samples.hpp"
#include "components/dataset/Store.hpp"
#include "types/samples/DepthMap.hpp"
#include "types/samples/Sonar.hpp"
#include "types/samples/SonarTruth.hpp"

namespace insonify::dataset {

/** The pings of one sample joined to one ping: the beams of the first ping, then those of the second, and so on. Time,
 *  bin duration and speed of sound are those of the first ping. */
class Run {
public:
    /** Adds a ping. Throws std::runtime_error if its beams or bins differ from those of the previous pings. */
    void add(const types::SonarPtr& ping, const types::SonarTruthPtr& truth);

    uint32_t size() const { return static_cast<uint32_t>(pings_.size()); }  ///< Number of pings.
    const std::vector<types::SonarPtr>& pings() const { return pings_; }
    const std::vector<types::SonarTruthPtr>& truths() const { return truths_; }
    const types::Sonar& ping() const { return size() == 1 ? *pings_[0] : ping_; }
    const types::SonarTruth& truth() const { return size() == 1 ? *truths_[0] : truth_; }

private:
    std::vector<types::SonarPtr> pings_;
    std::vector<types::SonarTruthPtr> truths_;
    types::Sonar ping_;  ///< All pings joined; empty for a single ping, as is the truth.
    types::SonarTruth truth_;
};

/** A sample with its pings and truth. */
struct Recorded {
    const Sample& sample;
    const Run& run;
    const Instances& instances;
    std::string scene;                                     ///< File name of the scene.
    std::vector<std::pair<std::string, Json>> settings{};  ///< "task.property", value.
    types::DepthMapPtr range_image{};                      ///< The range image of a 3-D sonar, else null.
    types::SonarTruthPtr range_truth{};                    ///< The truth of its cells, one bin per cell.
    std::vector<int32_t> hiders{};                         ///< As annotate() has them.
};

/** Writes the files of samples in one format, and their records. */
class SampleFiles {
public:
    SampleFiles(const Sweep& sweep, Format format, const Classes& classes, Store& store);
    /** Writes a sample. Throws std::runtime_error if a file cannot be written. */
    void write(const Recorded& recorded);

private:
    /** Renders the picture, and finds its annotations. */
    Annotated makeAnnotated(const Recorded& recorded);
    Json makeRecord(const Recorded& recorded, const Annotated& annotated) const;
    /** Writes the files. Returns their names and SHA-256 sums. */
    Json writeFiles(const std::string& stem, const Recorded& recorded, const Annotated& annotated, const Json& meta);
    std::string putPicture(const std::string& name, const types::Image& picture);

    const Sweep& sweep_;
    const Format format_;
    const Classes& classes_;
    Store& store_;
    output::PlainPicture picture_;
};

/** Returns whether a format has a picture per sample. */
inline bool hasPictures(Format format) { return format != Format::Npz && format != Format::Mcap; }

}  // namespace insonify::dataset
