#include "components/sdf/SdfFile.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml2.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <regex>
#include <sdf/Error.hh>
#include <sdf/Exception.hh>
#include <sdf/ParserConfig.hh>
#include <sdf/World.hh>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "components/scene/Scene.hpp"
#include "types/text/ConfigError.hpp"

namespace insonify::sdf {
namespace {

/** Max size of a file [bytes]. */
constexpr size_t max_sdf_bytes = size_t{64} << 20;

/** Models that libsdformat refuses, written anew without what it refuses, in folders of their own. */
class MendedModels {
public:
    MendedModels() = default;
    ~MendedModels() {
        std::error_code error;
        if (!folder_.empty()) std::filesystem::remove_all(folder_, error);
    }
    MendedModels(const MendedModels&) = delete;
    MendedModels& operator=(const MendedModels&) = delete;

    /** Mends a file once. Returns whether it was mended. */
    bool mend(const std::filesystem::path& file) {
        if (folders_.contains(file) || !std::filesystem::is_regular_file(file)) return false;
        const std::string text = mended(toText(file), file.parent_path());
        if (text.empty()) return false;
        if (folder_.empty()) {
            std::string name = (std::filesystem::temp_directory_path() / "insonify_sdf_XXXXXX").string();
            if (!mkdtemp(name.data())) return false;
            folder_ = name;
        }
        const std::filesystem::path own = folder_ / std::to_string(folders_.size());
        std::error_code error;
        std::filesystem::create_directory(own, error);
        std::filesystem::copy_file(file.parent_path() / "model.config", own / "model.config", error);
        std::ofstream(own / file.filename(), std::ios::binary) << text;
        folders_[file] = own;
        return true;
    }
    /** Returns the mended form of a model's folder or file; the same where it was not mended. */
    std::filesystem::path putInPlace(const std::filesystem::path& found) const {
        for (const auto& [file, own] : folders_)
            if (file.parent_path() == found)
                return own;
            else if (file == found)
                return own / file.filename();
        return found;
    }
    bool empty() const { return folders_.empty(); }
    /** Returns the file of the user that was mended as this one; empty: none. */
    std::filesystem::path origin(const std::filesystem::path& written) const {
        for (const auto& [file, own] : folders_)
            if (own / file.filename() == written) return file;
        return {};
    }

