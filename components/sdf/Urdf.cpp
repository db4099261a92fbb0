#include "components/sdf/Urdf.hpp"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <string_view>

#include "components/scene/Scene.hpp"
#include "types/ConfigError.hpp"

namespace insonify::sdf {
namespace {

using tinyxml2::XMLElement;

bool usesXacro(const XMLElement& element) {
    if (std::string_view(element.Name()).starts_with("xacro:")) return true;
    for (const XMLElement* part = element.FirstChildElement(); part; part = part->NextSiblingElement())
        if (usesXacro(*part)) return true;
    return false;
}

std::string nameOf(const XMLElement* element) {
    const char* const name = element ? element->Attribute("name") : nullptr;
    return name ? name : "";
}

void addInertia(XMLElement& link) {
    if (link.FirstChildElement("inertial")) return;
    XMLElement* const inertial = link.InsertNewChildElement("inertial");
    inertial->InsertNewChildElement("mass")->SetAttribute("value", 1);
    XMLElement* const inertia = inertial->InsertNewChildElement("inertia");
    for (const char* const moment : {"ixx", "iyy", "izz"}) inertia->SetAttribute(moment, 1);
    for (const char* const product : {"ixy", "ixz", "iyz"}) inertia->SetAttribute(product, 0);
}

/** Keeps fixed joints, so that each link keeps its name and place: libsdformat would merge links joined by a fixed
 *  joint. */
void keepFixedJoints(XMLElement& robot) {
    std::vector<std::string> fixed;
    for (const XMLElement* joint = robot.FirstChildElement("joint"); joint; joint = joint->NextSiblingElement("joint"))
        if (joint->Attribute("type", "fixed")) fixed.push_back(nameOf(joint));
    for (const std::string& name : fixed) {
        XMLElement* const settings = robot.InsertNewChildElement("gazebo");
        settings->SetAttribute("reference", name.c_str());
        settings->InsertNewChildElement("preserveFixedJoint")->SetText(true);
    }
}

}  // namespace

bool isUrdf(const std::filesystem::path& file) { return scene::extensionOf(file) == ".urdf"; }

Urdf readUrdf(const std::filesystem::path& file, const std::string& text) {
    const auto refuse = [&](const std::string& why, int line) {
        throw types::ConfigError({{"", why, file.string(), line}});
    };
    tinyxml2::XMLDocument document;
    if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
        refuse(fmt::format("is no XML ({})", tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID())),
               document.ErrorLineNum());
    XMLElement* const robot = document.FirstChildElement("robot");
    if (!robot) refuse("holds no <robot>, which is what URDF describes", 1);
    if (usesXacro(*robot)) refuse("is a macro file of xacro; expand it: xacro IN > OUT.urdf", robot->GetLineNum());
    Urdf urdf;
    for (XMLElement* link = robot->FirstChildElement("link"); link; link = link->NextSiblingElement("link")) {
        addInertia(*link);
        std::vector<std::string>& materials = urdf.materials[nameOf(link)];
        for (const XMLElement* visual = link->FirstChildElement("visual"); visual;
             visual = visual->NextSiblingElement("visual"))
            materials.push_back(nameOf(visual->FirstChildElement("material")));
    }
    keepFixedJoints(*robot);
    if (urdf.materials.empty()) refuse("is a robot without links", robot->GetLineNum());
    tinyxml2::XMLPrinter printer;
    document.Print(&printer);
    urdf.text = printer.CStr();
    return urdf;
}

}  // namespace insonify::sdf
