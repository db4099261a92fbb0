#pragma once
// The message Scene of an SDF world, as Gazebo's scene broadcaster fills it: poses relative to parents, shapes without
// scripts of materials.
#include <ignition/msgs/scene.pb.h>

#include <ignition/math/Pose3.hh>
#include <ignition/msgs/Utility.hh>
#include <sdf/Box.hh>
#include <sdf/Capsule.hh>
#include <sdf/Cylinder.hh>
#include <sdf/Ellipsoid.hh>
#include <sdf/Geometry.hh>
#include <sdf/Link.hh>
#include <sdf/Mesh.hh>
#include <sdf/Model.hh>
#include <sdf/Plane.hh>
#include <sdf/Root.hh>
#include <sdf/Sphere.hh>
#include <sdf/Visual.hh>
#include <sdf/World.hh>
#include <stdexcept>
#include <string>

namespace insonify::gazebo {

namespace fortress {

using ignition::msgs::Set;

ignition::math::Pose3d getPose(const auto& part) {
    ignition::math::Pose3d pose;
    if (!part.SemanticPose().Resolve(pose).empty()) throw std::runtime_error("a pose is not resolved");
    return pose;
}

inline void fill(const ::sdf::Geometry& shape, ignition::msgs::Geometry& message) {
    if (const auto* box = shape.BoxShape()) {
        message.set_type(ignition::msgs::Geometry::BOX);
        Set(message.mutable_box()->mutable_size(), box->Size());
    } else if (const auto* sphere = shape.SphereShape()) {
        message.set_type(ignition::msgs::Geometry::SPHERE);
        message.mutable_sphere()->set_radius(sphere->Radius());
    } else if (const auto* cylinder = shape.CylinderShape()) {
        message.set_type(ignition::msgs::Geometry::CYLINDER);
        message.mutable_cylinder()->set_radius(cylinder->Radius());
        message.mutable_cylinder()->set_length(cylinder->Length());
    } else if (const auto* capsule = shape.CapsuleShape()) {
        message.set_type(ignition::msgs::Geometry::CAPSULE);
        message.mutable_capsule()->set_radius(capsule->Radius());
        message.mutable_capsule()->set_length(capsule->Length());
    } else if (const auto* ellipsoid = shape.EllipsoidShape()) {
        message.set_type(ignition::msgs::Geometry::ELLIPSOID);
        Set(message.mutable_ellipsoid()->mutable_radii(), ellipsoid->Radii());
    } else if (const auto* plane = shape.PlaneShape()) {
        message.set_type(ignition::msgs::Geometry::PLANE);
        Set(message.mutable_plane()->mutable_normal(), plane->Normal());
        Set(message.mutable_plane()->mutable_size(), plane->Size());
    } else if (const auto* mesh = shape.MeshShape()) {
        message.set_type(ignition::msgs::Geometry::MESH);
        message.mutable_mesh()->set_filename(mesh->Uri());
        Set(message.mutable_mesh()->mutable_scale(), mesh->Scale());
        message.mutable_mesh()->set_submesh(mesh->Submesh());
        message.mutable_mesh()->set_center_submesh(mesh->CenterSubmesh());
    } else {
        throw std::runtime_error("a shape that Gazebo would not send");
    }
}

inline void fill(const ::sdf::Model& model, ignition::msgs::Model& message) {
    message.set_name(model.Name());
    message.set_is_static(model.Static());
    Set(message.mutable_pose(), getPose(model));
    for (uint64_t i = 0; i < model.LinkCount(); ++i) {
        const ::sdf::Link& link = *model.LinkByIndex(i);
        ignition::msgs::Link& below = *message.add_link();
        below.set_name(link.Name());
        Set(below.mutable_pose(), getPose(link));
        for (uint64_t k = 0; k < link.VisualCount(); ++k) {
            const ::sdf::Visual& visual = *link.VisualByIndex(k);
            ignition::msgs::Visual& shown = *below.add_visual();
            shown.set_name(visual.Name());
            Set(shown.mutable_pose(), getPose(visual));
            fill(*visual.Geom(), *shown.mutable_geometry());
        }
    }
    for (uint64_t i = 0; i < model.ModelCount(); ++i) fill(*model.ModelByIndex(i), *message.add_model());
}

}  // namespace fortress

inline ignition::msgs::Scene makeScene(const std::string& sdf_file) {
    ::sdf::Root root;
    const ::sdf::Errors errors = root.Load(sdf_file);
    if (!root.WorldByIndex(0)) throw std::runtime_error(errors.empty() ? "no world" : errors[0].Message());
    ignition::msgs::Scene scene;
    const ::sdf::World& world = *root.WorldByIndex(0);
    for (uint64_t i = 0; i < world.ModelCount(); ++i) fortress::fill(*world.ModelByIndex(i), *scene.add_model());
    return scene;
}

}  // namespace insonify::gazebo
