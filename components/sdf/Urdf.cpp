// URDF, which libsdformat turns into SDF: what it would leave out without a word is checked or put right first.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <sstream>
#include <string_view>

#include "components/scene/Scene.hpp"
#include "components/sdf/Sdf.hpp"
#include "components/sdf/SdfFile.hpp"
#include "types/text/ConfigError.hpp"
#include "types/text/DidYouMean.hpp"

namespace insonify::sdf {
namespace {

using tinyxml2::XMLElement;

bool usesXacro(const XMLElement& element) {
    if (std::string_view(element.Name()).starts_with("xacro:")) return true;
    for (const XMLElement* part = element.FirstChildElement(); part; part = part->NextSiblingElement())
        if (usesXacro(*part)) return true;
    return false;
}

std::string getName(const XMLElement* element) {
    const char* const name = element ? element->Attribute("name") : nullptr;
    return name ? name : "";
}

/** Sets an inertia, without which libsdformat omits a link, and takes out what it may refuse and a sonar does not need.
 */
void setInertia(XMLElement& link) {
    for (const char* const needless : {"inertial", "collision"})
        while (XMLElement* const part = link.FirstChildElement(needless)) link.DeleteChild(part);
    XMLElement* const inertial = link.InsertNewChildElement("inertial");
    inertial->InsertNewChildElement("mass")->SetAttribute("value", 1);
    XMLElement* const inertia = inertial->InsertNewChildElement("inertia");
    for (const char* const moment : {"ixx", "iyy", "izz"}) inertia->SetAttribute(moment, 1);
    for (const char* const product : {"ixy", "ixz", "iyz"}) inertia->SetAttribute(product, 0);
}

/** Returns the name of a visual's material. libsdformat needs one. */
std::string nameMaterial(XMLElement& visual) {
    XMLElement* const material = visual.FirstChildElement("material");
    std::string name = getName(material);
    if (material && name.empty()) material->SetAttribute("name", fmt::format("line_{}", visual.GetLineNum()).c_str());
    return name;
}

/** Takes out what libsdformat may refuse and a sonar does not need: versions, second materials of a name, and how far
 * and along which axis joints move. A joint has a name of its own then, also among links. */
void simplify(XMLElement& robot) {
    robot.DeleteAttribute("version");
    std::set<std::string> names, materials;
    for (const auto* link = robot.FirstChildElement("link"); link; link = link->NextSiblingElement("link"))
        names.insert(getName(link));
    for (XMLElement *material = robot.FirstChildElement("material"), *next = nullptr; material; material = next) {
        next = material->NextSiblingElement("material");
        if (getName(material).empty() || !materials.insert(getName(material)).second) robot.DeleteChild(material);
    }
    for (auto* joint = robot.FirstChildElement("joint"); joint; joint = joint->NextSiblingElement("joint")) {
        std::string name = getName(joint);
        while (!names.insert(name).second) name += "_joint";
        joint->SetAttribute("name", name.c_str());
        for (const char* const needless : {"axis", "limit", "dynamics", "safety_controller", "calibration", "mimic"})
            while (XMLElement* const part = joint->FirstChildElement(needless)) joint->DeleteChild(part);
        if (joint->Attribute("type", "fixed")) continue;
        joint->SetAttribute("type", "continuous");
        joint->InsertNewChildElement("axis")->SetAttribute("xyz", "0 0 1");
    }
}

/** Keeps fixed joints, so that each link keeps its name and place: libsdformat would merge links joined by a fixed
 *  joint. */
void keepFixedJoints(XMLElement& robot) {
    std::vector<std::string> fixed;
    for (const XMLElement* joint = robot.FirstChildElement("joint"); joint; joint = joint->NextSiblingElement("joint"))
        if (joint->Attribute("type", "fixed")) fixed.push_back(getName(joint));
    for (const std::string& name : fixed) {
        XMLElement* const settings = robot.InsertNewChildElement("gazebo");
        settings->SetAttribute("reference", name.c_str());
        settings->InsertNewChildElement("preserveFixedJoint")->SetText(true);
    }
}

/** Checks what libsdformat leaves out without a word, or refuses without a reason. */
class UrdfChecks {
public:
    explicit UrdfChecks(std::string file) : file_(std::move(file)) {}

