// What is checked in an SDF file and its includes before libsdformat reads them.
#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "components/sdf/SdfFile.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::sdf {
namespace {

/** Max work for one file. One unit is the time that libsdformat takes for an element, about half a millisecond. It also
 *  compares the children of an element with each other, 2000 pairs per unit. Each include of a file counts. */
constexpr size_t max_sdf_work = 100'000;

/** Max depth of models that include each other. */
constexpr size_t max_sdf_depth = 50;

/** Counts the work of libsdformat for a file, and collects the uris of its includes and what it would cut without a
 *  word: of `<radius>0,5</radius>` it reads 0. */
class Work final : public tinyxml2::XMLVisitor {
public:
    explicit Work(const std::string& xml, std::string file) : file_(std::move(file)) {
        if (types::isUtf16(xml)) faults.push_back({"", types::utf16_refusal, file_, 0});
        tinyxml2::XMLDocument document(true, tinyxml2::COLLAPSE_WHITESPACE);  // as libsdformat reads it
        if (document.Parse(xml.data(), xml.size()) == tinyxml2::XML_SUCCESS) document.Accept(this);
    }
    size_t amount = 0;
    std::vector<std::string> included;
    types::Diagnostics faults;

private:
    /** Returns the names of the parts around an element, and its own: "model::link::visual.radius". */
    static std::string getPath(const tinyxml2::XMLElement& element) {
        std::string path;
        for (const auto* part = element.Parent()->ToElement(); part; part = part->Parent()->ToElement())
            if (const char* const name = part->Attribute("name"); name && std::string_view(part->Name()) != "world")
                path = name + (path.empty() ? "" : "::" + path);
        return (path.empty() ? "" : path + ".") + element.Name();
    }
    /** Checks the numbers of a pose or shape: libsdformat ends reading at the first that is none. */
    void checkNumbers(const tinyxml2::XMLElement& element) {
        static const std::set<std::string_view> names = {"pose", "size",     "scale",  "radius",      "length",
                                                         "pos",  "sampling", "normal", "model_count", "radii",
                                                         "rows", "cols",     "step",   "point",       "height"};
        constexpr size_t max_reports = 20;
        if (!names.contains(element.Name()) || !element.GetText() || faults.size() == max_reports) return;
        std::istringstream words(element.GetText());
        for (std::string word; words >> word;) {
            if (std::string_view(element.Name()) == "pose" && word.ends_with(',')) word.pop_back();  // is read right
            if (!std::isnan(toNumber(word))) continue;
            faults.push_back({getPath(element),
                              fmt::format("is \"{}\": {} is no finite number; must be numbers such as 0.5, divided by "
                                          "blanks",
                                          element.GetText(), word),
                              file_, element.GetLineNum()});
            return;
        }
    }
    bool VisitEnter(const tinyxml2::XMLElement& element, const tinyxml2::XMLAttribute* /*first*/) override {
        size_t parts = 0;
        for (const auto* part = element.FirstChildElement(); part; part = part->NextSiblingElement()) ++parts;
        for (const auto* attribute = element.FirstAttribute(); attribute; attribute = attribute->Next()) ++parts;
        amount += 1 + parts * parts / 2000;
        const tinyxml2::XMLElement* uri = element.FirstChildElement("uri");
        if (std::string_view(element.Name()) == "include" && uri && uri->GetText()) included.push_back(uri->GetText());
        const std::string_view name = element.Name();  // a texture's <normal> is a file
        if (within_ || isNeedless(name) || name == "texture" || name.find(':') != name.npos)
            ++within_;
        else
            checkNumbers(element);
        return true;
    }
    bool VisitExit(const tinyxml2::XMLElement& /*element*/) override {
        within_ -= within_ ? 1 : 0;
        return true;
    }

    const std::string file_;
    size_t within_ = 0;  ///< Elements that are open from the outermost needless one.
};

class Includes {
public:
    explicit Includes(const meshes::ModelPaths& paths) : paths_(paths) {}

    /** Returns the work for a file and all its includes. */
    size_t measureWork(const std::filesystem::path& file) {
        if (const auto known = work_.find(file); known != work_.end()) return known->second;
        if (open_.size() == max_sdf_depth)
            throw types::ConfigError(
                file.string(), "include",
                fmt::format("models include each other {} deep; may be up to {}", max_sdf_depth + 1, max_sdf_depth));
        open_.push_back(file);
        Work own(toText(file), file.string());
        if (!own.faults.empty() && open_.size() == 1) throw types::ConfigError(std::move(own.faults));
        if (!own.faults.empty()) faults.push_back(std::move(own.faults.front()));
        size_t amount = own.amount;
        for (const std::string& uri : own.included)
            if (amount <= max_sdf_work) amount += workOfInclude(uri, file);
        open_.pop_back();
        return work_[file] = amount;
    }

    types::Diagnostics faults;  ///< The first of each included file.

private:
    size_t workOfInclude(const std::string& uri, const std::filesystem::path& from) {
        const auto found = paths_.find(uri, from);
        size_t maximum = 0;  // only one of a model's versions is read
        for (const std::filesystem::path& included : found ? getFiles(*found) : std::vector<std::filesystem::path>()) {
            if (std::ranges::count(open_, included) > 0)
                throw types::ConfigError(
                    from.string(), "include",
                    fmt::format("{} comes back to {}; a model may not include itself", uri, included.string()));
            maximum = std::max(maximum, measureWork(included));
        }
        return maximum;
    }

    static std::vector<std::filesystem::path> getFiles(const std::filesystem::path& found) {
        if (std::filesystem::is_regular_file(found)) return {std::filesystem::canonical(found)};
        std::vector<std::filesystem::path> files;
        if (std::filesystem::is_directory(found))
            for (const auto& entry : std::filesystem::directory_iterator(found))
                if (entry.path().extension() == ".sdf") files.push_back(std::filesystem::canonical(entry.path()));
        return files;
    }

    const meshes::ModelPaths& paths_;
    std::vector<std::filesystem::path> open_;
    std::map<std::filesystem::path, size_t> work_;
};

}  // namespace

bool isNeedless(std::string_view element) {
    static const std::set<std::string_view> names = {"inertial", "sensor",       "plugin",     "collision",
                                                     "physics",  "gui",          "gripper",    "battery",
                                                     "surface",  "audio_source", "audio_sink", "spherical_coordinates",
                                                     "wind",     "light"};
    return names.contains(element);
}

types::Diagnostics checkIncludes(const std::filesystem::path& file, const meshes::ModelPaths& paths) {
    Includes includes(paths);
    if (includes.measureWork(std::filesystem::canonical(file)) <= max_sdf_work) return includes.faults;
    throw types::ConfigError(file.string(), "",
                             "would take minutes to read: with what it includes it may hold up to 100000 elements, or "
                             "14000 in one; divide it, or make one mesh of many shapes");
}

}  // namespace insonify::sdf