    /** Returns an SDF text without what a sonar does not need and libsdformat may refuse; empty if it is no XML. */
    static std::string mended(std::string text, const std::filesystem::path& folder);

private:
    std::filesystem::path folder_;
    std::map<std::filesystem::path, std::filesystem::path> folders_;  ///< Of each mended file.
};

/** Quotes attributes, as older parsers read them: `<visual name=blade>`. */
std::string withQuotes(const std::string& text) {
    static const std::regex bare(R"(([A-Za-z_:]+)=([^\s"'<>/=]+)(?=[\s/>]))");
    std::string out;
    for (size_t at = 0; at < text.size();) {
        const size_t begin = std::min(text.find('<', at), text.size());
        const size_t end = std::min(text.find('>', begin), text.size());
        out.append(text, at, begin - at);
        const std::string tag = text.substr(begin, end - begin + (end < text.size()));
        out +=
            tag.size() < 4096 && tag.find('=') != std::string::npos ? std::regex_replace(tag, bare, "$1=\"$2\"") : tag;
        at = begin + tag.size();
        if (tag.empty()) break;
    }
    return out;
}

/** Removes elements that say nothing of shapes, pads poses to six numbers, and makes relative files absolute. */
void clean(tinyxml2::XMLElement& element, const std::filesystem::path& folder) {
    for (tinyxml2::XMLElement* child = element.FirstChildElement(); child;) {
        tinyxml2::XMLElement* const next = child->NextSiblingElement();
        const std::string_view name = child->Name();
        const char* const words = child->GetText();
        if (isNeedless(name)) {
            element.DeleteChild(child);
        } else if (name == "pose" && words) {
            std::istringstream numbers(words);
            std::string padded;
            size_t count = 0;
            for (std::string number; numbers >> number; ++count) padded += number + " ";
            for (; count > 0 && count < 6; ++count) padded += "0 ";
            child->SetText(padded.c_str());
        } else if (name == "uri" && words && std::string_view(words).find("://") == std::string_view::npos &&
                   std::filesystem::exists(folder / words)) {
            child->SetText(("file://" + std::filesystem::absolute(folder / words).string()).c_str());
        } else {
            clean(*child, folder);
        }
        child = next;
    }
}

std::string MendedModels::mended(std::string text, const std::filesystem::path& folder) {
    if (const size_t declared = text.find("<?xml"); declared != std::string::npos && declared > 0)
        text.erase(declared, std::min(text.find("?>", declared), text.size() - 2) + 2 - declared);
    tinyxml2::XMLDocument document;
    if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
        text = withQuotes(text);
        if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) return "";
    }
    tinyxml2::XMLElement* const root = document.RootElement();
    if (!root) return "";
    if (std::string_view(root->Name()) == "gazebo" && root->Attribute("version")) root->SetName("sdf");
    clean(*root, folder);
    tinyxml2::XMLPrinter printer;
    document.Print(&printer);
    return printer.CStr();
}

/** Installs the file search in libsdformat's global configuration, the only one that nested includes use. */
class SearchConfig {
public:
    SearchConfig(const std::filesystem::path& world, const meshes::ModelPaths& paths,
                 const std::set<std::string>& unreadable, const MendedModels& mended)
        : before_(global()) {
        if (unreadable.empty() && mended.empty())  // these precede libsdformat's own search, the callback follows it
            for (const std::filesystem::path& folder : paths.folders()) global().AddURIPath("model://", folder);
        global().SetFindCallback([&](const std::string& uri) -> std::string {
            const auto found = paths.find(uri, world);
            const auto isIt = [&](const std::filesystem::path& file) {
                return file == *found || file.parent_path() == *found;
            };
            if (!found || std::ranges::any_of(unreadable, isIt)) return "";
            return mended.putInPlace(*found).string();
        });
    }
    ~SearchConfig() { global() = before_; }
    SearchConfig(const SearchConfig&) = delete;
    SearchConfig& operator=(const SearchConfig&) = delete;

private:
    static ::sdf::ParserConfig& global() { return ::sdf::ParserConfig::GlobalConfig(); }
    ::sdf::ParserConfig before_;
};

/** Returns the text in one line, with one space between words. */
std::string joined(const std::string& text) {
    std::istringstream words(text);
    std::string line;
    for (std::string word; words >> word;) line += (line.empty() ? "" : " ") + word;
    return line;
}

/** Loads `file`, or `text` instead if it is not empty. Returns the reason of a failure, empty if there is none.
 *  Libsdformat may throw objects that are not a std::exception, and more than it documents. */
std::string load(::sdf::Root& root, const std::filesystem::path& file, const std::string& text, ::sdf::Errors& errors) {
    const ::sdf::ParserConfig& config = ::sdf::ParserConfig::GlobalConfig();
    try {
        errors = text.empty() ? root.Load(file.string(), config) : root.LoadSdfString(text, config);
        return "";
    } catch (const ::sdf::Exception& failure) {
        return joined(failure.GetErrorStr());
    } catch (const std::exception& failure) {
        return types::getReason(failure);
    } catch (...) {
        return "no reason is given";
    }
}

/** Returns the text with "__" for each "::"; empty if it has none. */
std::string withoutColons(std::string text) {
    size_t at = text.find("::");
    if (at == std::string::npos) return "";
    for (; at != std::string::npos; at = text.find("::", at)) text.replace(at, 2, "__");
    return text;
}

/** Rewrites "Error parsing XML in file [...]: Error=XML_ERROR_PARSING_TEXT ... XMLElement name=pose" in plain words. */
std::string plain(const std::string& message) {
    if (!message.starts_with("Error parsing XML")) return message;
    const auto wordAfter = [&message](const std::string& key) {
        const size_t at = message.find(key);
        if (at == std::string::npos) return std::string();
        return message.substr(at + key.size(), message.find_first_of(" \n", at + key.size()) - at - key.size());
    };
    const std::string error = wordAfter("Error=XML_ERROR_"), element = wordAfter("XMLElement name=");
    std::string what = "something in it is neither an element nor text";
    if (error == "EMPTY_DOCUMENT") what = "it is empty";
    if (error == "MISMATCHED_ELEMENT") what = "an element is not closed, or by another's tag";
    if (error == "PARSING_ELEMENT") what = "a tag is not finished";
    if (error == "PARSING_ATTRIBUTE") what = "an attribute is not of the form name=\"value\"";
    if (error == "PARSING_TEXT") what = "a text is not followed by a tag";
    if (error == "PARSING_COMMENT") what = "a comment is not closed";
    if (error == "ELEMENT_DEPTH_EXCEEDED") what = "its elements are nested too deep";
    return "is no XML: " + what + (element.empty() ? "" : " (<" + element + ">)");
}

std::string withoutColours(std::string line) {
    for (size_t begin = 0; (begin = line.find('\033')) != std::string::npos;)
        line.erase(begin, line.find('m', begin) - begin + 1);
    return line;
}

/** Parses "Error Code 13: [/sdf/world[...]/uri:a.world:L43]: Msg: Unable to..." or "Error [Param.cc:598]  The
 *  value...". For other lines, warnings among them, the message is empty. */
types::Diagnostic readLine(const std::string& line) {
    types::Diagnostic diagnostic;
    const auto after = [&line](size_t at) {
        return line.substr(std::min(line.find_first_not_of(' ', at), line.size()));
    };
    if (const size_t message = line.find("Msg: "); line.starts_with("Error Code") && message != std::string::npos) {
        diagnostic.message = after(message + 5);
        const size_t begin = line.find('['), number = line.rfind(":L", message), file = line.rfind(':', number - 1);
        if (begin > file || number == std::string::npos) return diagnostic;
        diagnostic.path = line.substr(begin + 1, file - begin - 1);
        diagnostic.file = line.substr(file + 1, number - file - 1);
        diagnostic.line = std::atoi(line.c_str() + number + 2);
    } else if (const size_t end = line.find("] "); line.starts_with("Error [") && end != std::string::npos) {
        diagnostic.message = after(end + 2);
        if (const size_t number = line.find("Line number="); number != std::string::npos)
            diagnostic.line = std::atoi(line.c_str() + number + 12);
    }
    return diagnostic;
}

/** Returns a message without the file's text, which libsdformat repeats whole, and which may be binary. */
std::string shortened(const std::string& message) {
    constexpr size_t longest = 400;
    const auto isText = [](unsigned char c) { return c >= ' ' || c == '\n' || c == '\t'; };
    const auto end = std::ranges::find_if_not(message, isText);
    const auto kept = std::min<size_t>(static_cast<size_t>(end - message.begin()), longest);
    return kept == message.size() ? message : message.substr(0, kept) + "...";
}

/** Adds a diagnostic unless it repeats a known diagnostic or is that of an enclosing element. */
void add(types::Diagnostic diagnostic, types::Diagnostics& diagnostics) {
    diagnostic.message = shortened(plain(diagnostic.message));
    const auto says = [&diagnostic](const char* text) { return diagnostic.message.starts_with(text); };
    const auto includes = [&](const types::Diagnostic& known) {
        const bool is_same_place =
            !diagnostic.path.empty() && known.path == diagnostic.path && known.line == diagnostic.line;
        return known.text() == diagnostic.text() || is_same_place ||
               (says("Error reading element") && known.path.starts_with(diagnostic.path));
    };
    if (says("Unable to read file:") || says("Failed to load a world")) return;
    if (!diagnostic.message.empty() && std::ranges::none_of(diagnostics, includes)) diagnostics.push_back(diagnostic);
}

/** Adds the diagnostics that libsdformat printed and those that it returned. */
void add(const std::string& console, const ::sdf::Errors& errors, types::Diagnostics& diagnostics) {
    std::istringstream lines(console);
    for (std::string line; std::getline(lines, line);) add(readLine(withoutColours(line)), diagnostics);
    for (const ::sdf::Error& error : errors)
        add({error.XmlPath().value_or(""), error.Message(), error.FilePath().value_or(""),
             error.LineNumber().value_or(0)},
            diagnostics);
}

/** Adds the files named in "Unable to read file[/models/vase/model.sdf]". */
void findUnreadable(const types::Diagnostics& diagnostics, std::set<std::string>& unreadable) {
    constexpr std::string_view text = "Unable to read file[";
    for (const types::Diagnostic& diagnostic : diagnostics)
        if (diagnostic.message.starts_with(text))
            unreadable.insert(diagnostic.message.substr(text.size(), diagnostic.message.rfind(']') - text.size()));
}

/** Returns the first diagnostic in a file, or at all, with the first of those without a place, which give the reason.
 */
std::string reasonIn(const types::Diagnostics& diagnostics, const std::string& file) {
    const auto first = [&](const auto& is) {
        const auto found = std::ranges::find_if(diagnostics, is);
        return found == diagnostics.end() ? nullptr : &*found;
    };
    const types::Diagnostic* place = first([&](const types::Diagnostic& each) { return each.file == file; });
    const types::Diagnostic* reason = first([](const types::Diagnostic& each) { return each.file.empty(); });
    std::string text = place && place->line > 0 ? fmt::format("line {}: {}", place->line, place->message)
                       : place                  ? place->message
                                                : "";
    if (reason) text += (text.empty() ? "" : ": ") + reason->message;
    return text.empty() ? "libsdformat refuses it" : text;
}

/** Returns the URI that a diagnostic reports as missing; empty: none. */
std::string missingIn(const types::Diagnostic& diagnostic) {
    constexpr std::string_view not_found = "Unable to find uri[";
    const size_t at = diagnostic.message.find(not_found);
    if (at == std::string::npos) return "";
    const size_t begin = at + not_found.size();
    return diagnostic.message.substr(begin, diagnostic.message.find(']', begin) - begin);
}

/** Joins diagnostics without a place, which give the reason, to the first with a place, and throws them. */
[[noreturn]] void refuse(const std::filesystem::path& file, const meshes::ModelPaths& paths,
                         types::Diagnostics diagnostics) {
    for (types::Diagnostic& diagnostic : diagnostics)
        if (const std::string uri = missingIn(diagnostic); !uri.empty())
            diagnostic.message += "; " + paths.searched(uri);
    if (diagnostics.empty()) diagnostics.push_back({"", "holds neither a world nor a model of SDF"});
    const auto placed =
        std::ranges::stable_partition(diagnostics, [](const auto& diagnostic) { return !diagnostic.file.empty(); });
    std::string reasons;
    for (const types::Diagnostic& diagnostic : placed) reasons += (reasons.empty() ? "" : "; ") + diagnostic.message;
    const int line = placed.empty() ? 0 : placed.front().line;
    diagnostics.erase(placed.begin(), placed.end());
    if (diagnostics.empty())
        diagnostics.push_back({"", reasons, file.string(), line});
    else if (!reasons.empty())
        diagnostics.front().message += ": " + reasons;
    throw types::ConfigError(std::move(diagnostics));
}

/** What is tried in turn until libsdformat reads a file. */
struct Reading {
    Reading(const std::filesystem::path& file, meshes::WorldBuilder& builder, const std::string& given)
        : text(given), file_(file), builder_(builder), given_(given) {}

