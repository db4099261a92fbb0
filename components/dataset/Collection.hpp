#pragma once
#include <functional>
#include <string>

#include "components/dataset/Classes.hpp"
#include "components/dataset/Store.hpp"
#include "components/dataset/Sweep.hpp"

namespace insonify::dataset {

/** What a data set says of itself. */
struct Title {
    std::string deployment, sweep;  ///< Names of files, without folders.
    std::string version;            ///< Of the program.
    Format format = Format::Coco;
    bool tracks = false;  ///< Whether the poses of a sequence follow each other in time.
};

/** Makes, once all samples are there, what is of all of them: lists and labels for what learns from them, a page of
 *  statistics, and manifest.json last, which names every file with its SHA-256. All of it is made of the records of the
 *  samples alone, so that it is the same whoever makes it. */
class Collection {
public:
    Collection(Title title, uint64_t count, const Classes& classes, Store& store)
        : title_(std::move(title)), count_(count), classes_(classes), store_(store) {}

    /** Whether every sample is there; with `closely` each file of each is read as well. */
    bool isWhole(bool closely) const;
    /** Writes it all. Throws std::runtime_error where a record is gone meanwhile. */
    void write();

private:
    void forEach(const std::function<void(const Json&)>& visit) const;
    void forEachOf(Part part, const std::function<void(const Json&)>& visit) const;
    uint64_t countOf(Part part) const;
    void add(const std::string& name, const std::function<void(std::ostream&)>& writer);
    void writeCoco(Part part);
    void writeCocoAnnotations(Part part, std::ostream& out) const;
    void writeYolo();
    void writeTracks();
    void writeManifest();

    const Title title_;
    const uint64_t count_;
    const Classes& classes_;
    Store& store_;
    Json files_ = Json::object();  ///< Those that are of no single sample.
};

}  // namespace insonify::dataset
