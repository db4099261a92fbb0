#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "components/dataset/Samples.hpp"
#include "components/dataset/Store.hpp"
#include "components/dataset/Sweep.hpp"

namespace insonify::dataset {

/** The samples of one seed in a data set. */
struct Member {
    uint64_t seed = 1, total = 0;        ///< Seed of the sweep; number of the sweep's samples.
    std::optional<uint64_t> count = {};  ///< Number of samples that are drawn from these; none: all.
    std::string digest = {};             ///< Hash of everything that determines the samples.

    Selection selection() const { return count ? Selection(total, *count, seed) : Selection(total); }
};

/** The description of a data set, which is in its folder as dataset.json from the first sample on. */
struct Title {
    std::string version;            ///< Version of the program.
    std::string deployment, sweep;  ///< Names of files, without folders.
    std::string origin;             ///< Hash of everything that determines the samples, but for the seed and --count.
    Format format = Format::Coco;
    bool tracks = false;    ///< Whether the poses of a sequence follow each other in time.
    bool one_seed = false;  ///< Whether poses are the same for each seed, but their parts (train, val, test) are not.
    uint64_t scenes = 1;    ///< Number of the sweep's scenes.
    std::vector<std::string> classes;  ///< Names of the classes from 1 on.
    std::vector<Member> members;       ///< At least one; several in a joined set, by ascending seed.

    /** Reads the description of a folder. Throws types::ConfigError for a folder without one, a damaged one, and one of
     *  another version than `version`. */
    static Title read(const std::filesystem::path& folder, const std::string& version);
    std::string text() const;  ///< The bytes of dataset.json.
};

/** A data set in a folder. Once every sample exists, it writes the files that describe all: lists and labels for
 *  training, a page of statistics, and last manifest.json, which lists every file with its SHA-256. The files are made
 *  from the samples' records alone, so any process that makes them gets the same bytes. */
class Collection {
public:
    /** Throws types::ConfigError if the folder contains samples of another data set. */
    Collection(Title title, const std::filesystem::path& folder);

    const Title& title() const { return title_; }
    /** The samples of a member, in the order of Title::members. */
    Store& store(size_t member) { return stores_[member]; }
    const Selection& selection(size_t member) const { return selections_[member]; }
    /** Writes dataset.json. Call it before the first sample. */
    void describe();
    /** Returns whether every sample exists. With `closely` all files of each sample are read as well.
     *  @param known samples that are there, which are not read */
    bool isWhole(bool closely, const std::set<uint64_t>& known = {}) const;
    /** Writes the files of all samples. Throws std::runtime_error if a record was deleted in the meantime. */
    void write();

private:
    /** A sample in the order of the set. */
    struct Listed {
        uint64_t number;  ///< From 0; that of the sample in the sweep where the set is one whole sweep.
        size_t member;
        const Json& record;
        bool isInPart(Part part) const;
    };
    void forEach(const std::function<void(const Listed&)>& visit) const;
    void forEachIn(Part part, const std::function<void(const Listed&)>& visit) const;
    uint64_t countEach(Part part) const;
    void add(const std::string& name, const std::function<void(std::ostream&)>& writer);
    void writeCoco(Part part);
    void writeCocoAnnotations(Part part, std::ostream& out) const;
    void writeYolo();
    void writeTracks();
    void writeManifest();

    const Title title_;
    std::vector<Store> stores_;          ///< One for each member, in one folder.
    std::vector<Selection> selections_;  ///< The same.
    Json files_ = Json::object();        ///< Files that do not belong to a single sample.
};

/** Folders with parts of a data set: shards, or sets that differ in their seeds. */
class Parts {
public:
    /** Reads every sample. Throws types::ConfigError where the parts do not fit: a folder that is no data set, another
     *  deployment, sweep, format or version, a sample that is in two of them, in none, or damaged.
     *  @param version of this program */
    Parts(std::vector<std::filesystem::path> folders, const std::string& version);
    Parts(const Parts&) = delete;
    Parts& operator=(const Parts&) = delete;

    const Title& title() const { return title_; }
    /** Copies all samples to a set with this title. Throws std::runtime_error for a file that has changed. */
    void copyTo(Collection& set) const;

private:
    void add(const Title& other, size_t folder);
    void find();

    const std::vector<std::filesystem::path> folders_;
    std::vector<Title> titles_;  ///< One for each folder.
    Title title_;
    /** Folder of each sample, by its number, of each member. */
    std::vector<std::map<uint64_t, const std::filesystem::path*>> places_;
};

}  // namespace insonify::dataset