    /** Mends the models that libsdformat refused, or omits those that cannot be mended. Returns whether the next
     * reading differs. */
    bool replaces(const types::Diagnostics& diagnostics) {
        std::set<std::string> refused;
        findUnreadable(diagnostics, refused);
        bool is_new = false;
        for (const std::string& model : refused) {
            const std::string origin = models.origin(model).string();  // of a model that was mended in vain
            if (origin.empty() && models.mend(model)) {
                mended_[model] = diagnostics;
                is_new = true;
            } else if (unreadable.insert(origin.empty() ? model : origin).second) {
                lost = origin.empty() ? diagnostics : mended_.at(origin);
                mended_.erase(origin);
                is_new = true;
            }
        }
        return is_new;
    }
    /** Mends the file itself, then also its names. Throws types::ConfigError with the diagnostics of the file as it is
     *  where nothing is left to try. */
    void mend(const types::Diagnostics& diagnostics) {
        if (form_ == AsGiven) {
            first_ = diagnostics;
            if (given_.empty()) given_ = toText(file_);
        }
        const auto folder = std::filesystem::absolute(file_).parent_path();
        for (text.clear(); text.empty();) {
            form_ = static_cast<Form>(form_ + 1);
            if (form_ == Mended) text = MendedModels::mended(given_, folder);
            if (form_ == Renamed) text = MendedModels::mended(withoutColons(given_), folder);
            if (form_ == Refused) refuse(file_, builder_.paths(), first_);
        }
    }
    /** Notes what was tried with success. */
    void note() const {
        for (const auto& [model, diagnostics] : mended_)
            builder_.notice(
                fmt::format("{} is read without what a sonar does not need: {}", model, reasonIn(diagnostics, model)));
        if (form_ > AsGiven)
            builder_.notice("read without what a sonar does not need: " + reasonIn(first_, file_.string()));
        if (form_ == Renamed) builder_.notice("names are read with \"__\" for \"::\", which libsdformat refuses");
    }