    types::Diagnostics diagnostics;
    std::vector<std::string> notices;

    /** Returns whether libsdformat can read the visual. It would leave out all that follow in its link, too. */
    bool checkVisual(XMLElement& visual, const std::string& link) {
        path_ = "link " + link + ".visual.";
        checkOrigin(visual);
        XMLElement* const geometry = visual.FirstChildElement("geometry");
        XMLElement* const shape = geometry ? geometry->FirstChildElement() : nullptr;
        const std::string_view name = shape ? shape->Name() : "";
        if (name == "box") {
            checkNumbers(*shape, "size", 3, NotNegative);
        } else if (name == "sphere" || name == "cylinder") {
            checkNumbers(*shape, "radius", 1, NotNegative);
            if (name == "cylinder") checkNumbers(*shape, "length", 1, NotNegative);
        } else if (name == "mesh") {
            checkNumbers(*shape, "scale", 3, Any, !shape->Attribute("scale"));
            if (!shape->Attribute("filename") || std::string_view(shape->Attribute("filename")).empty())
                report(*shape, "filename", "is missing; must be the path or URI of a mesh");
        } else {
            if (notices.size() < max_reports)
                notices.push_back(fmt::format("{}:{}: {}geometry: {}; omitted: may be box, cylinder, sphere or mesh",
                                              file_, visual.GetLineNum(), path_,
                                              shape ? fmt::format("<{}> is not read", name) : "holds no shape"));
            return false;
        }
        return true;
    }
    /** Checks that all have names, and that joints make one tree of the links. */
    void checkTree(XMLElement& robot) {
        path_.clear();
        checkName(robot);
        for (const auto* link = robot.FirstChildElement("link"); link; link = link->NextSiblingElement("link")) {
            path_ = "link " + getName(link) + ".";
            if (checkName(*link) && !links_.insert(getName(link)).second)
                report(*link, "name", "is that of two links; each has its own");
        }
        for (auto* joint = robot.FirstChildElement("joint"); joint; joint = joint->NextSiblingElement("joint"))
            checkJoint(*joint);
        if (links_.empty() || !diagnostics.empty()) return;
        path_.clear();
        std::vector<std::string> roots(links_.begin(), links_.end());
        std::erase_if(roots, [&](const std::string& link) { return parents_.contains(link); });
        if (roots.size() > 1)
            return report(robot, "link", listSome(roots) + " are the children of no joint; only one link may be");
        std::set<std::string> hangs(roots.begin(), roots.end());  // on the root
        for (const std::string& link : links_) {
            std::set<std::string> way;
            for (std::string at = link; !hangs.contains(at); at = parents_.at(at))
                if (!way.insert(at).second)
                    return report(robot, "joint",
                                  fmt::format("carries link {} by joints in a circle; must be a tree", link));
            hangs.merge(way);
        }
    }

private:
    enum Sign { Any, NotNegative };
    static constexpr size_t max_reports = 20;

