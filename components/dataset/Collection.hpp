#pragma once
#include <functional>
#include <string>

#include "components/dataset/Classes.hpp"
#include "components/dataset/Store.hpp"
#include "components/dataset/Sweep.hpp"

namespace insonify::dataset {

/** The description of a data set. */
struct Title {
    std::string deployment, sweep;  ///< Names of files, without folders.
    std::string version;            ///< Version of the program.
    Format format = Format::Coco;
    bool tracks = false;  ///< Whether the poses of a sequence follow each other in time.
};

/** Writes the files that describe all samples, once every sample exists: lists and labels for training, a page of
 *  statistics, and last manifest.json, which lists every file with its SHA-256. The files are made from the samples'
 *  records alone, so any process that makes them gets the same bytes. */
class Collection {
public:
    Collection(Title title, uint64_t count, const Classes& classes, Store& store)
        : title_(std::move(title)), count_(count), classes_(classes), store_(store) {}

    /** Returns whether every sample exists. With `closely` all files of each sample are read as well. */
    bool isWhole(bool closely) const;
    /** Writes the files. Throws std::runtime_error if a record was deleted in the meantime. */
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
    Json files_ = Json::object();  ///< Files that do not belong to a single sample.
};

}  // namespace insonify::dataset
