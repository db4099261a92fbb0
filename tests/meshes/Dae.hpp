#pragma once
// A COLLADA file whose parts a test may damage.
#include <string>

namespace insonify::meshes {

/** A rectangle from (0, 0, 0) to (1, 2, 3) in node "near". */
struct Dae {
    std::string unit = "1", up_axis = "Z_UP";  // empty: no element
    std::string floats = "0 0 0 1 0 0 1 2 3 0 2 3", float_count = "12";
    std::string accessor = R"(count="4" stride="3")";
    std::string triangles = getTriangles("0 1 2 0 2 3");
    std::string nodes = R"(<node id="near" name="near"><instance_geometry url="#g"/></node>)";

    static std::string getTriangles(const std::string& indices) {
        return R"(<triangles count="2"><input semantic="VERTEX" source="#v" offset="0"/><p>)" + indices +
               "</p></triangles>";
    }
    static std::string polygons(const std::string& count, const std::string& corners) {
        return "<polylist count=\"" + count + R"("><input semantic="VERTEX" source="#v" offset="0"/><vcount>)" +
               corners + "</vcount><p>0 1 2 0 2 3</p></polylist>";
    }
    std::string text() const {
        return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="u" meter=")" +
               unit + "\"/>" + (up_axis.empty() ? "" : "<up_axis>" + up_axis + "</up_axis>") + R"(</asset>
<library_geometries><geometry id="g" name="plate"><mesh>
<source id="p"><float_array id="pa" count=")" +
               float_count + "\">" + floats + R"(</float_array><technique_common>
<accessor source="#pa" )" +
               accessor + R"(><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
)" + triangles +
               R"(
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s">)" +
               nodes + R"(</visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
    }
};

}  // namespace insonify::meshes