    std::string text;                  ///< To be read; empty: the file.
    std::set<std::string> unreadable;  ///< Files that are omitted.
    types::Diagnostics lost;           ///< Of these files.
    MendedModels models;

private:
    enum Form { AsGiven, Mended, Renamed, Refused } form_ = AsGiven;
    std::filesystem::path file_;
    meshes::WorldBuilder& builder_;
    std::string given_;
    types::Diagnostics first_;                          ///< Of the file as it is.
    std::map<std::string, types::Diagnostics> mended_;  ///< Of each model that is mended, as it was.
};

/** Adds the diagnostics of a world that was read nevertheless; missing models of Fuel are one notice. Gazebo's
 *  `model://sun` is a light and does not matter to a sonar. */
void noteDiagnostics(const types::Diagnostics& diagnostics, meshes::WorldBuilder& builder) {
    std::set<std::string> of_fuel;
    for (const types::Diagnostic& diagnostic : diagnostics) {
        const std::string uri = missingIn(diagnostic);
        if (uri == "model://sun") continue;
        if (!uri.empty()) builder.missed(uri);
        if (uri.starts_with("http"))
            of_fuel.insert(uri);
        else
            builder.notice(diagnostic.text() + (diagnostic.path.ends_with("/uri") ? "; omitted" : ""));
    }
    if (!of_fuel.empty())
        builder.notice(fmt::format("{} of Fuel {} not found, and omitted: {}",
                                   of_fuel.size() == 1 ? "1 model" : fmt::format("{} models", of_fuel.size()),
                                   of_fuel.size() == 1 ? "is" : "are", fmt::join(of_fuel, ", ")));
}

}  // namespace

