#include "components/scene/SdfIncludes.hpp"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "types/ConfigError.hpp"

namespace insonify::scene {
namespace {

std::string textOf(const std::filesystem::path& file) {
    std::error_code error;
    if (std::filesystem::file_size(file, error) > max_sdf_bytes && !error)
        throw types::ConfigError(file.string(), "",
                                 fmt::format("is larger than {} MB; divide it", max_sdf_bytes >> 20));
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/** Counts what libsdformat will have to do with a file, and gathers the uris of its includes. */
class Work final : public tinyxml2::XMLVisitor {
public:
    explicit Work(const std::string& xml) {
        tinyxml2::XMLDocument document(true, tinyxml2::COLLAPSE_WHITESPACE);  // as libsdformat reads it
        if (document.Parse(xml.data(), xml.size()) == tinyxml2::XML_SUCCESS) document.Accept(this);
    }
    size_t amount = 0;
    std::vector<std::string> included;

private:
    bool VisitEnter(const tinyxml2::XMLElement& element, const tinyxml2::XMLAttribute* /*first*/) override {
        size_t parts = 0;
        for (const auto* part = element.FirstChildElement(); part; part = part->NextSiblingElement()) ++parts;
        for (const auto* attribute = element.FirstAttribute(); attribute; attribute = attribute->Next()) ++parts;
        amount += 1 + parts * parts / 2000;
        const tinyxml2::XMLElement* uri = element.FirstChildElement("uri");
        if (std::string_view(element.Name()) == "include" && uri && uri->GetText()) included.push_back(uri->GetText());
        return true;
    }
};

class Includes {
public:
    explicit Includes(const SdfPaths& paths) : paths_(paths) {}

    /** With a file and all that it includes. */
    size_t workOf(const std::filesystem::path& file) {
        if (const auto known = work_.find(file); known != work_.end()) return known->second;
        if (open_.size() == max_sdf_depth)
            throw types::ConfigError(
                file.string(), "include",
                fmt::format("models include each other {} deep; may be up to {}", max_sdf_depth + 1, max_sdf_depth));
        open_.push_back(file);
        const Work own(textOf(file));
        size_t amount = own.amount;
        for (const std::string& uri : own.included)
            if (amount <= max_sdf_work) amount += workOfInclude(uri, file);
        open_.pop_back();
        return work_[file] = amount;
    }

private:
    size_t workOfInclude(const std::string& uri, const std::filesystem::path& from) {
        const auto found = paths_.find(uri, from);
        size_t most = 0;  // of a model's versions one is read
        for (const std::filesystem::path& included : found ? filesOf(*found) : std::vector<std::filesystem::path>()) {
            if (std::ranges::count(open_, included) > 0)
                throw types::ConfigError(
                    from.string(), "include",
                    fmt::format("{} comes back to {}; a model may not include itself", uri, included.string()));
            most = std::max(most, workOf(included));
        }
        return most;
    }

    static std::vector<std::filesystem::path> filesOf(const std::filesystem::path& found) {
        if (std::filesystem::is_regular_file(found)) return {std::filesystem::canonical(found)};
        std::vector<std::filesystem::path> files;
        if (std::filesystem::is_directory(found))
            for (const auto& entry : std::filesystem::directory_iterator(found))
                if (entry.path().extension() == ".sdf") files.push_back(std::filesystem::canonical(entry.path()));
        return files;
    }

    const SdfPaths& paths_;
    std::vector<std::filesystem::path> open_;
    std::map<std::filesystem::path, size_t> work_;
};

}  // namespace

void checkIncludes(const std::filesystem::path& file, const SdfPaths& paths) {
    if (Includes(paths).workOf(std::filesystem::canonical(file)) <= max_sdf_work) return;
    throw types::ConfigError(file.string(), "",
                             "would take minutes to read: with what it includes it may hold up to 100000 elements, or "
                             "14000 in one; divide it, or make one mesh of many shapes");
}

}  // namespace insonify::scene