    static std::string listSome(const std::vector<std::string>& names) {
        const std::span some(names.data(), std::min(names.size(), max_reports));
        return fmt::format("{}{}", fmt::join(some, ", "), names.size() > some.size() ? ", ..." : "");
    }
    void checkJoint(XMLElement& joint) {
        static const std::vector<std::string> types = {"fixed",     "revolute", "continuous",
                                                       "prismatic", "floating", "planar"};
        path_ = "joint " + getName(&joint) + ".";
        checkName(joint);
        const char* const type = joint.Attribute("type");
        if (!type || std::ranges::count(types, type) == 0)
            report(joint, "type",
                   fmt::format("{}; may be {}", type ? fmt::format("is \"{}\"", type) : "is missing",
                               fmt::join(types, ", ")));
        checkOrigin(joint);
        std::string ends[2];
        for (const bool is_child : {false, true}) {
            const XMLElement* const end = joint.FirstChildElement(is_child ? "child" : "parent");
            const char* const link = end ? end->Attribute("link") : nullptr;
            if (!link)
                report(joint, is_child ? "child" : "parent", "is missing; must be <... link=\"NAME\"/>");
            else if (links_.contains(link))
                ends[is_child] = link;
            else if (diagnostics.size() < max_reports) {  // a suggestion takes time
                const std::vector<std::string> known(links_.begin(), links_.end());
                report(*end, "link",
                       fmt::format("is \"{}\", which is no link; {}known: {}", link, types::didYouMean(link, known),
                                   listSome(known)));
            }
        }
        if (!ends[0].empty() && !ends[1].empty() && !parents_.emplace(ends[1], ends[0]).second)
            report(joint, "child",
                   fmt::format("is \"{}\", which is the child of another joint; a link has one parent", ends[1]));
    }
    bool checkName(const XMLElement& element) {
        const bool has = !getName(&element).empty();
        if (!has) report(element, "name", "is missing; must be a name");
        return has;
    }
    void checkOrigin(XMLElement& element) {
        if (XMLElement* origin = element.FirstChildElement("origin"))
            for (const char* const name : {"xyz", "rpy"}) checkNumbers(*origin, name, 3, Any, !origin->Attribute(name));
    }
    /** Also writes the numbers as libsdformat reads them, with one space between them. */
    void checkNumbers(XMLElement& element, const char* name, size_t count, Sign sign, bool may_lack = false) {
        const char* const text = element.Attribute(name);
        std::istringstream words(text ? text : "");
        size_t good = 0, all = 0;
        std::string joined;
        for (std::string word; words >> word; ++all) {
            const double number = toNumber(word);
            if (word.front() == '+') word.erase(0, 1);
            good += !std::isnan(number) && (sign == Any || number >= 0) ? 1 : 0;
            joined += (joined.empty() ? "" : " ") + word;
        }
        if (good == count && all == count) element.SetAttribute(name, joined.c_str());
        if (may_lack || (good == count && all == count)) return;
        report(element, name,
               fmt::format("{}; must be {}{}", text ? fmt::format("is \"{}\"", text) : "is missing",
                           count == 1 ? "a number" : fmt::format("{} numbers", count),
                           sign == NotNegative ? ", not negative" : ""));
    }
    void report(const XMLElement& element, const char* attribute, const std::string& message) {
        if (diagnostics.size() >= max_reports) return;
        const std::string_view name = element.Name();
        const std::string within = name == "link" || name == "joint" ? "" : std::string(name) + ".";
        diagnostics.push_back({path_ + within + attribute, message, file_, element.GetLineNum()});
    }

    const std::string file_;
    std::string path_;
    std::set<std::string> links_;
    std::map<std::string, std::string> parents_;  ///< By the link.
};

}  // namespace

bool isUrdf(const std::filesystem::path& file) { return scene::getExtension(file) == ".urdf"; }

Urdf readUrdf(const std::filesystem::path& file, const std::string& text) {
    const auto refuse = [&](const std::string& why, int line) {
        throw types::ConfigError({{"", why, file.string(), line}});
    };
    if (types::isUtf16(text)) refuse(types::utf16_refusal, 1);
    tinyxml2::XMLDocument document;
    if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
        refuse(fmt::format("is no XML ({})", tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID())),
               document.ErrorLineNum());
    XMLElement* const robot = document.FirstChildElement("robot");
    if (!robot) refuse("holds no <robot>, which is what URDF describes", 1);
    if (usesXacro(*robot)) refuse("is a macro file of xacro; expand it: xacro IN > OUT.urdf", robot->GetLineNum());
    Urdf urdf;
    UrdfChecks checks(file.string());
    checks.checkTree(*robot);
    for (XMLElement* link = robot->FirstChildElement("link"); link; link = link->NextSiblingElement("link")) {
        setInertia(*link);
        std::vector<std::string>& materials = urdf.materials[getName(link)];
        for (XMLElement *visual = link->FirstChildElement("visual"), *next = nullptr; visual; visual = next) {
            next = visual->NextSiblingElement("visual");
            if (checks.checkVisual(*visual, getName(link)))
                materials.push_back(nameMaterial(*visual));
            else
                link->DeleteChild(visual);
        }
    }
    if (!checks.diagnostics.empty()) throw types::ConfigError(std::move(checks.diagnostics));
    urdf.notices = std::move(checks.notices);
    simplify(*robot);
    keepFixedJoints(*robot);
    if (urdf.materials.empty()) refuse("is a robot without links", robot->GetLineNum());
    tinyxml2::XMLPrinter printer;
    document.Print(&printer);
    urdf.text = printer.CStr();
    return urdf;
}

}  // namespace insonify::sdf