double toNumber(std::string_view word) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    double number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    return error == std::errc() && end == word.data() + word.size() && std::isfinite(number) ? number : std::nan("");
}

std::string toText(const std::filesystem::path& file) {
    std::error_code error;
    if (std::filesystem::file_size(file, error) > max_sdf_bytes && !error)
        throw types::ConfigError(file.string(), "",
                                 fmt::format("is larger than {} MB; divide it", max_sdf_bytes >> 20));
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::mutex CerrCapture::mutex_;

CerrCapture::CerrCapture() : lock_(mutex_), before_(std::cerr.rdbuf(text_.rdbuf())) {}
CerrCapture::~CerrCapture() { std::cerr.rdbuf(before_); }

std::string CerrCapture::take() {
    const std::string text = text_.str();
    text_.str("");
    return text;
}

::sdf::Root readSdfFile(const std::filesystem::path& file, meshes::WorldBuilder& builder, CerrCapture& console,
                        const std::string& text) {
    if (!std::filesystem::is_regular_file(file))
        throw types::ConfigError(file.string(), "",
                                 "is not a file; give the path of a " + scene::sceneEndings("sdf") + " file");
    Reading reading(file, builder, text);
    for (const types::Diagnostic& fault : checkIncludes(file, builder.paths()))
        builder.notice(fault.text() + "; of such a model the number is cut there, or the model is omitted");
    while (true) {
        const SearchConfig search(file, builder.paths(), reading.unreadable, reading.models);
        ::sdf::Root root;
        ::sdf::Errors errors;
        types::Diagnostics diagnostics = reading.lost;
        const std::string failure = load(root, file, reading.text, errors);
        if (!failure.empty()) add({"", "cannot be read as SDF: " + failure}, diagnostics);
        add(console.take(), errors, diagnostics);
        const bool is_read = failure.empty() && (root.WorldCount() > 0 || root.Model());
        if (reading.replaces(diagnostics)) continue;
        if (!is_read) {
            reading.mend(diagnostics);
            continue;
        }
        reading.note();
        noteDiagnostics(diagnostics, builder);
        return root;
    }
}

}  // namespace insonify::sdf
